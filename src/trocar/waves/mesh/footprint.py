"""Points of a footprint with shares of its force: a polar rule, and where it comes to lie on a mesh.

On a surface that slopes the footprint is laid into its tangent plane: the whole press, footprint and force, is turned
by the shortest turn that takes z to the normal (Rodrigues' formula). On a level surface nothing turns.
"""

from __future__ import annotations

from enum import StrEnum
from math import cos, pi, sin

import numpy as np

from trocar.errors import InputError
from trocar.model import FloatArray, Press, Profile
from trocar.waves.mesh.elements import Elements
from trocar.waves.mesh.solid_mesh import IntArray

STEEPEST = 0.259  # z of the normal where a tool still comes from above: 75 degrees

_RINGS, _SPOKES = 32, 128
_GAUSSIAN_RIM = (
    3.0  # where the Gaussian profile exp(-2 rho^2) is cut off, in radii: it is 1.5e-8 of the middle's
)


class Approach(StrEnum):
    """Along what a tool that is not tilted comes to a surface that slopes."""

    NORMAL = "normal"  # of the surface, the mean over the footprint: as `Press.tilt` counts from
    VERTICAL = "vertical"  # z, wherever the surface looks


def turn_to(normal: FloatArray) -> FloatArray:
    """Return the shortest turn that takes z to a unit normal, shape (3, 3).

    Args:
        normal: with z above 0, shape (3,).
    """
    x, y, z = normal
    cross = np.array([[0.0, 0.0, x], [0.0, 0.0, y], [-x, -y, 0.0]])
    return np.asarray(np.eye(3) + cross + cross @ cross / (1 + z))


def footprint_points(press: Press) -> tuple[FloatArray, FloatArray]:
    """Return points [m], shape (n, 2), and the share of the force at each, shape (n,), which add up to 1."""
    nodes, weights = np.polynomial.legendre.leggauss(_RINGS)
    rho, ring = 0.5 * (1 + nodes), 0.5 * weights
    if press.profile is Profile.SPHERE:
        # rho = sin: sqrt(1 - rho^2) is then smooth up to the rim
        angle = 0.5 * pi * rho
        rho, ring = np.sin(angle), 0.5 * pi * ring * np.cos(angle) ** 2
    elif press.profile is Profile.GAUSSIAN:
        rho, ring = _GAUSSIAN_RIM * rho, ring * np.exp(-2 * (_GAUSSIAN_RIM * rho) ** 2)
    turn = 2 * pi * (np.arange(_SPOKES) + 0.5) / _SPOKES
    along, across = press.semi_axes
    e, n = along * np.outer(rho, np.cos(turn)).ravel(), across * np.outer(rho, np.sin(turn)).ravel()
    c, s = cos(press.azimuth), sin(press.azimuth)
    places = np.stack([press.x + c * e - s * n, press.y + s * e + c * n], axis=1)
    share = np.repeat(ring * rho, _SPOKES)
    return places, share / share.sum()


def laid(
    press: Press, elements: Elements, surface: str, approach: Approach = Approach.NORMAL
) -> tuple[IntArray, FloatArray, FloatArray]:
    """Return what a press does to a surface: nodes, shares and the force that is shared.

    Args:
        press: seen from above.
        elements: of the mesh.
        surface: its name.
        approach: along what a tool without tilt comes.

    Returns:
        Nodes and the share of the force on each, both of shape (k, n), and the force [N], shape (3,).

    Raises:
        InputError: the footprint is not wholly on the surface, or the surface is too steep there.
    """
    force = np.asarray(press.force_vector)
    points, share = footprint_points(press)
    if approach is Approach.NORMAL:
        normal = share @ elements.seen(surface, points)[1]
        normal /= np.linalg.norm(normal)
        if normal[2] < STEEPEST:
            raise InputError(
                "press: x, y",
                "a place where the surface looks up, at most 75 degrees from it",
                f"{np.degrees(np.arccos(normal[2])):.0f} degrees at {1e3 * press.x:.4g}, {1e3 * press.y:.4g} mm",
                "turn the mesh so that this side is above",
            )
        turn, centre = turn_to(normal), np.array([press.x, press.y])
        points, force = centre + (points - centre) @ turn[:2, :2].T, turn @ force
    nodes, weights = elements.at(surface, points)
    return nodes, weights * share, force
