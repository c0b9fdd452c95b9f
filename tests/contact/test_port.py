"""The fulcrum: kinematics and the lever, tied together by power."""

import numpy as np
import pytest

from trocar.contact.port import felt, reach

PORT = np.array([0.03, -0.05, 0.12])
LENGTH = 0.33


def placed(handle):
    tip, direction = np.zeros(3), np.zeros(3)
    assert reach(np.asarray(handle, dtype=float), PORT, LENGTH, tip, direction)
    return tip, direction


def handles(count=50):
    rng = np.random.default_rng(3)
    return PORT + rng.uniform([-0.1, -0.15, 0.05], [0.1, -0.02, 0.2], (count, 3))


def test_the_shaft_passes_through_the_port():
    for handle in handles():
        tip, direction = placed(handle)
        assert np.linalg.norm(direction) == pytest.approx(1.0, rel=1e-14)
        assert np.linalg.norm(tip - handle) == pytest.approx(LENGTH, rel=1e-14)
        assert np.cross(PORT - handle, tip - handle) == pytest.approx(np.zeros(3), abs=1e-16)


def test_the_hand_goes_left_and_the_tip_right():
    handle = PORT + np.array([0.0, -0.06, 0.1])
    tip, _ = placed(handle)
    left, _ = placed(handle + np.array([-1e-3, 0.0, 0.0]))
    outside = np.linalg.norm(PORT - handle)
    assert left[0] - tip[0] == pytest.approx(1e-3 * (LENGTH - outside) / outside, rel=1e-4)


def test_the_hand_feels_the_power_that_the_tip_meets():
    rng = np.random.default_rng(5)
    for handle in handles():
        velocity, force = rng.normal(size=(2, 3))
        _, direction = placed(handle)
        step = 1e-6
        ahead, _ = placed(handle + step * velocity)
        behind, _ = placed(handle - step * velocity)
        hand = np.zeros(3)
        felt(force, direction, np.linalg.norm(PORT - handle), LENGTH, hand)
        # Central differences of a smooth map over 1e-6 m: 1e-8 of the power.
        assert hand @ velocity == pytest.approx(force @ (ahead - behind) / (2 * step), rel=1e-6, abs=1e-7)


@pytest.mark.parametrize("handle", [PORT, PORT + np.array([0.0, 0.0, 0.34]), np.full(3, np.nan)])
def test_an_impossible_pose_moves_nothing(handle):
    tip, direction = np.full(3, 7.0), np.full(3, 7.0)
    assert not reach(handle, PORT, LENGTH, tip, direction)
    assert (tip == 7.0).all()
    assert (direction == 7.0).all()
