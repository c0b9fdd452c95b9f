"""The compiled loop every wave model is stepped by: no allocation, no fast-math, one thread, so runs repeat bit by bit."""

from __future__ import annotations

from numba import njit

from trocar.model import FloatArray


@njit(cache=True)
def advance(
    transition: FloatArray,
    start_gain: FloatArray,
    end_gain: FloatArray,
    state: FloatArray,
    force0: FloatArray,
    force1: FloatArray,
) -> None:  # pragma: no cover - compiled
    """Advance J groups of r blocks by one exact step, in place.

    Args:
        transition: shape (J, r, 2, 2).
        start_gain: shape (J, r, 2, n).
        end_gain: shape (J, r, 2, n).
        state: shape (J, r, 2); overwritten.
        force0: modal inputs at the start of the step, shape (J, n).
        force1: at its end, shape (J, n).
    """
    groups, order, _ = state.shape
    inputs = force0.shape[1]
    for j in range(groups):
        for i in range(order):
            x = state[j, i, 0]
            y = state[j, i, 1]
            p = transition[j, i, 0, 0] * x + transition[j, i, 0, 1] * y
            q = transition[j, i, 1, 0] * x + transition[j, i, 1, 1] * y
            for a in range(inputs):
                p += start_gain[j, i, 0, a] * force0[j, a] + end_gain[j, i, 0, a] * force1[j, a]
                q += start_gain[j, i, 1, a] * force0[j, a] + end_gain[j, i, 1, a] * force1[j, a]
            state[j, i, 0] = p
            state[j, i, 1] = q
