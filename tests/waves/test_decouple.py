"""Blocks against the exponential of the whole coupled system."""

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.optimize import brentq

from trocar.errors import SolverError
from trocar.waves.decouple import decouple
from trocar.waves.oscillators import Oscillators
from trocar.waves.propagator import exponential

# Eigenvectors of the first-order form cost two or three digits; the issue is that no case costs seven.
TOLERANCE = 1e-11


def first_order(mass, damping, stiffness):
    inverse = np.linalg.inv(mass)
    n = len(mass)
    return np.block([[np.zeros((n, n)), np.eye(n)], [-inverse @ stiffness, -inverse @ damping]])


def assert_same_motion(mass, damping, stiffness, dt=0.02):
    blocks = decouple(mass[None], damping[None], stiffness[None])
    start = np.linspace(1.0, 2.0, 2 * len(mass))
    x = np.einsum("sia,a->si", blocks.entry[0], start)
    moved = np.einsum("sik,sk->si", exponential(blocks.matrices[0], dt), x)
    actual = np.einsum("asi,si->a", blocks.exit[0], moved)
    expected = (expm(first_order(mass, damping, stiffness) * dt) @ start)[: len(mass)]
    assert actual == pytest.approx(expected, rel=TOLERANCE, abs=TOLERANCE * np.abs(start).max())


def random_spd(generator, size):
    root = generator.normal(size=(size, size))
    return root @ root.T + 0.1 * np.eye(size)


@pytest.mark.parametrize("scale", [0.0, 0.01, 1.0, 30.0, 1000.0])
@pytest.mark.parametrize("proportional", [True, False])
def test_random_systems_of_three_layers(scale, proportional):
    generator = np.random.default_rng(7)
    for _ in range(10):
        mass, stiffness, other = (random_spd(generator, 3) for _ in range(3))
        damping = scale * (0.01 * stiffness if proportional else other)
        assert_same_motion(mass, damping, 1e3 * stiffness)


def test_a_layer_damped_critically_by_itself():
    mass, stiffness = np.diag([2.0, 1.0]), np.diag([800.0, 900.0])
    damping = np.diag([2 * np.sqrt(2.0 * 800.0), 1.0])
    assert_same_motion(mass, damping, stiffness)


def double_pole():
    """Tune one layer's damping until two real poles of the coupled, unevenly damped pair coincide."""
    mass, stiffness = np.diag([1.0, 2.0]), np.array([[500.0, -100.0], [-100.0, 900.0]])

    def discriminant(c):
        poles = np.roots(np.poly(first_order(mass, np.diag([c, 3.0]), stiffness)))
        return np.prod([(poles[i] - poles[j]) ** 2 for i in range(4) for j in range(i)]).real

    return mass, stiffness, brentq(discriminant, 40.0, 50.0, xtol=1e-14, rtol=1e-14)


@pytest.mark.parametrize("offset", [0.0, 1e-12, 1e-8, -1e-8, -1e-7, -1e-6, 1e-4, -1e-4])
def test_coupled_layers_at_and_beside_a_double_pole(offset):
    mass, stiffness, critical = double_pole()
    assert_same_motion(mass, np.diag([critical + offset, 3.0]), stiffness)


def test_a_tissue_without_stiffness_is_refused():
    with pytest.raises(SolverError, match="give some tension, bending or foundation"):
        decouple(np.eye(2)[None], np.zeros((1, 2, 2)), np.zeros((1, 2, 2)))


def test_a_stiff_viscous_bed_does_not_drown_the_slow_motion_in_rounding():
    """Sheets numbered from the other end answer alike: what differs is rounding, and was 4e-7 of the answer."""
    beds = np.array([1.76e12, 3.44e7, 5.56e5])  # those of the skin preset
    squares = np.pi**2 / 0.06**2 * np.arange(2, 1800, 7)[:, None]
    own = squares * np.array([1.5e-5, 20.0, 3.2e-5]) + squares**2 * np.array([1.8e-8, 3.3e-5, 3.1e-5])

    def coupled(own, beds):
        diagonal = (own + beds + [0.0, *beds[:-1]])[..., None] * np.eye(3)
        return diagonal - np.diag(beds[:-1], 1) - np.diag(beds[:-1], -1)

    mass = np.diag([0.01, 0.01, 10.0]) + 0 * own[..., None]
    stiffness = coupled(own, beds)
    damping = coupled(1.5e-4 * own, beds * np.array([2.9e-3, 2.9e-3, 7.7e-4]))
    answers = []
    for turn in (slice(None), slice(None, None, -1)):
        system = (matrix[:, turn, turn] for matrix in (mass, damping, stiffness))
        force = np.eye(3)[turn][:, :1] + np.zeros((len(own), 1, 1))
        waves = Oscillators.of(*system, force, np.eye(3)[turn] + 0 * mass)
        step = waves.propagator(1e-3)
        answers.append(np.einsum("jksi,jsi->jk", waves.outputs, (step.start_gain + step.end_gain)[..., 0]))
    one, other = answers
    assert (np.abs(one - other).max(axis=1) / np.abs(one).max(axis=1)).max() < 1e-8
