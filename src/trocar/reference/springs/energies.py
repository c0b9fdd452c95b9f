"""What the springs store, their forces and the derivatives of these, compiled.

With l the present length of an edge, L that at rest and T its tension; with l1, l2 the present lengths of a face's
diagonals; with p, q, r the means of a box's edges along x, y and z and J = p . (q x r) / V,

    W = k (l - L)^2 / 2 + T (l^2 - L^2) / (2 L),    W = k (l1 - l2)^2 / 2,    W = k (J - 1)^2 / 2.

They do not change when the lattice turns. The term with T is a prestress that stays a second Piola-Kirchhoff stress of
the body at rest, as the finite elements have it.

A spring's stiffness is k g g^T, g its gradient, and the force times the curvature of what it measures. The second part
may be negative: the convex stand-in leaves out what of it is (K.-J. Choi and H.-S. Ko 2002, ACM Trans. Graph. 21:604,
for edges; J. Teran et al. 2005, Proc. Symp. Computer Animation:181, in general), of volume springs all of it.
"""

from __future__ import annotations

from math import sqrt

import numpy as np
from numba import njit

from trocar.model import FloatArray
from trocar.reference.grid import IntArray

EXACT, CONVEX, STIFFENING = 0, 1, 2
"""Which stiffness: all of it, what is positive of it, or k g g^T alone."""

_CORNER = np.array([[x, y, z] for x in (-0.25, 0.25) for y in (-0.25, 0.25) for z in (-0.25, 0.25)])
_CODE = np.array([9 * x + 3 * y + z for x in (0, 1) for y in (0, 1) for z in (0, 1)])


@njit(cache=True)
def edge_forces(
    rest: FloatArray,
    moved: FloatArray,
    ends: IntArray,
    length: FloatArray,
    k: FloatArray,
    tension: FloatArray,
    force: FloatArray,
) -> float:  # pragma: no cover - compiled
    """Add the forces [N] that hold the edges' lengths, shape (nodes, 3) as the places; return what is stored [J]."""
    stored, d = 0.0, np.empty(3)
    for e in range(len(k)):
        a, b = ends[e]
        now, squares = _span(rest, moved, a, b, d)
        longer = squares / (now + length[e])
        pull = tension[e] / length[e] + (k[e] * longer / now if now > 0.0 else 0.0)
        for i in range(3):
            force[b, i] += pull * d[i]
            force[a, i] -= pull * d[i]
        stored += 0.5 * k[e] * longer**2 + 0.5 * tension[e] * squares / length[e]
    return stored


@njit(cache=True)
def scissor_forces(
    rest: FloatArray, moved: FloatArray, corners: IntArray, k: FloatArray, force: FloatArray
) -> float:  # pragma: no cover - compiled
    """Add the forces [N] that hold the diagonals' difference; return what is stored [J]."""
    stored, d1, d2 = 0.0, np.empty(3), np.empty(3)
    for e in range(len(k)):
        l1, squares1 = _span(rest, moved, corners[e, 0], corners[e, 2], d1)
        l2, squares2 = _span(rest, moved, corners[e, 1], corners[e, 3], d2)
        difference = (squares1 - squares2) / (l1 + l2) if l1 + l2 > 0.0 else 0.0
        first = k[e] * difference / l1 if l1 > 0.0 else 0.0
        second = k[e] * difference / l2 if l2 > 0.0 else 0.0
        for i in range(3):
            force[corners[e, 2], i] += first * d1[i]
            force[corners[e, 0], i] -= first * d1[i]
            force[corners[e, 3], i] -= second * d2[i]
            force[corners[e, 1], i] += second * d2[i]
        stored += 0.5 * k[e] * difference**2
    return stored


@njit(cache=True)
def volume_forces(
    moved: FloatArray, corners: IntArray, sides: FloatArray, k: FloatArray, force: FloatArray
) -> tuple[float, int]:  # pragma: no cover - compiled
    """Add the forces [N] that hold the volumes; return what is stored [J] and the first box inside out, or -1."""
    stored, inside_out = 0.0, -1
    gradient, slopes = np.empty((8, 3)), np.empty((3, 3))
    for e in range(len(k)):
        swelling = _swelling(moved, corners[e], sides[e], slopes, gradient)
        if swelling <= -1.0 and inside_out < 0:
            inside_out = e
        for a in range(8):
            for i in range(3):
                force[corners[e, a], i] += k[e] * swelling * gradient[a, i]
        stored += 0.5 * k[e] * swelling**2
    return stored, inside_out


@njit(cache=True)
def edge_stiffness(
    rest: FloatArray,
    moved: FloatArray,
    ends: IntArray,
    code: IntArray,
    length: FloatArray,
    k: FloatArray,
    tension: FloatArray,
    kind: int,
    blocks: FloatArray,
) -> None:  # pragma: no cover - compiled
    """Add the derivative of the forces [N/m] to blocks (nodes, 27, 3, 3): node, neighbour's code, components."""
    d = np.empty(3)
    for e in range(len(k)):
        a, b = ends[e]
        now, squares = _span(rest, moved, a, b, d)
        along = k[e] / now**2 if now > 0.0 else 0.0
        turning = along * now * squares / (now + length[e]) if kind != STIFFENING else 0.0
        if kind == CONVEX:
            turning = max(turning, 0.0)
        along -= turning / now**2 if now > 0.0 else 0.0
        even = turning if kind == STIFFENING else turning + tension[e] / length[e]
        for i in range(3):
            for j in range(3):
                value = along * d[i] * d[j] + (even if i == j else 0.0)
                blocks[a, 13, i, j] += value
                blocks[b, 13, i, j] += value
                blocks[a, 13 + code[e], i, j] -= value
                blocks[b, 13 - code[e], i, j] -= value


