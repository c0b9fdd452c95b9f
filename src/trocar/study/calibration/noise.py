"""How noisy a series is, and how many independent readings it is worth.

Residuals of a press are seldom independent: instruments filter, and what a model misses is smooth. A first-order
autoregression of correlation r leaves n (1 - r)/(1 + r) of n readings, and a fit's covariance grows by the inverse.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trocar.model import FloatArray
from trocar.study.statistics.uncertainty import effective_sample_size


@dataclass(frozen=True, kw_only=True)
class Noise:
    """Of one series.

    Attributes:
        name: of the series.
        rms: root mean square of the residual, what was fitted counted [m].
        white: the part of it that changes from row to row [m].
        given: what the user states, the force's share included [m]; None where nothing was stated.
        rows: how many.
        worth: independent ones among them.
        range: largest minus smallest reading [m].
    """

    name: str
    rms: float
    white: float
    given: float | None
    rows: int
    worth: float
    range: float

    @property
    def used(self) -> float:
        """Standard deviation that intervals are made with [m]: what was stated, or what was left where that is more."""
        return max(self.rms, self.given or 0.0)

    @property
    def inflation(self) -> float:
        """By how much a variance is larger than for independent readings [1]."""
        return self.rows / self.worth

    @property
    def excess(self) -> float:
        """Residual over the noise that was stated, or over what changes from row to row [1]."""
        known = self.given or self.white
        return self.rms / known if known > 0 else 1.0


def white_noise(values: FloatArray) -> float:
    """Return the standard deviation of what is independent from row to row, by second differences.

    Values minus the mean of their neighbours have 3/2 of white noise's variance, and nothing of a straight line.
    """
    bends = values[1:-1] - 0.5 * (values[2:] + values[:-2])
    return float(np.sqrt(np.mean(bends**2) / 1.5))


def assess(
    name: str, residual: FloatArray, *, fitted: float, given: float | None, spread: float, serial: bool
) -> Noise:
    """Assess the residual of a series.

    Args:
        name: of the series.
        residual: [m], shape (n,).
        fitted: how many numbers were fitted to it.
        given: noise stated [m].
        spread: range of the readings [m].
        serial: whether rows follow one another in time; markers' rows do not.
    """
    count = len(residual)
    free = max(count - fitted, 1.0)
    return Noise(
        name=name,
        rms=float(np.sqrt(residual @ residual / free)),
        white=white_noise(residual) if serial else 0.0,
        given=given,
        rows=count,
        worth=effective_sample_size(residual),
        range=spread,
    )
