"""Mirror symmetry: any load on the block as four loads on a quarter of it.

The block, its layers and its supports are their own mirror images in the planes x = a/2 and y = b/2. A vector
field is mirrored in x by u_x(x) -> -u_x(a - x), u_y(x) -> u_y(a - x), u_z(x) -> u_z(a - x), in y likewise.
Every field is the sum of four parts, each even (+1) or odd (-1) under each mirror, and the elastic problem
does not mix them. Each part is known from the quarter 0 <= x <= a/2, 0 <= y <= b/2, where its mirror planes
are boundaries: an even part has no displacement normal to the plane, an odd one none tangential to it.

The quarter's nodal forces of a part are 1/4 of the sum, over the four quarters, of the load mirrored into the
first one, with the part's sign for every mirror used.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from trocar.errors import InputError
from trocar.model import FloatArray
from trocar.reference.grid import Grid, IntArray


class Parity(NamedTuple):
    """+1 even, -1 odd under the mirror in x and the mirror in y."""

    x: int
    y: int


PARITIES = (Parity(1, 1), Parity(-1, 1), Parity(1, -1), Parity(-1, -1))
QUARTERS = ((0, 0), (1, 0), (0, 1), (1, 1))  # whether a quarter lies beyond x = a/2, beyond y = b/2


def fold(points: FloatArray, size: tuple[float, float]) -> tuple[FloatArray, IntArray]:
    """Mirror points into the first quarter.

    Args:
        points: places [m], shape (n, 2) or (n, 3); only x and y are used.
        size: sides of the block [m].

    Returns:
        Mirrored places [m], shape (n, 2), and 0 or 1 for each mirror used, shape (n, 2).

    Raises:
        InputError: a point is off the block or not finite, or the shape is wrong.
    """
    points = np.asarray(points, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] not in (2, 3):
        raise InputError("points", "an array of shape (n, 3)", points.shape)
    flat, sides = points[:, :2], np.asarray(size)
    slack = 1e-9 * sides
    outside = ~np.all((flat >= -slack) & (flat <= sides + slack), axis=1)
    if outside.any():
        raise InputError(
            "points", f"0 <= x <= {size[0]:g}, 0 <= y <= {size[1]:g} m", flat[outside][0].tolist()
        )
    mirrored = flat > 0.5 * sides
    return np.clip(np.where(mirrored, sides - flat, flat), 0.0, 0.5 * sides), mirrored.astype(np.int64)


def mirrored_lines(lines: FloatArray, side: float) -> FloatArray:
    """Return the grid lines [m] of the whole block from those of its first half."""
    return np.concatenate([lines, (side - lines[:-1])[::-1]])


def mirror_signs(parity: Parity, mirrored: IntArray) -> FloatArray:
    """Return what a part's components in the first quarter are multiplied by in a mirrored place.

    Args:
        parity: of the part.
        mirrored: 0 or 1 for the mirror in x and in y, shape (n, 2).

    Returns:
        Factors 1 or -1 for u_x, u_y, u_z, shape (3, n).
    """
    in_x, in_y = mirrored[:, 0] == 1, mirrored[:, 1] == 1
    part = np.where(in_x, parity.x, 1) * np.where(in_y, parity.y, 1)
    flips = np.stack([np.where(in_x, -1.0, 1.0), np.where(in_y, -1.0, 1.0), np.ones(len(part))])
    return np.asarray(part * flips, dtype=np.float64)


def held_on_mirrors(grid: Grid, parity: Parity) -> np.ndarray[tuple[int, ...], np.dtype[np.bool_]]:
    """Return which components of a part vanish on the mirror planes, shape (3, nodes)."""
    held = np.zeros(grid.nodes.shape, dtype=np.bool_)
    for axis, lines, sign in ((0, grid.x, parity.x), (1, grid.y, parity.y)):
        plane = grid.nodes[axis] >= lines[-1] * (1 - 1e-12)
        for component in range(3):
            if (component == axis) == (sign == 1):
                held[component] |= plane
    return held


def quarter_fields(parts: Mapping[Parity, FloatArray], shape: tuple[int, ...]) -> list[FloatArray]:
    """Add up the parts in each of the four quarters, mirrored into the first; equal quarters are given once.

    Args:
        parts: displacements [m] of shape (3, nodes) for every parity that is not zero.
        shape: (3, nodes), for when there is none.
    """
    quarters = QUARTERS if set(parts) - {Parity(1, 1)} else QUARTERS[:1]
    return [
        sum((parity.x**in_x * parity.y**in_y * part for parity, part in parts.items()), np.zeros(shape))
        for in_x, in_y in quarters
    ]
