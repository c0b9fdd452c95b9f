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
    wrong: BoolArray,
) -> bool:  # pragma: no cover - compiled
    """Solve for the pads' forces; nothing is allocated.

    Args:
        compliance: W [m/N], shape (n, n).
        below: b, how far each pad lies below the surface as it would be without these forces [m], shape (n,).
        holding: which pads hold the tissue and may pull, shape (n,).
        touching: which pads press; where to start from, and overwritten, shape (n,).
        forces: overwritten with p [N], shape (n,).
        factor: of W among the pads that press or hold; overwritten, shape (n, n).
        order: which pads the factor is of, and how many as the last number; overwritten, shape (n + 1,). While the
            same pads press the factor is used again: the last number must be 0 whenever W is another.
        wrong: scratch, shape (n,).

    Returns:
        Whether an answer was found; if not, W was not positive definite or a number not finite, and p is zero.
    """
    pads = len(below)
    scale = 0.0
    for i in range(pads):
        if not np.isfinite(below[i]):
            return _gave_up(touching, forces, order)
        scale = max(scale, abs(below[i]))
    gap_slack = 1e-12 * scale  # rounding of the triangular solves, far below a molecule
    fewest, patience = pads + 1, _PATIENCE
    for _ in range(_MOST * pads + 1):
        if not _forces_of(compliance, below, holding, touching, forces, factor, order):
            return _gave_up(touching, forces, order)
        count, last = 0, -1
        for i in range(pads):
            wrong[i] = _is_wrong(compliance, below, holding, touching, forces, i, gap_slack)
            if wrong[i]:
                count, last = count + 1, i
        if count == 0:
            return True
        if count < fewest:
            fewest, patience = count, _PATIENCE
        else:
            patience -= 1
        for i in range(pads):
            if wrong[i] and (patience >= 0 or i == last):
                touching[i] = not touching[i]
    return _gave_up(touching, forces, order)


@njit(cache=True)
def _gave_up(touching: BoolArray, forces: FloatArray, order: IntArray) -> bool:  # pragma: no cover - compiled
    forces[:] = 0.0
    touching[:] = False
    order[-1] = 0
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
    """Solve g = 0 for the pads that touch or hold, p = 0 for the others, by Cholesky."""
    count, known = 0, True
    for i in range(len(below)):
        forces[i] = 0.0
        if touching[i] or holding[i]:
            known = known and count < order[-1] and order[count] == i
            order[count] = i
            count += 1
    known = known and count == order[-1]
    order[-1] = count
    if not known and not _factored(compliance, factor, order, count):
        return False
    for r in range(count):
        forces[order[r]] = below[order[r]]
    for r in range(count):
        row = factor[r]
        forces[order[r]] /= row[r]
        done = forces[order[r]]
        for k in range(r + 1, count):
            forces[order[k]] -= row[k] * done
    for r in range(count - 1, -1, -1):
        total = forces[order[r]]
        row = factor[r]
        for k in range(count - 1, r, -1):
            total -= row[k] * forces[order[k]]
        forces[order[r]] = total / row[r]
    return True


@njit(cache=True)
def _factored(
    compliance: FloatArray, factor: FloatArray, order: IntArray, count: int
) -> bool:  # pragma: no cover - compiled
    """Write Cholesky's factor U, W = U^T U, of the first pads of an order; False where W is not positive definite.

    Row after row, less four rows above at once: neighbours in memory, so that a processor takes several together.
    """
    for r in range(count):
        row, pads = factor[r, r:count], compliance[order[r]]
        size = len(row)
        for c in range(size):
            row[c] = pads[order[r + c]]
        whole = r - r % 4
        for k in range(0, whole, 4):
            a, b = factor[k, r:count], factor[k + 1, r:count]
            d, e = factor[k + 2, r:count], factor[k + 3, r:count]
            of_a, of_b, of_d, of_e = a[0], b[0], d[0], e[0]
            for c in range(size):
                row[c] -= (of_a * a[c] + of_b * b[c]) + (of_d * d[c] + of_e * e[c])
        for k in range(whole, r):
            above = factor[k, r:count]
            share = above[0]
            for c in range(size):
                row[c] -= share * above[c]
        if not row[0] > 0.0:
            return False
        row[0] = sqrt(row[0])
        finer = 1.0 / row[0]
        for c in range(1, size):
            row[c] *= finer
    return True
