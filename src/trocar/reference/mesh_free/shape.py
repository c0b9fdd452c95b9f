"""Shape functions: moving least squares with a linear basis, N_I(x) = w_I(x) p(x_I) . c, M c = p(x), M = sum w p p^T.

(P. Lancaster and K. Salkauskas 1981, Math. Comput. 37:141; with a linear basis they are the reproducing kernel of W. K.
Liu, S. Jun and Y. F. Zhang 1995, Int. J. Numer. Methods Fluids 20:1081.) The weight is a product of cubic splines, one
along each axis, over the node's reach there. They add up to 1 and reproduce linear fields wherever four nodes that are
felt lie in no plane. Where they all lie in a plane, as on a face that ends supports, the slope across it is not
determined and does not matter there: its pivot is zero and it is left out. In a sliver between cuts with fewer nodes
the fit loses a slope likewise and is lower by an order (G. R. Joldes et al. 2015, Appl. Math. Model. 39:2116, keep a
quadratic fit from failing in the same spirit, by a penalty).
"""

from __future__ import annotations

import numpy as np
from numba import njit

from trocar.model import FloatArray
from trocar.reference.grid import IntArray
from trocar.reference.mesh_free.cloud import Cloud
from trocar.reference.mesh_free.cut import hidden

_SINGULAR = 1e-10  # of the sum of the weights: a pivot below it is rounding


@njit(cache=True, nogil=True)
def felt_in_cell(cloud: Cloud, i: int, j: int, k: int, found: IntArray) -> int:  # pragma: no cover - compiled
    """Write the nodes whose support meets the cell (i, j, k), cuts or not; return how many."""
    nx, ny, nz = len(cloud.x), len(cloud.y), len(cloud.z)
    count = 0
    for a in range(max(0, i - cloud.lines[0]), min(nx, i + 2 + cloud.lines[0])):
        for b in range(max(0, j - cloud.lines[1]), min(ny, j + 2 + cloud.lines[1])):
            for c in range(max(0, k - cloud.lines[2]), min(nz, k + 2 + cloud.lines[2])):
                node = (a * ny + b) * nz + c
                place, below, above = cloud.places[node], cloud.below[node], cloud.above[node]
                if not (
                    place[0] - below[0] < cloud.x[i + 1]
                    and place[0] + above[0] > cloud.x[i]
                    and place[1] - below[1] < cloud.y[j + 1]
                    and place[1] + above[1] > cloud.y[j]
                    and place[2] - below[2] < cloud.z[k + 1]
                    and place[2] + above[2] > cloud.z[k]
                ):
                    continue
                while node >= 0:
                    found[count] = node
                    count += 1
                    node = cloud.copy[node]
    return count


@njit(cache=True, nogil=True)
def _spline(share: float) -> float:  # pragma: no cover - compiled
    """Return the cubic spline of the distance over the reach."""
    if share >= 1.0:
        return 0.0
    if share > 0.5:
        return 4.0 / 3.0 * (1.0 - share) ** 3
    return 2.0 / 3.0 - 4.0 * share**2 * (1.0 - share)


@njit(cache=True, nogil=True)
def shape_functions(
    cloud: Cloud,
    point: FloatArray,
    seen_from: FloatArray,
    felt: IntArray,
    scale: FloatArray,
    values: FloatArray,
) -> bool:  # pragma: no cover - compiled
    """Write the shape functions of nodes at a point; return whether any node is seen.

    Args:
        cloud: the nodes.
        point: where [m], shape (3,).
        seen_from: where cuts are looked across from [m], shape (3,): the point, or a place on its side of a cut.
        felt: nodes, shape (n,).
        scale: a length along each axis [m], shape (3,), near the distance of nodes.
        values: written, shape (n,).
    """
    matrix, basis = np.zeros((4, 4)), np.ones(4)
    for number in range(len(felt)):
        node, weight = felt[number], 1.0
        for k in range(3):
            offset = point[k] - cloud.places[node, k]
            reach = cloud.above[node, k] if offset > 0.0 else cloud.below[node, k]
            weight *= _spline(abs(offset) / reach)
        if weight > 0.0 and cloud.cuts.shape[0] > 0 and hidden(cloud.cuts, seen_from, cloud.seen_at[node]):
            weight = 0.0
        values[number] = weight
        if weight == 0.0:
            continue
        for k in range(3):
            basis[k + 1] = (cloud.places[node, k] - point[k]) / scale[k]
        for a in range(4):
            for b in range(a + 1):
                matrix[a, b] += weight * basis[a] * basis[b]
    total = matrix[0, 0]
    if total == 0.0:
        return False
    coefficients = _solve(matrix, _SINGULAR * total)
    for number in range(len(felt)):
        if values[number] != 0.0:
            fit = coefficients[0]
            for k in range(3):
                fit += coefficients[k + 1] * (cloud.places[felt[number], k] - point[k]) / scale[k]
            values[number] *= fit
    return True


