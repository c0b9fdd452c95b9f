"""Ellipsoids as tips, by brute force: a cloud of their own points, turned by hand."""

import numpy as np
import pytest

from trocar.contact.instrument import TipKind
from trocar.contact.tips import TIPS, lowest, turn_body, underside, underside_or_side

AXES, MIDDLE = np.array([0.6e-3, 1.5e-3, 2.2e-3]), np.array([0.1e-3, -0.4e-3, 2.0e-3])
TIP = np.array([0.012, -0.003, 0.004])
SHAFTS = [
    (0, 0, -1),
    (0.6, 0.0, -0.8),
    (-0.5, 0.3, -0.81),
    (0.0, 1.0, 0.0),
    (1.0, 0.0, 0.0),
    (0.2, 0.1, 0.97),
]
ROLLS = [0.0, 0.7, -2.5]


def frame(direction, roll):
    """Rows x, y, z of the tool: z back along the shaft, y up as it may, turned by roll about the way to the tip."""
    back = -np.array(direction, dtype=float) / np.linalg.norm(direction)
    up = np.array([0.0, 0.0, 1.0]) if np.hypot(*back[:2]) > 1e-3 else np.array([0.0, 1.0, 0.0])
    y = up - up @ back * back
    y /= np.linalg.norm(y)
    y = np.cos(roll) * y + np.sin(roll) * np.cross(-back, y)
    return np.array([np.cross(y, back), y, back])


def turned(direction, roll, axes=AXES, middle=MIDDLE):
    centre, spread = np.empty(3), np.empty((3, 3))
    towards = np.array(direction, dtype=float) / np.linalg.norm(direction)
    turn_body(axes, middle, TIP, towards, roll, centre, spread)
    return centre, spread


def cloud(direction, roll, points=200_000):
    """Points of the surface, by the definition."""
    rng = np.random.default_rng(0)
    ball = rng.normal(size=(points, 3))
    ball /= np.linalg.norm(ball, axis=1)[:, None]
    return TIP + (MIDDLE + ball * AXES) @ frame(direction, roll)


@pytest.mark.parametrize("direction", SHAFTS)
@pytest.mark.parametrize("roll", ROLLS)
def test_the_turned_ellipsoid_is_the_set_of_its_points(direction, roll):
    centre, spread = turned(direction, roll)
    assert centre == pytest.approx(TIP + MIDDLE @ frame(direction, roll), rel=0, abs=1e-16)
    away = cloud(direction, roll, 1000) - centre
    assert np.einsum("pi,ij,pj->p", away, np.linalg.inv(spread), away) == pytest.approx(1.0, rel=1e-9)


@pytest.mark.parametrize("direction", SHAFTS)
@pytest.mark.parametrize("roll", ROLLS)
def test_no_point_is_lower_than_the_lowest(direction, roll):
    centre, spread = turned(direction, roll)
    low, points = np.empty(3), cloud(direction, roll)
    lowest(centre, spread, low)
    away = low - centre
    assert away @ np.linalg.solve(spread, away) == pytest.approx(1.0, rel=1e-12)  # on the surface
    assert low[2] <= points[:, 2].min() + 1e-15
    # Of 200 000 points the nearest lies within a hundredth of a semi-axis, and the height's error is its square.
    assert low[2] == pytest.approx(points[:, 2].min(), abs=1e-3 * AXES.max())
    assert underside(spread, away[0], away[1])[0] == pytest.approx(away[2], rel=1e-9)
    assert underside(spread, away[0], away[1])[1:] == pytest.approx((0.0, 0.0), abs=1e-6)


@pytest.mark.parametrize("direction", SHAFTS)
@pytest.mark.parametrize("roll", ROLLS)
def test_the_underside_is_the_lower_root(direction, roll):
    spread = turned(direction, roll)[1]
    inverse = np.linalg.inv(spread)
    reach = np.sqrt([spread[0, 0], spread[1, 1]])
    inside = 0
    for dx, dy in np.random.default_rng(1).uniform(-1, 1, (200, 2)) * reach:
        # (dx, dy, h) on the ellipsoid: a quadratic in h, its lower root.
        b = inverse[2, 0] * dx + inverse[2, 1] * dy
        rest = inverse[0, 0] * dx**2 + 2 * inverse[0, 1] * dx * dy + inverse[1, 1] * dy**2 - 1
        discriminant = b**2 - inverse[2, 2] * rest
        height, slope_x, slope_y = underside(spread, dx, dy)
        if discriminant <= 0:
            assert height == np.inf
            assert underside_or_side(spread, dx, dy) == pytest.approx(-b / inverse[2, 2], rel=1e-9)
            continue
        assert underside_or_side(spread, dx, dy) == pytest.approx(height, rel=1e-9, abs=1e-14)
        inside += 1
        assert height == pytest.approx((-b - np.sqrt(discriminant)) / inverse[2, 2], rel=1e-9, abs=1e-14)
        step = 1e-8
        ahead = [underside(spread, dx + step * i, dy + step * (1 - i))[0] for i in (1, 0)]
        behind = [underside(spread, dx - step * i, dy - step * (1 - i))[0] for i in (1, 0)]
        if max(*ahead, *behind) < np.inf and discriminant > 0.01 * inverse[2, 2]:
            by_difference = (np.array(ahead) - behind) / (2 * step)
            assert (slope_x, slope_y) == pytest.approx(
                by_difference, rel=1e-4, abs=1e-5
            )  # h^2 and rounding/h
    assert inside > 80  # the rest lies beside it


def test_roll_is_counted_from_up_about_the_way_to_the_tip():
    """Half a turn leaves an ellipsoid about the shaft alone; a quarter brings x where y was."""
    level = (1.0, 0.0, 0.0)  # y of the tool is up, and a quarter turn takes it to x cross z = -y
    still, quarter = (
        turned(level, 0.0, middle=np.zeros(3))[1],
        turned(level, np.pi / 2, middle=np.zeros(3))[1],
    )
    assert np.sqrt(np.diag(still)) == pytest.approx([AXES[2], AXES[0], AXES[1]], rel=1e-12)
    assert np.sqrt(np.diag(quarter)) == pytest.approx([AXES[2], AXES[1], AXES[0]], rel=1e-12)
    assert turned(level, np.pi, middle=np.zeros(3))[1] == pytest.approx(still, rel=1e-9, abs=1e-20)
    hook = np.array([0.0, 1e-3, 0.0])
    assert turned(level, 0.0, middle=hook)[0] - TIP == pytest.approx([0, 0, 1e-3], abs=1e-15)
    assert turned(level, np.pi / 2, middle=hook)[0] - TIP == pytest.approx([0, -1e-3, 0], abs=1e-15)


@pytest.mark.parametrize("kind", list(TipKind))
def test_every_tip_ends_where_its_shaft_does(kind):
    """The end of the shaft lies on the ellipsoid or within it, and no tip is wider than the shaft."""
    shape = TIPS[kind]
    to_tip = np.array(shape.middle) / np.array(shape.axes)
    assert np.linalg.norm(to_tip) <= 1.0 + 0.4  # the heel of a hook stands a little beside the shaft
    assert shape.middle[2] == pytest.approx(shape.axes[2])  # and nothing reaches beyond the end
    assert shape.axes[0] <= 1.0
    assert shape.holds == kind.has_jaw
