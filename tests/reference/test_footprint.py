"""Footprints: total, moments and shape of the shares, whatever the grid."""

from __future__ import annotations

from itertools import pairwise
from math import cos, sin

import numpy as np
import pytest

from trocar.errors import InputError
from trocar.model import Press, Profile
from trocar.reference.footprint import footprint_points, half_extent

LINES = np.sort(np.append(np.linspace(0.0, 0.03, 14), [0.0101, 0.0149]))
SECOND_MOMENT = {Profile.FLAT: 1 / 4, Profile.SPHERE: 1 / 5, Profile.GAUSSIAN: 1 / 4}
"""Mean of X^2 over the footprint, in semi-axes squared: integral of rho^3 p over that of rho p, halved."""


@pytest.mark.parametrize("profile", Profile)
@pytest.mark.parametrize(("tilt", "azimuth"), [(0.0, 0.0), (0.6, 0.0), (0.5, 1.1), (0.7, -2.0)])
def test_moments_are_those_of_the_ellipse(profile: Profile, tilt: float, azimuth: float) -> None:
    press = Press(x=0.0147, y=0.0139, radius=2.3e-3, force=5.0, profile=profile, tilt=tilt, azimuth=azimuth)
    points, share = footprint_points(press, LINES, LINES)
    offset = points - (press.x, press.y)
    assert share.sum() == pytest.approx(1.0, abs=1e-14)
    np.testing.assert_allclose(share @ offset, 0.0, atol=1e-7 * press.radius)  # as below
    turn = np.array([[cos(azimuth), -sin(azimuth)], [sin(azimuth), cos(azimuth)]])
    moment = SECOND_MOMENT[profile] * turn @ np.diag(np.square(press.semi_axes)) @ turn.T
    # Gauss rules on 15 degrees are right to 1e-7; the Gaussian, cut off, lacks 3e-7 of its moment
    np.testing.assert_allclose((offset * share[:, None]).T @ offset, moment, atol=1e-6 * moment.max())


def test_a_flat_share_of_a_strip_is_that_of_a_circle_segment() -> None:
    """Grid lines cut the disc; what lies between two of them is known in closed form."""
    press = Press(x=0.0147, y=0.0139, radius=2.3e-3, force=1.0)
    points, share = footprint_points(press, LINES, LINES)
    for low, high in pairwise(LINES):
        between = (points[:, 0] > low) & (points[:, 0] < high)
        a, b = np.clip((np.array([low, high]) - press.x) / press.radius, -1.0, 1.0)
        expected = (np.arcsin(b) + b * np.sqrt(1 - b**2) - np.arcsin(a) - a * np.sqrt(1 - a**2)) / np.pi
        assert share[between].sum() == pytest.approx(expected, abs=1e-8)  # as above


def test_points_lie_within_the_footprint() -> None:
    press = Press(x=0.015, y=0.012, radius=2e-3, force=1.0, tilt=0.8, azimuth=0.5)
    offset = footprint_points(press, LINES, LINES)[0] - (press.x, press.y)
    along = offset @ [cos(0.5), sin(0.5)] / press.semi_axes[0]
    across = offset @ [-sin(0.5), cos(0.5)] / press.semi_axes[1]
    assert (along**2 + across**2).max() < 1.0 + 1e-12
    np.testing.assert_array_less(np.abs(offset).max(axis=0), half_extent(press))


def test_a_gaussian_near_a_side_keeps_its_force() -> None:
    press = Press(x=0.003, y=0.015, radius=2.5e-3, force=1.0, profile=Profile.GAUSSIAN)
    points, share = footprint_points(press, LINES, LINES)
    assert share.sum() == pytest.approx(1.0, abs=1e-14)
    assert points.min() >= 0.0


@pytest.mark.parametrize("place", [{"x": 0.001}, {"x": 0.0295}, {"y": -0.01}, {"y": 0.04}])
def test_a_tool_off_the_block_is_refused(place: dict[str, float]) -> None:
    press = Press(**({"x": 0.015, "y": 0.015, "radius": 2e-3, "force": 1.0} | place))
    with pytest.raises(InputError, match="wholly on the block"):
        footprint_points(press, LINES, LINES)
