"""Stick, slide, and that nothing is gained."""

import numpy as np
import pytest

from trocar.contact.friction import drag

COMPLIANCE, MU = 2e-3, 0.3


def test_it_sticks_then_slides_at_the_cone():
    force = np.zeros(2)
    assert drag(force, 1e-4, 0.0, COMPLIANCE, MU, 1.0) == 0.0
    assert force == pytest.approx([0.05, 0.0])
    slid = drag(force, 1e-3, 0.0, COMPLIANCE, MU, 1.0)
    assert force == pytest.approx([MU, 0.0])
    assert slid == pytest.approx(1e-3 - COMPLIANCE * (MU - 0.05))


def test_it_does_not_know_x_from_y_nor_left_from_right():
    rng = np.random.default_rng(0)
    for motion in rng.normal(scale=1e-3, size=(50, 2)):
        angle = rng.uniform(0, 2 * np.pi)
        turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        one, other = np.array([0.02, -0.01]), turn @ np.array([0.02, -0.01])
        slid = drag(one, *motion, COMPLIANCE, MU, 0.4)
        assert drag(other, *(turn @ motion), COMPLIANCE, MU, 0.4) == pytest.approx(slid, abs=1e-15)
        assert other == pytest.approx(turn @ one, abs=1e-15)


def test_sliding_to_and_fro_makes_no_ratchet():
    force = np.zeros(2)
    for _ in range(3):
        for motion in (1e-4,) * 50 + (-1e-4,) * 50:
            drag(force, motion, 0.0, COMPLIANCE, MU, 1.0)
        assert force == pytest.approx([-MU, 0.0])


def test_no_energy_is_gained_whatever_the_tip_and_the_pressure_do():
    rng = np.random.default_rng(4)
    for _ in range(200):
        force, put_in, heat = np.zeros(2), 0.0, 0.0
        for _ in range(100):
            before = force.copy()
            motion = rng.normal(scale=10 ** rng.uniform(-6, -3), size=2)
            slid = drag(force, *motion, COMPLIANCE, MU, rng.uniform(-0.2, 1.0))
            put_in += force @ motion
            heat += np.hypot(*force) * slid
            stored = 0.5 * COMPLIANCE * force @ force
            assert stored + heat <= put_in + 1e-12
            assert np.hypot(*force) <= MU * 1.0 * (1 + 1e-12)
            assert np.isfinite(before).all()


@pytest.mark.parametrize("normal", [0.0, -0.5])
def test_without_pressure_nothing_is_dragged(normal):
    force = np.array([0.1, 0.2])
    assert drag(force, 0.0, 0.0, COMPLIANCE, MU, normal) == pytest.approx(COMPLIANCE * np.hypot(0.1, 0.2))
    assert (force == 0).all()
