"""The nodal forces of a press: quadrature over its footprint, whatever elements the ellipse cuts.

A press spreads its force with a density p(rho), rho from 0 at the centre to 1 at the rim of an ellipse with
semi-axes A (along the azimuth) and B. With t = sqrt(1 - rho^2) the area element is A B t dt dtheta, smooth
for the Hertz profile p = t as well as for the flat one p = 1. Gauss-Legendre in t and even angles turn the
footprint into weighted points; the consistent nodal forces are the shape functions at these points times the
weights. The weights add up to 1 and the shape functions to 1 in every point, so the nodal forces add up to
the press's force whatever the number of points.

A Gaussian profile exp(-2 rho^2) has no rim; it is cut off at three radii (six standard deviations, density
1.5e-8 of the centre's), and what falls off the block is spread over the rest.
"""

from __future__ import annotations

from math import cos, hypot, pi, sin

import numpy as np

from trocar.errors import InputError
from trocar.model import FloatArray, Press, Profile

RADIAL_POINTS = 32
ANGULAR_POINTS = 128  # a multiple of 4, so that a footprint and its mirror images have mirrored points
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


def footprint_points(press: Press, size: tuple[float, float]) -> tuple[FloatArray, FloatArray]:
    """Turn a footprint into points with shares of the force.

    Args:
        press: the tool; its force does not matter.
        size: sides of the block [m].

    Returns:
        Points [m], shape (n, 2), and the share of the force in each [1], shape (n,), adding up to 1.

    Raises:
        InputError: the footprint is not wholly on the block.
    """
    require_on_block(press, size)
    nodes, gauss = np.polynomial.legendre.leggauss(RADIAL_POINTS)
    t, weight = 0.5 * (nodes + 1.0), 0.5 * gauss
    rho = np.sqrt(1.0 - t**2)
    if press.profile is Profile.GAUSSIAN:
        rho = _GAUSSIAN_RIM * rho
        density = np.exp(-2.0 * rho**2)
    else:
        density = t if press.profile is Profile.SPHERE else np.ones_like(t)
    theta = 2.0 * pi * (np.arange(ANGULAR_POINTS) + 0.5) / ANGULAR_POINTS
    along, across = press.semi_axes
    p = along * np.outer(rho, np.cos(theta)).ravel()
    q = across * np.outer(rho, np.sin(theta)).ravel()
    c, s = cos(press.azimuth), sin(press.azimuth)
    points = np.stack([press.x + c * p - s * q, press.y + s * p + c * q], axis=1)
    share = np.repeat(weight * t * density, ANGULAR_POINTS)
    within = (
        np.all((points >= 0) & (points <= size), axis=1) if press.profile is Profile.GAUSSIAN else np.s_[:]
    )
    points, share = np.clip(points[within], 0.0, size), share[within]
    return points, share / share.sum()
