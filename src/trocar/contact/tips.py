"""The working end of an instrument as an ellipsoid: what it touches the tissue with, however the shaft is held.

In the tool's own axes, x across the jaws, y the way they open, z back along the shaft, the ellipsoid has semi-axes a
and its middle lies at c from the tip. Turned into the room it is the set r^T S^-1 r <= 1, S = sum of a_i^2 e_i e_i^T,
about its middle. With S split into its horizontal part H, its column h and its corner s,

    lowest point      -S e_z/sqrt(s)
    underside at d    h^T H^-1 d - sqrt((s - h^T H^-1 h)(1 - d^T H^-1 d)),   d horizontal,

as for a conditioned normal distribution. Jaws touch as one closed nose, open or not.
"""

from __future__ import annotations

from math import cos, inf, pi, sin, sqrt
from typing import NamedTuple

import numpy as np
from numba import njit

from trocar.contact.instrument import TipKind
from trocar.model import FloatArray

_SIDEWAYS = 1e-3  # a shaft so close to upright has no up across it: roll is then counted from y


class TipShape(NamedTuple):
    """An ellipsoid, in radii of the shaft.

    Attributes:
        axes: semi-axes across the jaws, along their opening and back along the shaft.
        middle: from the tip, likewise.
        holds: whether it has jaws that can hold tissue.
    """

    axes: tuple[float, float, float]
    middle: tuple[float, float, float]
    holds: bool


# What the page draws, taken as ellipsoids: a ball, two closed noses, the heel of a bent rod.
TIPS = {
    TipKind.PROBE: TipShape((0.8, 0.8, 0.8), (0.0, 0.0, 0.8), False),
    TipKind.GRASPER: TipShape((0.55, 0.6, 0.8), (0.0, 0.0, 0.8), True),
    TipKind.NEEDLE_HOLDER: TipShape((0.5, 0.5, 0.7), (0.0, 0.0, 0.7), True),
    TipKind.HOOK: TipShape((0.26, 0.96, 0.26), (0.0, 0.88, 0.26), False),
    TipKind.SCISSORS: TipShape((0.45, 0.45, 0.8), (0.0, 0.0, 0.8), False),
}


def largest_sections(axes: FloatArray) -> FloatArray:
    """Return the area of each ellipsoid's largest plane section, which is also its largest shadow [m^2], shape (n,).

    Args:
        axes: semi-axes [m], shape (n, 3).
    """
    return np.asarray(pi * np.prod(np.sort(axes, axis=1)[:, 1:], axis=1), dtype=np.float64)


@njit(cache=True)
def turn_body(
    axes: FloatArray,
    middle: FloatArray,
    tip: FloatArray,
    direction: FloatArray,
    roll: float,
    centre: FloatArray,
    spread: FloatArray,
) -> None:  # pragma: no cover - compiled
    """Turn a tip's ellipsoid into the room.

    Args:
        axes: semi-axes [m], shape (3,).
        middle: from the tip, in the tool's axes [m], shape (3,).
        tip: position [m], shape (3,).
        direction: unit vector along the shaft towards the tip, shape (3,).
        roll: right-handed about `direction`, from where y points as far up as the shaft allows [rad].
        centre: overwritten with the ellipsoid's middle [m], shape (3,).
        spread: overwritten with S [m^2], shape (3, 3).
    """
    bx, by, bz = -direction[0], -direction[1], -direction[2]
    ux, uy, uz = -bz * bx, -bz * by, 1.0 - bz * bz
    size = sqrt(ux * ux + uy * uy + uz * uz)
    if size <= _SIDEWAYS:
        ux, uy, uz = -by * bx, 1.0 - by * by, -by * bz
        size = sqrt(ux * ux + uy * uy + uz * uz)
    ux, uy, uz = ux / size, uy / size, uz / size
    c, s = cos(roll), sin(roll)
    yx = c * ux + s * (-by * uz + bz * uy)
    yy = c * uy + s * (-bz * ux + bx * uz)
    yz = c * uz + s * (-bx * uy + by * ux)
    xx, xy, xz = yy * bz - yz * by, yz * bx - yx * bz, yx * by - yy * bx
    frame = ((xx, xy, xz), (yx, yy, yz), (bx, by, bz))
    for i in range(3):
        centre[i] = tip[i] + middle[0] * frame[0][i] + middle[1] * frame[1][i] + middle[2] * frame[2][i]
        for k in range(3):
            spread[i, k] = (
                axes[0] ** 2 * frame[0][i] * frame[0][k]
                + axes[1] ** 2 * frame[1][i] * frame[1][k]
                + axes[2] ** 2 * frame[2][i] * frame[2][k]
            )


@njit(cache=True)
def lowest(centre: FloatArray, spread: FloatArray, out: FloatArray) -> None:  # pragma: no cover - compiled
    """Write the lowest point of an ellipsoid [m], shape (3,)."""
    down = sqrt(spread[2, 2])
    for i in range(3):
        out[i] = centre[i] - spread[i, 2] / down


@njit(cache=True)
def underside(
    spread: FloatArray, dx: float, dy: float
) -> tuple[float, float, float]:  # pragma: no cover - compiled
    """Return an ellipsoid's underside at dx, dy from its middle: height [m], slopes along x and y [1].

    Beside the ellipsoid the height is infinite.
    """
    det = spread[0, 0] * spread[1, 1] - spread[0, 1] * spread[0, 1]
    ax = (spread[1, 1] * dx - spread[0, 1] * dy) / det
    ay = (spread[0, 0] * dy - spread[0, 1] * dx) / det
    left = 1.0 - ax * dx - ay * dy
    if left <= 0.0:
        return inf, 0.0, 0.0
    tx = (spread[1, 1] * spread[0, 2] - spread[0, 1] * spread[1, 2]) / det
    ty = (spread[0, 0] * spread[1, 2] - spread[0, 1] * spread[0, 2]) / det
    thick = sqrt(max(spread[2, 2] - tx * spread[0, 2] - ty * spread[1, 2], 0.0))
    root = sqrt(left)
    return tx * dx + ty * dy - thick * root, tx + thick * ax / root, ty + thick * ay / root


@njit(cache=True)
def underside_or_side(spread: FloatArray, dx: float, dy: float) -> float:  # pragma: no cover - compiled
    """Return the underside's height as `underside` does, and beside the ellipsoid that of its widest section [m]."""
    det = spread[0, 0] * spread[1, 1] - spread[0, 1] * spread[0, 1]
    ax = (spread[1, 1] * dx - spread[0, 1] * dy) / det
    ay = (spread[0, 0] * dy - spread[0, 1] * dx) / det
    tx = (spread[1, 1] * spread[0, 2] - spread[0, 1] * spread[1, 2]) / det
    ty = (spread[0, 0] * spread[1, 2] - spread[0, 1] * spread[0, 2]) / det
    thick2 = spread[2, 2] - tx * spread[0, 2] - ty * spread[1, 2]
    height: float = tx * dx + ty * dy - sqrt(max(thick2, 0.0) * max(1.0 - ax * dx - ay * dy, 0.0))
    return height
