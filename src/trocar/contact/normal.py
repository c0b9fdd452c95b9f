"""Unilateral contact of pads on a surface that gives way: a linear complementarity problem, solved to rounding.

Pads press with forces p, the surface below them sinks by W p more than it would by itself, and the tool lies b below
where the surface would be:

    g = W p - b,   p >= 0,   g >= 0,   p g = 0    for every pad; a pad that holds the tissue may pull: g = 0.

W is symmetric and positive definite, so there is one answer. It is found by exchanging whole sets of pads between
pressing and apart, and one pad at a time, the last that is wrong, whenever that stops helping, which ends after
finitely many exchanges (Judice and Pires 1994, Comput Oper Res 21:587; Kim and Park 2011, SIAM J Sci Comput 33:3261).
From one tick to the next few pads change, so the last answer's set is where it starts.
"""

from __future__ import annotations

from math import sqrt

import numpy as np
import numpy.typing as npt
from numba import njit

from trocar.model import FloatArray

IntArray = npt.NDArray[np.int64]
BoolArray = npt.NDArray[np.bool_]

_PATIENCE = 3  # exchanges of whole sets without fewer wrong pads, before single ones
_MOST = 20  # exchanges to a pad at most; seen: 1 to 4 in all


@njit(cache=True)
def press(
    compliance: FloatArray,
    below: FloatArray,
    holding: BoolArray,
    touching: BoolArray,
    forces: FloatArray,
    factor: FloatArray,
    order: IntArray,
) -> bool:  # pragma: no cover - compiled
    """Solve for the pads' forces; nothing is allocated.

    Args:
        compliance: W [m/N], shape (n, n).
        below: b, how far each pad lies below the surface as it would be without these forces [m], shape (n,).
        holding: which pads hold the tissue and may pull, shape (n,).
        touching: which pads press; where to start from, and overwritten, shape (n,).
        forces: overwritten with p [N], shape (n,).
        factor: scratch, shape (n, n).
        order: scratch, shape (n,).

    Returns:
        Whether an answer was found; if not, W was not positive definite or a number not finite, and p is zero.
    """
    pads = len(below)
    scale = 0.0
    for i in range(pads):
        if not np.isfinite(below[i]):
            forces[:] = 0.0
            touching[:] = False
            return False
        scale = max(scale, abs(below[i]))
    gap_slack = 1e-12 * scale  # rounding of the triangular solves, far below a molecule
    fewest, patience = pads + 1, _PATIENCE
    for _ in range(_MOST * pads + 1):
        if not _forces_of(compliance, below, holding, touching, forces, factor, order):
            forces[:] = 0.0
            touching[:] = False
            return False
        wrong, last = 0, -1
        for i in range(pads):  # order is free again: it keeps which pads to exchange
            order[i] = _is_wrong(compliance, below, holding, touching, forces, i, gap_slack)
            if order[i]:
                wrong, last = wrong + 1, i
        if wrong == 0:
            return True
        if wrong < fewest:
            fewest, patience = wrong, _PATIENCE
        else:
            patience -= 1
        if patience >= 0:
            for i in range(pads):
                if order[i]:
                    touching[i] = not touching[i]
        else:
            touching[last] = not touching[last]
    forces[:] = 0.0
    touching[:] = False
    return False


@njit(cache=True)
def _is_wrong(
    compliance: FloatArray,
    below: FloatArray,
    holding: BoolArray,
    touching: BoolArray,
    forces: FloatArray,
    pad: int,
    slack: float,
) -> bool:  # pragma: no cover - compiled
    if holding[pad]:
        return False
    if touching[pad]:
        return bool(forces[pad] < 0.0)
    return bool(_dot(compliance[pad], forces, len(below)) - below[pad] < -slack)


@njit(cache=True)
def _dot(a: FloatArray, b: FloatArray, count: int) -> float:  # pragma: no cover - compiled
    """Return a.b of the first numbers; four sums at once hide the latency of one."""
    s0 = s1 = s2 = s3 = 0.0
    whole = count - count % 4
    for k in range(0, whole, 4):
        s0 += a[k] * b[k]
        s1 += a[k + 1] * b[k + 1]
        s2 += a[k + 2] * b[k + 2]
        s3 += a[k + 3] * b[k + 3]
    for k in range(whole, count):
        s0 += a[k] * b[k]
    return (s0 + s1) + (s2 + s3)


@njit(cache=True)
def _forces_of(
    compliance: FloatArray,
    below: FloatArray,
    holding: BoolArray,
    touching: BoolArray,
    forces: FloatArray,
    factor: FloatArray,
    order: IntArray,
) -> bool:  # pragma: no cover - compiled
    """Solve g = 0 for the pads that touch or hold, p = 0 for the others, by Cholesky.

    W = U^T U, row by row of U: each takes its share off all that is left below, along rows, which fills vector
    registers without reordering a sum. U lies above the diagonal of `factor`, what is left of W below it.
    """
    count = 0
    for i in range(len(below)):
        forces[i] = 0.0
        if touching[i] or holding[i]:
            order[count] = i
            count += 1
    for r in range(count):
        row, given = factor[r], compliance[order[r]]
        for c in range(r + 1):
            row[c] = given[order[c]]
        forces[order[r]] = below[order[r]]
    for k in range(count):
        done = factor[k]
        if not done[k] > 0.0:
            return False
        done[k] = sqrt(done[k])
        share = 1.0 / done[k]
        solved = forces[order[k]] * share
        forces[order[k]] = solved
        for r in range(k + 1, count):
            done[r] = factor[r, k] * share
        for r in range(k + 1, count):
            row, times = factor[r], done[r]
            for c in range(k + 1, r + 1):
                row[c] -= times * done[c]
            forces[order[r]] -= times * solved
    for r in range(count - 1, -1, -1):
        row, total = factor[r], forces[order[r]]
        for k in range(r + 1, count):
            total -= row[k] * forces[order[k]]
        forces[order[r]] = total / row[r]
    return True
