"""What the springs store, their forces and the derivatives of these, compiled.

With l the present length of an edge, L that at rest and T its tension; with l1, l2 the present lengths of a face's
diagonals; with p, q, r the means of a box's edges along x, y and z and J = p . (q x r) / V,

    W = k (l - L)^2 / 2 + T (l^2 - L^2) / (2 L),    W = k (l1 - l2)^2 / 2,    W = k (J - 1)^2 / 2.

They do not change when the lattice turns. The term with T is a prestress that stays a second Piola-Kirchhoff stress of
the body at rest, as the finite elements have it.

A spring's stiffness is k g g^T, g its gradient, and the force times the curvature of what it measures. The second part
may be negative: the convex stand-in leaves it out where it is (X. Provot's compressed springs; J. Teran, E. Sifakis,
G. Irving and R. Fedkiw 2005, Proc. SCA:181, project it; D. Baraff and A. Witkin 1998, Proc. SIGGRAPH:43).
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
    place: FloatArray,
    ends: IntArray,
    length: FloatArray,
    k: FloatArray,
    tension: FloatArray,
    force: FloatArray,
) -> float:
    """Add the forces [N] that hold the edges' lengths, shape (nodes, 3) as the places; return what is stored [J]."""
    stored = 0.0
    for e in range(len(k)):
        a, b = ends[e]
        d = place[b] - place[a]
        now = sqrt(d[0] ** 2 + d[1] ** 2 + d[2] ** 2)
        pull = tension[e] / length[e] + (k[e] * (1.0 - length[e] / now) if now > 0.0 else 0.0)
        for i in range(3):
            force[b, i] += pull * d[i]
            force[a, i] -= pull * d[i]
        stored += 0.5 * k[e] * (now - length[e]) ** 2
        stored += 0.5 * tension[e] * (now**2 - length[e] ** 2) / length[e]
    return stored


@njit(cache=True)
def scissor_forces(place: FloatArray, corners: IntArray, k: FloatArray, force: FloatArray) -> float:
    """Add the forces [N] that hold the diagonals' difference; return what is stored [J]."""
    stored = 0.0
    for e in range(len(k)):
        n1, l1 = _direction(place[corners[e, 0]], place[corners[e, 2]])
        n2, l2 = _direction(place[corners[e, 1]], place[corners[e, 3]])
        pull = k[e] * (l1 - l2)
        for i in range(3):
            force[corners[e, 2], i] += pull * n1[i]
            force[corners[e, 0], i] -= pull * n1[i]
            force[corners[e, 3], i] -= pull * n2[i]
            force[corners[e, 1], i] += pull * n2[i]
        stored += 0.5 * k[e] * (l1 - l2) ** 2
    return stored


@njit(cache=True)
def volume_forces(
    place: FloatArray, corners: IntArray, volume: FloatArray, k: FloatArray, force: FloatArray
) -> tuple[float, int]:
    """Add the forces [N] that hold the volumes; return what is stored [J] and the first box inside out, or -1."""
    stored, inside_out = 0.0, -1
    for e in range(len(k)):
        mean = _means(place, corners[e])
        normal = _normals(mean)
        ratio = np.dot(mean[0], normal[0]) / volume[e]
        if ratio <= 0.0 and inside_out < 0:
            inside_out = e
        pressure = k[e] * (ratio - 1.0) / volume[e]
        for a in range(8):
            for i in range(3):
                for axis in range(3):
                    force[corners[e, a], i] += pressure * _CORNER[a, axis] * normal[axis, i]
        stored += 0.5 * k[e] * (ratio - 1.0) ** 2
    return stored, inside_out


@njit(cache=True)
def edge_stiffness(
    place: FloatArray,
    ends: IntArray,
    code: IntArray,
    length: FloatArray,
    k: FloatArray,
    tension: FloatArray,
    kind: int,
    blocks: FloatArray,
) -> None:
    """Add the derivative of the forces [N/m] to blocks (nodes, 27, 3, 3): node, neighbour's code, components."""
    for e in range(len(k)):
        a, b = ends[e]
        n, now = _direction(place[a], place[b])
        turning = k[e] * (1.0 - length[e] / now) if now > 0.0 and kind != STIFFENING else 0.0
        if kind == CONVEX:
            turning = max(turning, 0.0)
        even = turning if kind == STIFFENING else turning + tension[e] / length[e]
        for i in range(3):
            for j in range(3):
                value = (k[e] - turning) * n[i] * n[j] + (even if i == j else 0.0)
                blocks[a, 13, i, j] += value
                blocks[b, 13, i, j] += value
                blocks[a, 13 + code[e], i, j] -= value
                blocks[b, 13 - code[e], i, j] -= value


