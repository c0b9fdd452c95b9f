"""How practice goes: proficiency after passes in a row, and CUSUM charts that tell skill from luck.

With the failure rate p0 that is acceptable and p1 that is not, a failure speaks for p1 by ln(p1/p0), a success against
it by ln((1 - p0)/(1 - p1)). In units in which both together are one,

    s = Q/(P + Q),   P = ln(p1/p0),   Q = ln((1 - p0)/(1 - p1)),
    a success takes s off, a failure adds 1 - s,

and the chart crosses h1 = ln((1 - beta)/alpha)/(P + Q) above its lowest point when p1 is believed, or falls by
h0 = ln((1 - alpha)/beta)/(P + Q) below its highest when p0 is (Bolsin and Colson 2000, Int J Qual Health Care 12:433).
In units of the log likelihood ratio, and never below zero, it is Page's chart, which only waits for the alarm
(Page 1954, Biometrika 41:100; de Leval et al. 1994, J Thorac Cardiovasc Surg 107:914).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import log

import numpy as np

from trocar.errors import InputError
from trocar.model import FloatArray

_ROUNDING = 1e-9  # two failures are an alarm by the numbers, 2 ln 3 = ln 9, and must be one by their sum


@dataclass(frozen=True, kw_only=True)
class Cusum:
    """What a chart is drawn for.

    Attributes:
        acceptable: failure rate p0.
        unacceptable: failure rate p1, above p0.
        alpha: chance of an alarm that is none.
        beta: chance of missing one.
    """

    acceptable: float = 0.05
    unacceptable: float = 0.15
    alpha: float = 0.1
    beta: float = 0.1

    def __post_init__(self) -> None:
        if not 0 < self.acceptable < self.unacceptable < 1:
            raise InputError(
                "cusum", "0 < acceptable < unacceptable < 1", (self.acceptable, self.unacceptable)
            )
        for name in ("alpha", "beta"):
            if not 0 < getattr(self, name) < 0.5:
                raise InputError(f"cusum: {name}", "between 0 and 0.5", getattr(self, name))

    @property
    def failure(self) -> float:
        """P: what a failure adds, in units of the log likelihood ratio."""
        return log(self.unacceptable / self.acceptable)

    @property
    def success(self) -> float:
        """Q: what a success takes off, in the same units."""
        return log((1 - self.acceptable) / (1 - self.unacceptable))

    @property
    def step(self) -> float:
        """s: what a success takes off the chart."""
        return self.success / (self.failure + self.success)

    @property
    def alarm(self) -> float:
        """h1: a rise by so much says that p1 is true."""
        return log((1 - self.beta) / self.alpha) / (self.failure + self.success)

    @property
    def proof(self) -> float:
        """h0: a fall by so much says that p0 is true."""
        return log((1 - self.alpha) / self.beta) / (self.failure + self.success)

    def chart(self, failed: Sequence[bool]) -> FloatArray:
        """Return the chart after each attempt, from zero, shape (n,)."""
        return np.cumsum(np.where(np.asarray(failed, dtype=bool), 1 - self.step, -self.step))

    def alarm_after(self, failed: Sequence[bool]) -> int | None:
        """Return how many attempts it took until the chart had risen by h1 above its lowest point, or None."""
        heights = np.concatenate(([0.0], self.chart(failed)))
        return _first(heights - np.minimum.accumulate(heights), self.alarm)

    def proof_after(self, failed: Sequence[bool]) -> int | None:
        """Return how many attempts it took until the chart had fallen by h0 below its highest point, or None."""
        heights = np.concatenate(([0.0], self.chart(failed)))
        return _first(np.maximum.accumulate(heights) - heights, self.proof)

    def page_chart(self, failed: Sequence[bool]) -> FloatArray:
        """Return Page's chart after each attempt, in units of the log likelihood ratio, shape (n,)."""
        heights = np.zeros(len(failed))
        height = 0.0
        for number, one in enumerate(failed):
            height = max(0.0, height + (self.failure if one else -self.success))
            heights[number] = height
        return heights


def _first(distances: FloatArray, limit: float) -> int | None:
    """Return where a distance first reaches a limit, or None; the first of them is before any attempt."""
    reached = np.flatnonzero(distances >= limit - _ROUNDING)
    return int(reached[0]) if len(reached) else None


def proficient(passed: Sequence[bool], *, in_a_row: int = 2, besides: int = 0) -> int | None:
    """Return the number of attempts after which a trainee was proficient, or None.

    Args:
        passed: each attempt, in order.
        in_a_row: passes one after the other that are asked for.
        besides: further passes, in any order (FLS asks for ten in two of its tasks).
    """
    run, total, reached = 0, 0, False
    for number, one in enumerate(passed, 1):
        run = run + 1 if one else 0
        total += bool(one)
        reached = reached or run >= in_a_row
        if reached and total >= in_a_row + besides:
            return number
    return None