@njit(cache=True, nogil=True)
def evaluate(
    cloud: Cloud, points: FloatArray, slab: int
) -> tuple[IntArray, IntArray, FloatArray]:  # pragma: no cover - compiled
    """Return the shape functions at points on the upper face of a slab, as the three arrays of a CSR matrix.

    Args:
        cloud: the nodes.
        points: places on the block [m], shape (n, 2).
        slab: number of the slab between two z planes.
    """
    felt, starts = np.empty(len(cloud.places), np.int64), np.zeros(len(points) + 1, np.int64)
    cell = np.empty((len(points), 2), np.int64)
    for number in range(len(points)):
        cell[number, 0] = _interval(cloud.x, points[number, 0])
        cell[number, 1] = _interval(cloud.y, points[number, 1])
        count = felt_in_cell(cloud, cell[number, 0], cell[number, 1], slab, felt)
        starts[number + 1] = starts[number] + count
    nodes, values = np.empty(starts[-1], np.int64), np.empty(starts[-1])
    place, edge = np.empty(3), np.empty(3)
    place[2], edge[2] = cloud.z[slab + 1], cloud.z[slab + 1] - cloud.z[slab]
    for number in range(len(points)):
        i, j = cell[number]
        place[0], place[1] = points[number]
        edge[0], edge[1] = cloud.x[i + 1] - cloud.x[i], cloud.y[j + 1] - cloud.y[j]
        row = slice(starts[number], starts[number + 1])
        felt_in_cell(cloud, i, j, slab, felt)
        nodes[row] = felt[: starts[number + 1] - starts[number]]
        shape_functions(cloud, place, place, nodes[row], edge, values[row])
    return starts, nodes, values


@njit(cache=True, nogil=True)
def _interval(lines: FloatArray, where: float) -> int:  # pragma: no cover - compiled
    below = int(np.searchsorted(lines, where, side="right")) - 1
    return min(max(below, 0), len(lines) - 2)


@njit(cache=True, nogil=True)
def _solve(matrix: FloatArray, least: float) -> FloatArray:  # pragma: no cover - compiled
    """Return the first column of the inverse; directions whose pivot is below `least` are left out.

    With M = L D L^T the right side (1, 0, 0, 0) gives L y = e_0, c = L^-T D^-1 y.
    """
    lower, pivot, y = np.eye(4), np.zeros(4), np.zeros(4)
    y[0] = 1.0
    for a in range(4):
        for b in range(a):
            if pivot[b] > 0.0:
                value = matrix[a, b]
                for c in range(b):
                    value -= lower[a, c] * pivot[c] * lower[b, c]
                lower[a, b] = value / pivot[b]
        pivot[a] = matrix[a, a]
        for b in range(a):
            pivot[a] -= lower[a, b] ** 2 * pivot[b]
            y[a] -= lower[a, b] * y[b]
        if pivot[a] <= least:
            pivot[a], y[a] = 0.0, 0.0
    coefficients = np.zeros(4)
    for a in range(3, -1, -1):
        if pivot[a] > 0.0:
            coefficients[a] = y[a] / pivot[a]
            for b in range(a + 1, 4):
                coefficients[a] -= lower[b, a] * coefficients[b]
    return coefficients
