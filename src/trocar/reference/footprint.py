"""The nodal forces of a press: quadrature over its footprint, exact for whatever elements the ellipse cuts.

An ellipse is the unit disc X^2 + Y^2 < 1 sheared: x = x_c + e X, y = y_c + k e X + h Y, with e half its width
along x; a press spreads its force with a density p(rho), rho^2 = X^2 + Y^2. With

    X = sin(theta),   Y = cos(theta) sin(phi),   dX dY = cos(theta)^2 cos(phi) dtheta dphi

the rim lies at phi = -pi/2 and pi/2, and both the flat p = 1 and the Hertz p = sqrt(1 - rho^2) = cos(theta)
cos(phi) are smooth up to it. The shape functions are polynomials between grid lines, so theta is split where
x or the rim crosses a grid line and phi where y does, and each piece gets its own Gauss rule. (A polar rule
that ignores the elements is off by 0.2 % in the deflection of a node with 4000 points.) The shares are made
to add up to 1, so the nodal forces add up to the press's force.

A Gaussian profile exp(-2 rho^2) has no rim; it is cut off at three radii (six standard deviations, density
1.5e-8 of the centre's), and what falls off the block is spread over the rest.
"""

from __future__ import annotations

from math import atan2, cos, hypot, pi, sin

import numpy as np

from trocar.errors import InputError
from trocar.model import FloatArray, Press, Profile

_GAUSS_POINTS = 5  # in each piece and direction; the nodal forces are then right to 1e-7 of the largest
_PIECES = 12  # a half turn is split into at least so many
_GAUSSIAN_RIM = 3.0  # where the Gaussian profile is cut off, in radii


def half_extent(press: Press) -> tuple[float, float]:
    """Return half the width of the footprint along x and along y [m]."""
    along, across = press.semi_axes
    c, s = cos(press.azimuth), sin(press.azimuth)
    return hypot(along * c, across * s), hypot(along * s, across * c)


def require_on_block(press: Press, size: tuple[float, float]) -> None:
    """Raise InputError unless the whole footprint lies on a block with sides `size` [m]."""
    centre = (press.x, press.y)
    for axis, where, half, side in zip("xy", centre, half_extent(press), size, strict=True):
        slack = 1e-9 * side
        if where - half < -slack or where + half > side + slack:
            raise InputError(
                f"press: {axis}",
                f"a footprint wholly on the block, centre between {half:.6g} and {side - half:.6g} m",
                where,
            )


def footprint_points(press: Press, x_lines: FloatArray, y_lines: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Turn a footprint into points with shares of the force.

    Args:
        press: the tool; its force does not matter.
        x_lines: grid lines of the whole block along x [m], ascending from 0 to its side.
        y_lines: the same along y.

    Returns:
        Points [m], shape (n, 2), and the share of the force in each [1], shape (n,), adding up to 1.

    Raises:
        InputError: the footprint is not wholly on the block.
    """
    size = (float(x_lines[-1]), float(y_lines[-1]))
    require_on_block(press, size)
    rim = _GAUSSIAN_RIM if press.profile is Profile.GAUSSIAN else 1.0
    along, across = (rim * axis for axis in press.semi_axes)
    half_x, half_y = (rim * half for half in half_extent(press))
    height = along * across / half_x
    shear = (along**2 - across**2) * cos(press.azimuth) * sin(press.azimuth) / half_x

    lean = atan2(height, shear)  # the rim is y_c + half_y sin(theta +- lean)
    turned = np.arcsin(_inside((y_lines - press.y) / half_y))
    rim_crossings = [angle - sign * lean for angle in (turned, pi - turned) for sign in (1.0, -1.0)]
    wrapped = (np.concatenate(rim_crossings) + pi) % (2 * pi) - pi
    crossings = np.concatenate([wrapped, np.arcsin(_inside((x_lines - press.x) / half_x))])
    points, shares = [], []
    for theta, weight in zip(*_gauss(crossings), strict=True):
        middle, half = press.y + shear * sin(theta), height * cos(theta)
        phi, weights = _gauss(np.arcsin(_inside((y_lines - middle) / half)))
        x = np.full_like(phi, press.x + half_x * sin(theta))
        points.append(np.stack([x, middle + half * np.sin(phi)], axis=1))
        density = _density(press.profile, cos(theta) * np.cos(phi))
        shares.append(weight * cos(theta) ** 2 * weights * np.cos(phi) * density)
    place, share = np.concatenate(points), np.concatenate(shares)
    if press.profile is Profile.GAUSSIAN:
        on_block = np.all((place >= 0) & (place <= size), axis=1)
        place, share = place[on_block], share[on_block]
    return np.clip(place, 0.0, size), share / share.sum()


def _density(profile: Profile, depth: FloatArray) -> FloatArray:
    """Return the traction's shape; depth is sqrt(1 - rho^2), rho measured to the rim of the quadrature."""
    if profile is Profile.FLAT:
        return np.ones_like(depth)
    if profile is Profile.SPHERE:
        return depth
    return np.asarray(np.exp(-2.0 * _GAUSSIAN_RIM**2 * (1.0 - depth**2)))


def _inside(values: FloatArray) -> FloatArray:
    return values[np.abs(values) < 1.0]


def _gauss(crossings: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return Gauss points and weights over -pi/2 to pi/2, split at the crossings."""
    within = crossings[np.abs(crossings) < pi / 2]
    ends = np.sort(np.concatenate([np.linspace(-pi / 2, pi / 2, _PIECES + 1), within]))
    nodes, weights = np.polynomial.legendre.leggauss(_GAUSS_POINTS)
    middle, half = 0.5 * (ends[1:] + ends[:-1]), 0.5 * np.diff(ends)
    return (middle[:, None] + half[:, None] * nodes).ravel(), (half[:, None] * weights).ravel()
