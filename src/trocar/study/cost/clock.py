"""CPU time of a piece of work, and what the machine could do at best: an empty loop and a triad over memory.

CPU time of this process, not wall time, so that other programs' share of the processor is not counted; what
they do to caches and clock still is. So every figure is a median of several repeats, and only figures of one
run are compared.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from statistics import median
from time import process_time_ns

import numpy as np
from numba import njit

from trocar.model import FloatArray

_REPEATS = 9
_SHORTEST = 2e-3  # [s] of one repeat: a thousand times what the clock itself costs


@dataclass(frozen=True, kw_only=True)
class Timing:
    """CPU time of one execution.

    Attributes:
        median, least: over the repeats [s].
        repeats: how many.
    """

    median: float
    least: float
    repeats: int


def cpu_time(work: Callable[[], object], *, executions: int = 1, repeats: int = _REPEATS) -> Timing:
    """Time a call that does something `executions` times, after one call that does not count.

    Args:
        work: what to call.
        executions: how many of the thing timed a call does.
        repeats: how many calls are timed; a call too short for the clock is repeated within a repeat.
    """
    work()
    began = process_time_ns()
    work()
    once = 1e-9 * (process_time_ns() - began)
    calls = max(1, int(np.ceil(_SHORTEST / max(once, 1e-7))))
    taken = []
    for _ in range(repeats):
        began = process_time_ns()
        for _ in range(calls):
            work()
        taken.append(1e-9 * (process_time_ns() - began) / (calls * executions))
    return Timing(median=median(taken), least=min(taken), repeats=repeats)


def empty_loop(passes: int = 1000) -> Timing:
    """Time one pass of a compiled loop that does next to nothing."""
    cell = np.zeros(1)
    return cpu_time(lambda: _count(cell, passes), executions=passes)


def triad_bandwidth(size: int) -> float:
    """Return the bandwidth [byte/s] of a = b + s c over three arrays that take `size` bytes together.

    The best of the repeats, one core: what a step of that size could not beat (McCalpin 1995, the STREAM
    benchmark).
    """
    a, b, c = (np.ones(max(size // 24, 1)) for _ in range(3))
    passes = max(1, 2_000_000 // max(size, 1))
    best = cpu_time(lambda: _triad(a, b, c, passes), executions=passes).least
    return 24 * len(a) / best


@njit(cache=True)
def _count(cell: FloatArray, passes: int) -> None:  # pragma: no cover - compiled
    for _ in range(passes):
        cell[0] = 0.5 * cell[0] + 1.0


@njit(cache=True)
def _triad(a: FloatArray, b: FloatArray, c: FloatArray, passes: int) -> None:  # pragma: no cover - compiled
    for turn in range(passes):
        scale = 0.5 + turn
        for i in range(len(a)):
            a[i] = b[i] + scale * c[i]
