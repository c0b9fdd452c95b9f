"""Deflection and stretch in balance: w + C G(w) = w_free, with C the compliance of every wave.

The unknowns are scaled to s = w / sqrt(C), in which the equation's derivative is one plus a symmetric matrix that is
never negative while the sheet is under tension, and Anderson's mixing (D. G. Anderson 1965, J. ACM 12:547; H. F.
Walker and P. Ni 2011, SIAM J. Numer. Anal. 49:1715) takes about as many turns as conjugate gradients would.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.linalg import lstsq

from trocar.errors import SolverError
from trocar.model import FloatArray

TOLERANCE = 1e-13  # of the free deflection, in the norm of energy: rounding leaves 1e-15
_DEPTH = 20  # turns remembered
_MOST_TURNS = 300  # a capsule a thousand times stiffer than its organ takes 100, skin 10
_STALLED = 1e-11  # what rounding may leave of a deflection with many waves


def in_balance(
    compliance: FloatArray,
    free: FloatArray,
    resistance: Callable[[FloatArray], FloatArray],
    first: FloatArray,
) -> FloatArray:
    """Return the deflection w [m] with w = free - compliance * resistance(w).

    Args:
        compliance: of every wave, above 0 [m/N], shape (M, N).
        free: the deflection without resistance [m], shape (M, N).
        resistance: of every wave at a deflection [N].
        first: a guess [m].

    Raises:
        SolverError: the turns did not settle.
    """
    root = np.sqrt(compliance)
    wanted = (free / root).ravel()
    size = float(np.linalg.norm(wanted))
    if size == 0.0 and not first.any():
        return np.zeros_like(free)

    def imbalance(scaled: FloatArray) -> FloatArray:
        held = resistance(root * scaled.reshape(root.shape))
        return np.asarray(scaled - wanted + (root * held).ravel())

    now = (first / root).ravel()
    left = imbalance(now)
    size = max(size, float(np.linalg.norm(now)))
    changes: list[FloatArray] = []
    turns: list[FloatArray] = []
    best, kept = now, float(np.linalg.norm(left))
    damped = 1.0
    for _ in range(_MOST_TURNS):
        if kept <= TOLERANCE * size:
            break
        step = -damped * left
        if changes:
            table, moves = np.array(changes).T, np.array(turns).T
            share = lstsq(table, left, cond=1e-12, lapack_driver="gelsy", check_finite=False)[0]
            step = -damped * (left - table @ share) - moves @ share
        after = now + step
        found = imbalance(after)
        if not np.isfinite(found).all() or np.linalg.norm(found) > 10 * np.linalg.norm(left):
            damped, changes, turns = 0.5 * damped, [], []
            if damped < 1e-6:
                break
            now, left = best, imbalance(best)
            continue
        changes.append(found - left)
        turns.append(step)
        changes, turns = changes[-_DEPTH:], turns[-_DEPTH:]
        now, left = after, found
        norm = float(np.linalg.norm(left))
        if norm < kept:
            best, kept = now, norm
    if kept > _STALLED * size:
        raise SolverError(
            f"stretching sheet: expected an imbalance below {_STALLED:g} of the load, got {kept / size:.2g}; "
            "take a shorter step or less force"
        )
    return root * best.reshape(root.shape)
