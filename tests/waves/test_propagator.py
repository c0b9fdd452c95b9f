"""The exact step against matrix exponentials of the augmented system, which share no formula with it."""

import itertools

import numpy as np
import pytest
from scipy.linalg import expm

from trocar.waves.propagator import Propagator, exponential, ramp_weights

BLOCKS = {
    "undamped": [[0.0, 300.0], [-300.0, 0.0]],
    "damped": [[0.0, 300.0], [-300.0, -40.0]],
    "critical": [[0.0, 300.0], [-300.0, -600.0]],
    "nearly critical": [[0.0, 300.0], [-300.0, -600.0 + 1e-7]],
    "overdamped": [[0.0, 300.0], [-300.0, -6e4]],
    "two real poles": [[-3.0, 0.0], [0.0, -4000.0]],
    "growing in place": [[0.0, 1.0], [0.0, 0.0]],
}
# The oracle itself is scaling and squaring: it loses a digit per three doublings of the block's norm.
TOLERANCE = 1e-11


def augmented_step(block, dt, state, force0, force1):
    """Return the state after dt by one exponential of [[A, f0, slope], [0, 0, 0], [0, 1, 0]]."""
    system = np.zeros((4, 4))
    system[:2, :2] = block
    system[:2, 2] = force0
    system[:2, 3] = (force1 - force0) / dt
    system[3, 2] = 1.0
    return (expm(system * dt) @ np.array([*state, 1.0, 0.0]))[:2]


@pytest.mark.parametrize("name", BLOCKS)
@pytest.mark.parametrize("dt", [1e-6, 1e-3, 0.1])
def test_a_ramped_step_is_exact(name, dt):
    block = np.array(BLOCKS[name])
    state, force0, force1 = np.array([0.3, -0.7]), np.array([2.0, 5.0]), np.array([-1.0, 40.0])
    expected = augmented_step(block, dt, state, force0, force1)
    start, end = ramp_weights(block, dt)
    actual = exponential(block, dt) @ state + start @ force0 + end @ force1
    scale = np.abs(expected).max() + np.abs(state).max()
    assert actual == pytest.approx(expected, abs=TOLERANCE * scale)


@pytest.mark.parametrize("name", BLOCKS)
def test_one_long_step_equals_many_short_ones(name):
    block = np.array(BLOCKS[name])[None, None]
    inputs = np.array([[0.0], [1.0]])[None, None]
    once, often = Propagator.over(block, inputs, 1.0), Propagator.over(block, inputs, 1e-3)
    force = np.linspace(0.0, 7.0, 1001)
    state = np.array([0.2, 0.1])
    for f0, f1 in itertools.pairwise(force):
        state = (
            often.transition[0, 0] @ state
            + often.start_gain[0, 0, :, 0] * f0
            + often.end_gain[0, 0, :, 0] * f1
        )
    expected = once.transition[0, 0] @ [0.2, 0.1] + once.end_gain[0, 0, :, 0] * 7.0
    # A thousand roundings, each relative to what the state held at the time.
    assert state == pytest.approx(expected, rel=1e-10, abs=1e-10)


def test_a_long_overdamped_step_does_not_overflow():
    block = np.array([[0.0, 1e3], [-1e3, -1e9]])
    assert np.isfinite(exponential(block, 100.0)).all()
    assert all(np.isfinite(weight).all() for weight in ramp_weights(block, 100.0))