@njit(cache=True)
def scissor_stiffness(
    place: FloatArray, corners: IntArray, code: IntArray, k: FloatArray, kind: int, blocks: FloatArray
) -> None:
    """As `edge_stiffness`."""
    gradient, turned = np.empty((4, 3)), np.empty((2, 3, 3))
    for e in range(len(k)):
        n1, l1 = _direction(place[corners[e, 0]], place[corners[e, 2]])
        n2, l2 = _direction(place[corners[e, 1]], place[corners[e, 3]])
        pull = k[e] * (l1 - l2) if kind != STIFFENING else 0.0
        first, second = (pull / l1 if l1 > 0.0 else 0.0), (-pull / l2 if l2 > 0.0 else 0.0)
        if kind == CONVEX:
            first, second = max(first, 0.0), max(second, 0.0)
        for i in range(3):
            gradient[0, i], gradient[1, i], gradient[2, i], gradient[3, i] = -n1[i], n2[i], n1[i], -n2[i]
            for j in range(3):
                one = 1.0 if i == j else 0.0
                turned[0, i, j] = first * (one - n1[i] * n1[j])
                turned[1, i, j] = second * (one - n2[i] * n2[j])
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
    place: FloatArray, corners: IntArray, volume: FloatArray, k: FloatArray, kind: int, blocks: FloatArray
) -> None:
    """As `edge_stiffness`."""
    gradient, crossed = np.empty((8, 3)), np.empty((3, 3, 3))
    for e in range(len(k)):
        mean = _means(place, corners[e])
        normal = _normals(mean)
        gradient[:] = 0.0
        for a in range(8):
            for i in range(3):
                for axis in range(3):
                    gradient[a, i] += _CORNER[a, axis] * normal[axis, i] / volume[e]
        pressure = k[e] * (np.dot(mean[0], normal[0]) / volume[e] - 1.0) / volume[e]
        if kind != EXACT:
            pressure = 0.0
        for axis in range(3):
            v = mean[axis]
            crossed[axis, 0, 0], crossed[axis, 0, 1], crossed[axis, 0, 2] = 0.0, -v[2], v[1]
            crossed[axis, 1, 0], crossed[axis, 1, 1], crossed[axis, 1, 2] = v[2], 0.0, -v[0]
            crossed[axis, 2, 0], crossed[axis, 2, 1], crossed[axis, 2, 2] = -v[1], v[0], 0.0
        for a in range(8):
            for b in range(8):
                at = 13 + _CODE[b] - _CODE[a]
                for i in range(3):
                    for j in range(3):
                        value = k[e] * gradient[a, i] * gradient[b, j]
                        if pressure != 0.0:
                            bent = 0.0
                            for axis in range(3):
                                one, two = (axis + 1) % 3, (axis + 2) % 3
                                weight = _CORNER[a, two] * _CORNER[b, one] - _CORNER[a, one] * _CORNER[b, two]
                                bent += weight * crossed[axis, i, j]
                            value += pressure * bent
                        blocks[corners[e, a], at, i, j] += value


@njit(cache=True)
def _direction(start: FloatArray, end: FloatArray) -> tuple[FloatArray, float]:
    d = end - start
    now = sqrt(d[0] ** 2 + d[1] ** 2 + d[2] ** 2)
    return (d / now if now > 0.0 else d), now


@njit(cache=True)
def _means(place: FloatArray, corners: IntArray) -> FloatArray:
    mean = np.zeros((3, 3))
    for a in range(8):
        for axis in range(3):
            for i in range(3):
                mean[axis, i] += _CORNER[a, axis] * place[corners[a], i]
    return mean


@njit(cache=True)
def _normals(mean: FloatArray) -> FloatArray:
    """Return the derivative of p . (q x r) by p, q and r."""
    normal = np.empty((3, 3))
    for axis in range(3):
        one, two = mean[(axis + 1) % 3], mean[(axis + 2) % 3]
        for i in range(3):
            j, k = (i + 1) % 3, (i + 2) % 3
            normal[axis, i] = one[j] * two[k] - one[k] * two[j]
    return normal
