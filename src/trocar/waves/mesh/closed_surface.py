"""A closed surface of triangles, as scans and drawing programs write them, and the tetrahedra that fill it.

Inside is where a line straight up leaves the surface once more than it enters it. The distance is that to the plane of
the nearest of many points spread over the triangles, so edges sharper than the spacing are blunted.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from trocar.errors import InputError
from trocar.model import FloatArray
from trocar.waves.mesh.parts import parts
from trocar.waves.mesh.solid_mesh import IntArray, shown
from trocar.waves.mesh.stuffing import check_spacing, stuffed

_SAME = 1e-7  # of the extent: corners nearer than this are one
_ACROSS = 24  # spacings in the longest side, where none is given
_SAMPLED = 0.25  # of a spacing between points on the surface
_CHUNK = 2_000_000  # pairs of a line and a triangle looked at together


def welded(corners: FloatArray, triangles: IntArray) -> tuple[FloatArray, IntArray]:
    """Return a surface whose triangles share corners: STL gives each its own."""
    step = _SAME * max(float(np.ptp(corners, axis=0).max()), 1e-300)
    _, first, place = np.unique(
        np.round(corners / step).astype(np.int64), axis=0, return_index=True, return_inverse=True
    )
    joined = place.ravel()[triangles]
    whole = (np.diff(np.sort(joined, axis=1), axis=1) > 0).all(axis=1)
    return corners[first], joined[whole]


def filled(
    corners: FloatArray, triangles: IntArray, spacing: float | None = None, *, name: str = "surface"
) -> tuple[FloatArray, IntArray]:
    """Return corners [m] and tetrahedra that fill a closed surface.

    Args:
        corners: of the triangles [m], shape (n, 3).
        triangles: shape (k, 3).
        spacing: of the lattice of tetrahedra [m]; None takes a twenty-fourth of the longest side.
        name: what errors call it.

    Raises:
        InputError: it has holes, is in several pieces, or is thinner than the spacing everywhere.
    """
    corners, triangles = welded(corners, triangles)
    _check_closed(corners, triangles, name)
    low, high = corners.min(axis=0), corners.max(axis=0)
    spacing = float((high - low).max()) / _ACROSS if spacing is None else spacing
    check_spacing(low, high, spacing)
    points, normals = _spread(corners[triangles], _SAMPLED * spacing)
    tree = cKDTree(points)

    def level(places: FloatArray) -> FloatArray:
        _, nearest = tree.query(places)
        distance = np.abs(np.einsum("nc,nc->n", places - points[nearest], normals[nearest]))
        return np.asarray(np.where(_inside(places, corners[triangles], name), -distance, distance))

    return stuffed(level, low, high, spacing)


def _check_closed(corners: FloatArray, triangles: IntArray, name: str) -> None:
    if len(triangles) == 0:
        raise InputError(name, "triangles that have an area", "none")
    edges = np.sort(np.concatenate([triangles[:, [i, j]] for i, j in ((0, 1), (1, 2), (2, 0))]), axis=1)
    edges, count = np.unique(edges, axis=0, return_counts=True)
    if (count != 2).any():
        first = corners[edges[int(np.argmax(count != 2)), 0]]
        raise InputError(
            name,
            "a closed surface, two triangles at every edge",
            f"{int((count == 1).sum())} edges of holes and {int((count > 2).sum())} where more meet, "
            f"the first at {shown(first)}",
            "close the holes in the program that made it (there: make watertight, or make manifold)",
        )
    pieces = parts(triangles, len(corners))
    if pieces.max() > 0:
        raise InputError(
            name, "one closed surface", f"{int(pieces.max()) + 1} pieces", "save each in a file of its own"
        )


def _spread(triangles: FloatArray, apart: float) -> tuple[FloatArray, FloatArray]:
    """Return points about so far apart [m] on triangles, shape (n, 3), and the triangles' unit normals there."""
    a, b, c = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    normal = np.cross(b - a, c - a)
    normal = normal / np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-300)
    longest = np.max([np.linalg.norm(p - q, axis=1) for p, q in ((a, b), (b, c), (c, a))], axis=0)
    steps = np.maximum(1, np.ceil(longest / apart)).astype(int)
    points, normals = [], []
    for count in np.unique(steps):
        here = steps == count
        i, j = (grid.ravel() for grid in np.meshgrid(np.arange(count), np.arange(count)))
        keep = i + j < count
        s, t = ((grid[keep] + 1 / 3) / count for grid in (i, j))
        weights = np.stack([1 - s - t, s, t], axis=1)
        points.append(np.einsum("kw,nwc->nkc", weights, triangles[here]).reshape(-1, 3))
        normals.append(np.repeat(normal[here], len(weights), axis=0))
    return np.concatenate(points), np.concatenate(normals)


def _inside(places: FloatArray, triangles: FloatArray, name: str) -> np.ndarray:
    """Return whether places are inside, shape (n,): whether they have an odd number of triangles above them."""
    lines, which = np.unique(places[:, :2], axis=0, return_inverse=True)
    which = which.ravel()
    first = triangles[:, 0]
    one, other = triangles[:, 1] - first, triangles[:, 2] - first
    area = one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0]
    upright = np.abs(area) <= 1e-14 * np.abs(area).max()
    area = np.where(upright, 1.0, area)
    line, height = [], []
    chunk = max(1, _CHUNK // len(triangles))
    for begin in range(0, len(lines), chunk):
        here = lines[begin : begin + chunk, None] - first[:, :2]
        s = (here[..., 0] * other[:, 1] - here[..., 1] * other[:, 0]) / area
        t = (one[:, 0] * here[..., 1] - one[:, 1] * here[..., 0]) / area
        row, hit = np.nonzero((s >= 0) & (t >= 0) & (s + t < 1) & ~upright)
        line.append(row + begin)
        height.append(first[hit, 2] + s[row, hit] * one[hit, 2] + t[row, hit] * other[hit, 2])
    crossed, heights = np.concatenate(line), np.concatenate(height)
    odd = np.bincount(crossed, minlength=len(lines)) % 2 == 1
    if odd.any():
        raise InputError(
            name,
            "a closed surface, which a line enters as often as it leaves",
            f"another at x, y = {shown(lines[int(np.argmax(odd))])}",
            "choose a slightly different spacing; if that does not help, repair the surface",
        )
    order = np.lexsort((heights, crossed))
    crossed, heights = crossed[order], heights[order]
    ends = np.searchsorted(crossed, np.arange(len(lines) + 1))
    span = 2 * float(np.abs(triangles[..., 2]).max() + np.abs(places[:, 2]).max()) + 1.0
    below = np.searchsorted(crossed * span + heights, which * span + places[:, 2])
    above = ends[which + 1] - np.clip(below, ends[which], ends[which + 1])
    return np.asarray(above % 2 == 1)
