"""Tetrahedra that fill a closed shape given by a level: isosurface stuffing.

The lattice is body-centred cubic. Of each tetrahedron what is below level 0 is kept; a node near the surface is first
moved onto it, so that nothing flat is left (Labelle and Shewchuk 2007, ACM Trans. Graph. 26:57, with their distances).
The level is taken as linear along an edge. A quadrilateral that two elements share is cut from its node of lower
number, which both know.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from trocar.errors import InputError
from trocar.model import FloatArray
from trocar.waves.mesh.solid_mesh import MOST_CORNERS, IntArray, volumes_of

Level = Callable[[FloatArray], FloatArray]
"""Of places [m], shape (n, 3): below 0 inside, above it outside, and about even across the surface."""

_NEAR_LONG, _NEAR_SHORT = 0.24999, 0.41189  # of an edge: a nearer node is moved onto the surface
_EDGES = ((0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3))
_SHIFT = np.array([0.377, 0.291, 0.433])  # of a spacing: no lattice plane falls on a face along the axes
_CORNERS = np.array([(i, j, k) for i in (0, 1) for j in (0, 1) for k in (0, 1)])


def stuffed(level: Level, low: FloatArray, high: FloatArray, spacing: float) -> tuple[FloatArray, IntArray]:
    """Return corners [m], shape (n, 3), and tetrahedra, shape (m, 4), that fill a shape.

    Args:
        level: of the shape.
        low: least x, y and z of it [m].
        high: largest x, y and z [m].
        spacing: side of the lattice's cubes [m].

    Raises:
        InputError: it would take too many nodes, or nothing is inside.
    """
    check_spacing(low, high, spacing)
    places, cells, short = _lattice(np.asarray(low), np.asarray(high), spacing)
    values = level(places)
    near = (values[cells] <= 0).any(axis=1)
    cells, short = cells[near], short[near]
    places, values = _moved(places, values, cells, short)
    corners, cells = _cut(places, values, cells)
    if len(cells) == 0:
        raise InputError("spacing", "one smaller than the shape", spacing)
    used, cells = np.unique(cells, return_inverse=True)
    corners, cells = corners[used], cells.reshape(-1, 4).astype(np.int64)
    turned = volumes_of(corners, cells) < 0
    cells[turned] = cells[turned][:, [1, 0, 2, 3]]
    return corners, cells


def check_spacing(low: FloatArray, high: FloatArray, spacing: float) -> None:
    """Refuse a spacing [m] that is none, or takes too many nodes for a shape between two corners [m]."""
    if not spacing > 0:
        raise InputError("spacing", "a length above 0 [m]", spacing)
    expected = 2 * float(np.prod(np.asarray(high) - low)) / spacing**3
    if expected > 4 * MOST_CORNERS:
        raise InputError(
            "spacing",
            f"one that fills the shape with at most {MOST_CORNERS} nodes",
            spacing,
            "take a larger one",
        )


def _lattice(low: FloatArray, high: FloatArray, spacing: float) -> tuple[FloatArray, IntArray, np.ndarray]:
    """Return nodes, tetrahedra and which of their edges are short, shape (m, 6)."""
    start = low - spacing * (1 + _SHIFT)
    count = np.ceil((high - start) / spacing).astype(int) + 2
    cubes = count - 1
    grid = np.stack(np.meshgrid(*(np.arange(n) for n in count), indexing="ij"), axis=-1).reshape(-1, 3)
    middles = np.stack(np.meshgrid(*(np.arange(n) for n in cubes), indexing="ij"), axis=-1).reshape(-1, 3)
    places = start + spacing * np.concatenate([grid, middles + 0.5])

    def node(at: np.ndarray) -> np.ndarray:
        return np.asarray((at[:, 0] * count[1] + at[:, 1]) * count[2] + at[:, 2])

    def middle(at: np.ndarray) -> np.ndarray:
        return np.asarray(len(grid) + (at[:, 0] * cubes[1] + at[:, 1]) * cubes[2] + at[:, 2])

    found = []
    for axis in range(3):
        one, other = np.eye(3, dtype=int)[(axis + 1) % 3], np.eye(3, dtype=int)[(axis + 2) % 3]
        ahead = np.eye(3, dtype=int)[axis]
        first = middles[middles[:, axis] < cubes[axis] - 1]
        ring = [first + ahead, first + ahead + one, first + ahead + one + other, first + ahead + other]
        for here, there in zip(ring, ring[1:] + ring[:1], strict=True):
            found.append(np.stack([middle(first), middle(first + ahead), node(here), node(there)], axis=1))
    cells = np.concatenate(found)
    # Middle to middle, and node to node, lie a spacing apart; a middle and a node sqrt(3)/2 of it.
    return places, cells, np.tile([False, True, True, True, True, False], (len(cells), 1))


def _moved(
    places: FloatArray, values: FloatArray, cells: IntArray, short: np.ndarray
) -> tuple[FloatArray, FloatArray]:
    """Move nodes near the surface onto it, each along its nearest cut edge."""
    ends = np.concatenate([cells[:, list(edge)] for edge in _EDGES])
    limit = np.where(short.T.ravel(), _NEAR_SHORT, _NEAR_LONG)
    crossing = values[ends[:, 0]] * values[ends[:, 1]] < 0
    ends, limit = ends[crossing], limit[crossing]
    ends, limit = np.concatenate([ends, ends[:, ::-1]]), np.tile(limit, 2)
    along = values[ends[:, 0]] / (values[ends[:, 0]] - values[ends[:, 1]])
    near = along < limit
    ends, along = ends[near], along[near]
    reach = along * np.linalg.norm(places[ends[:, 1]] - places[ends[:, 0]], axis=1)
    order = np.lexsort((ends[:, 1], reach, ends[:, 0]))
    nodes, first = np.unique(ends[order, 0], return_index=True)
    best = order[first]
    places, values = places.copy(), values.copy()
    start = places[nodes]
    places[nodes] = start + along[best, None] * (places[ends[best, 1]] - start)
    values[nodes] = 0.0
    return places, values


def _cut(places: FloatArray, values: FloatArray, cells: IntArray) -> tuple[FloatArray, IntArray]:
    """Return nodes and tetrahedra of what lies below level 0."""
    sign = np.sign(values).astype(int)
    order = np.argsort(10 * len(values) * sign[cells] + cells, axis=1)  # inside first, then on it; by number
    cells = np.take_along_axis(cells, order, axis=1)
    signs = sign[cells]
    inside, outside = (signs < 0).sum(axis=1), (signs > 0).sum(axis=1)
    ends, new = [places], len(places)
    known: dict[tuple[int, int], int] = {}

    def on(rows: np.ndarray, i: int, j: int) -> np.ndarray:
        """Return the nodes where edges from inside to outside are cut, or their outer ends where these are on it."""
        nonlocal new
        result = rows[:, j].copy()
        for place in np.flatnonzero(sign[rows[:, j]] > 0):
            key = int(rows[place, i]), int(rows[place, j])
            if key not in known:
                share = values[key[0]] / (values[key[0]] - values[key[1]])
                ends.append((places[key[0]] + share * (places[key[1]] - places[key[0]]))[None])
                known[key] = new
                new += 1
            result[place] = known[key]
        return result

    whole = cells[(inside > 0) & (outside == 0)]
    found = [whole]
    one = cells[(inside == 1) & (outside > 0)]
    found.append(np.stack([one[:, 0], on(one, 0, 1), on(one, 0, 2), on(one, 0, 3)], axis=1))
    pyramid = cells[(inside == 2) & (outside == 1)]  # nodes inside 0 and 1, on it 2, outside 3
    a, b, tip = pyramid[:, 0], pyramid[:, 1], pyramid[:, 2]
    from_a, from_b = on(pyramid, 0, 3), on(pyramid, 1, 3)
    found += [np.stack([tip, a, b, from_b], axis=1), np.stack([tip, a, from_b, from_a], axis=1)]
    three = cells[(inside == 3) & (outside == 1)]
    found += _prism([three[:, 0], three[:, 1], three[:, 2]], [on(three, k, 3) for k in range(3)])
    two = cells[(inside == 2) & (outside == 2)]
    found += _prism([two[:, 0], on(two, 0, 2), on(two, 0, 3)], [two[:, 1], on(two, 1, 2), on(two, 1, 3)])
    return np.concatenate(ends), np.concatenate(found)


def _prism(lower: list[np.ndarray], upper: list[np.ndarray]) -> list[np.ndarray]:
    """Return three tetrahedra; the quadrilaterals are cut from lower 0, 0 and 1 to upper 1, 2 and 2."""
    (a, b, c), (d, e, f) = lower, upper
    return [np.stack(four, axis=1) for four in ([a, d, e, f], [a, b, e, f], [a, b, c, f])]
