"""The compiled step of every wave model: no allocation, no fast-math, one thread: runs repeat bit by bit."""

from __future__ import annotations

from numba import njit

from trocar.model import FloatArray

# Flushing what is smaller keeps every product of two numbers that are not zero above the smallest normal
# double, 2.2e-308. Below it processors slow down, and a released tissue would get there: e^-345 after eleven
# seconds at 30/s.
TINY = 1e-150


@njit(cache=True)
def turned(
    across: float, along: float, x: float, y: float, push: float
) -> float:  # pragma: no cover - compiled
    """Return one component of exp(A dt) x plus what the force adds, zero where it is below `TINY`."""
    moved = across * x + along * y + push
    return moved if abs(moved) > TINY else 0.0


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
            push_x = 0.0
            push_y = 0.0
            for a in range(inputs):
                push_x += start_gain[j, i, 0, a] * force0[j, a] + end_gain[j, i, 0, a] * force1[j, a]
                push_y += start_gain[j, i, 1, a] * force0[j, a] + end_gain[j, i, 1, a] * force1[j, a]
            x = state[j, i, 0]
            y = state[j, i, 1]
            state[j, i, 0] = turned(transition[j, i, 0, 0], transition[j, i, 0, 1], x, y, push_x)
            state[j, i, 1] = turned(transition[j, i, 1, 0], transition[j, i, 1, 1], x, y, push_y)