@njit(cache=True)
def scissor_stiffness(
    rest: FloatArray,
    moved: FloatArray,
    corners: IntArray,
    code: IntArray,
    k: FloatArray,
    kind: int,
    blocks: FloatArray,
) -> None:  # pragma: no cover - compiled
    """As `edge_stiffness`."""
    gradient, turned = np.empty((4, 3)), np.empty((2, 3, 3))
    d1, d2 = np.empty(3), np.empty(3)
    for e in range(len(k)):
        l1, squares1 = _span(rest, moved, corners[e, 0], corners[e, 2], d1)
        l2, squares2 = _span(rest, moved, corners[e, 1], corners[e, 3], d2)
        over1, over2 = (1.0 / l1 if l1 > 0.0 else 0.0), (1.0 / l2 if l2 > 0.0 else 0.0)
        pull = k[e] * (squares1 - squares2) / (l1 + l2) if l1 + l2 > 0.0 and kind != STIFFENING else 0.0
        first, second = pull * over1, -pull * over2
        if kind == CONVEX:
            first, second = max(first, 0.0), max(second, 0.0)
        for i in range(3):
            n1, n2 = d1[i] * over1, d2[i] * over2
            gradient[0, i], gradient[1, i], gradient[2, i], gradient[3, i] = -n1, n2, n1, -n2
        for i in range(3):
            for j in range(3):
                one = 1.0 if i == j else 0.0
                turned[0, i, j] = first * (one - gradient[0, i] * gradient[0, j])
                turned[1, i, j] = second * (one - gradient[1, i] * gradient[1, j])
        for a in range(4):
            for b in range(4):
                at = 13 + code[e, b] - code[e, a]
                sign = 0.0 if (a + b) % 2 else (1.0 if a == b else -1.0)
                for i in range(3):
                    for j in range(3):
                        value = k[e] * gradient[a, i] * gradient[b, j] + sign * turned[a % 2, i, j]
                        blocks[corners[e, a], at, i, j] += value


@njit(cache=True)
def volume_stiffness(
    moved: FloatArray, corners: IntArray, sides: FloatArray, k: FloatArray, kind: int, blocks: FloatArray
) -> None:  # pragma: no cover - compiled
    """As `edge_stiffness`."""
    gradient, slopes, bent = np.empty((8, 3)), np.empty((3, 3)), np.empty(3)
    for e in range(len(k)):
        swelling = _swelling(moved, corners[e], sides[e], slopes, gradient)
        pressure = k[e] * swelling if kind == EXACT else 0.0
        for axis in range(3):
            slopes[axis, axis] += 1.0
        for a in range(8):
            for b in range(8):
                node, at = corners[e, a], 13 + _CODE[b] - _CODE[a]
                for i in range(3):
                    for j in range(3):
                        blocks[node, at, i, j] += k[e] * gradient[a, i] * gradient[b, j]
                if pressure == 0.0:
                    continue
                bent[:] = 0.0
                for axis in range(3):
                    one, two = (axis + 1) % 3, (axis + 2) % 3
                    weight = _CORNER[a, two] * _CORNER[b, one] - _CORNER[a, one] * _CORNER[b, two]
                    weight *= pressure / (sides[e, one] * sides[e, two])
                    for i in range(3):
                        bent[i] += weight * slopes[axis, i]
                for i in range(3):
                    j, m = (i + 1) % 3, (i + 2) % 3
                    blocks[node, at, m, j] += bent[i]
                    blocks[node, at, j, m] -= bent[i]


@njit(cache=True)
def _span(
    rest: FloatArray, moved: FloatArray, a: int, b: int, d: FloatArray
) -> tuple[float, float]:  # pragma: no cover - compiled
    """Write the vector from a to b; return its length and by how much its square has grown, free of cancellation."""
    length, growth = 0.0, 0.0
    for i in range(3):
        before, change = rest[b, i] - rest[a, i], moved[b, i] - moved[a, i]
        d[i] = before + change
        length += d[i] ** 2
        growth += change * (2.0 * before + change)
    return sqrt(length), growth


@njit(cache=True)
def _swelling(
    moved: FloatArray, corners: IntArray, sides: FloatArray, slopes: FloatArray, gradient: FloatArray
) -> float:  # pragma: no cover - compiled
    """Return J - 1, free of cancellation; write F - I, a row for each axis at rest, and dJ by the corners."""
    g = slopes
    for axis in range(3):
        for i in range(3):
            g[axis, i] = 0.0
            for a in range(8):
                g[axis, i] += _CORNER[a, axis] * moved[corners[a], i]
            g[axis, i] /= sides[axis]
    gradient[:] = 0.0
    swelling = 0.0
    for axis in range(3):
        one, two = (axis + 1) % 3, (axis + 2) % 3
        swelling += g[axis, axis] + g[one, one] * g[two, two] - g[one, two] * g[two, one]
        swelling += g[0, axis] * (g[1, one] * g[2, two] - g[1, two] * g[2, one])
        for i in range(3):
            j, m = (i + 1) % 3, (i + 2) % 3
            first = (g[one, j] + (1.0 if one == j else 0.0)) * (g[two, m] + (1.0 if two == m else 0.0))
            second = (g[one, m] + (1.0 if one == m else 0.0)) * (g[two, j] + (1.0 if two == j else 0.0))
            for a in range(8):
                gradient[a, i] += _CORNER[a, axis] / sides[axis] * (first - second)
    return swelling
