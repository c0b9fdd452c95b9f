"""How stress in a ball strains it, in an endless elastic body.

A stress tau strains the body by -Gamma tau. In terms of waves of direction n,

    Gamma(n)_ijkl = n_j n_l (delta_ik - n_i n_k/(2 (1 - nu)))/mu,   made symmetric,

whatever their length. The ball's orthonormal polynomials p = R(r) Y(n), of degree d, all have the transform
j_(d+1)(k)/k times Y (Zernike's in three dimensions: Janssen 2015, arXiv:1510.04837). So Gamma between two of them is
the mean of Y Gamma(n) Y' over directions where the degrees are equal, and zero elsewhere; of degree 0 it is Hill's
tensor (Willis 1981, Adv Appl Mech 21:1).
"""

from __future__ import annotations

from math import factorial, pi, sqrt

import numpy as np
from scipy.special import eval_jacobi, lpmv

from trocar.model import FloatArray
from trocar.tissues.layer import Layer

PAIRS = ((0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1))  # Mandel's order
MANDEL = np.array([1.0 if i == j else sqrt(2) for i, j in PAIRS])


def ball_points(heights: int, radii: int, turns: int) -> tuple[FloatArray, FloatArray]:
    """Return points in the unit ball, slice after slice, shape (q, 3), and their shares of its volume, shape (q,).

    Args:
        heights: Gauss points from pole to pole.
        radii: Gauss points from the axis out, in the squared radius.
        turns: points around.
    """
    z, of_z = np.polynomial.legendre.leggauss(heights)
    share, of_r = np.polynomial.legendre.leggauss(radii)
    around = 2 * pi * (np.arange(turns) + 0.5) / turns
    r = np.sqrt(0.5 * (1 + share)[:, None] * (1 - z**2)[:, None, None])
    points = np.stack(np.broadcast_arrays(r * np.cos(around), r * np.sin(around), z[:, None, None]), axis=-1)
    weights = np.broadcast_to((of_z * (1 - z**2))[:, None, None] * of_r[:, None], (*r.shape[:2], turns))
    return points.reshape(-1, 3), (weights / weights.sum()).ravel()


def ball_polynomials(points: FloatArray, degree: int) -> FloatArray:
    """Return polynomials up to a degree at points of the unit ball, of mean square 1, shape (q, 1, 4, 10 or more)."""
    r = np.linalg.norm(points, axis=1)
    n = points / r[:, None]
    found = [
        sqrt((2 * d + 3) / 3) * r**order * eval_jacobi((d - order) // 2, 0, order + 0.5, 2 * r**2 - 1) * one
        for d, order in _kinds(degree)
        for one in _harmonics(n, order)
    ]
    return np.stack(found, axis=1)


def ease_in_ball(body: Layer, degree: int) -> FloatArray:
    """Return Gamma between a ball's polynomials, times its volume [1/Pa], shape (polynomials, 6, polynomials, 6)."""
    n, weights = _directions(2 * degree + 4, 4 * degree + 8)
    green = (np.eye(3) - np.einsum("qi,qj->qij", n, n) / (2 * (1 - body.poisson_ratio))) / body.shear_modulus
    strain = np.zeros((len(n), 6, 3))  # of a displacement along each axis in a wave along n
    for row, (i, j) in enumerate(PAIRS):
        strain[:, row, i] += n[:, j] * MANDEL[row] / 2
        strain[:, row, j] += n[:, i] * MANDEL[row] / 2
    gamma = strain @ green @ strain.swapaxes(1, 2)
    kinds = [(d, one) for d, order in _kinds(degree) for one in _harmonics(n, order)]
    shapes, degrees = np.stack([one for _, one in kinds], axis=1), np.array([d for d, _ in kinds])
    found = np.einsum("q,qm,qn,qab->manb", weights, shapes, shapes, gamma, optimize=True)
    return np.asarray(found * (degrees[:, None] == degrees)[:, None, :, None])


def _kinds(degree: int) -> list[tuple[int, int]]:
    """Return degree and order of the harmonics of each family of polynomials."""
    return [(d, order) for d in range(degree + 1) for order in range(d % 2, d + 1, 2)]


def _directions(heights: int, turns: int) -> tuple[FloatArray, FloatArray]:
    """Return unit vectors, shape (q, 3), and weights that add up to 1, shape (q,)."""
    c, weights = np.polynomial.legendre.leggauss(heights)
    around = 2 * pi * (np.arange(turns) + 0.5) / turns
    c, around = np.repeat(c, turns), np.tile(around, heights)
    s = np.sqrt(1 - c**2)
    return np.stack([s * np.cos(around), s * np.sin(around), c], axis=1), np.repeat(weights, turns) / (
        2 * turns
    )


def _harmonics(n: FloatArray, order: int) -> list[FloatArray]:
    """Return the real spherical harmonics of an order, each of mean square 1, at unit vectors of shape (q, 3)."""
    around = np.arctan2(n[:, 1], n[:, 0])
    found = []
    for m in range(-order, order + 1):
        size = sqrt((2 * order + 1) * factorial(order - abs(m)) / factorial(order + abs(m)))
        turn = sqrt(2) * np.cos(m * around) if m > 0 else sqrt(2) * np.sin(m * around) if m < 0 else 1.0
        found.append(size * lpmv(abs(m), order, n[:, 2]) * turn)
    return found
