"""What an attempt cut, and how near to its line."""

from __future__ import annotations

from math import nan

import numpy as np

from trocar.model import FloatArray
from trocar.simulation import CUT
from trocar.training.line import Snip
from trocar.training.metrics.attempt import Attempt


def snips(attempt: Attempt, *, idle: bool = False) -> list[Snip]:
    """Return what was cut, one snip after the other.

    Args:
        attempt: what was done.
        idle: whether snips count that cut no link which still held; between two links they are as good as others.
    """
    found: list[Snip] = []
    for hand in range(attempt.records.shape[1]):
        told = attempt.records[:, hand, CUT : CUT + 5]
        new = np.any(told != np.concatenate([np.zeros((1, 5)), told[:-1]]), axis=1)
        new &= np.any(told[:, 1:] != 0, axis=1) if idle else told[:, 0] > 0
        found += [((x0, y0), (x1, y1)) for _, x0, y0, x1, y1 in told[new].tolist()]
    return found


def cut_deviation(attempt: Attempt) -> float:
    """Return the mean distance of what was cut from the line [m]."""
    away = _distances(attempt)
    return float(away.mean()) if len(away) else nan


def cut_deviation_most(attempt: Attempt) -> float:
    """Return the largest distance of what was cut from the line [m]."""
    away = _distances(attempt)
    return float(away.max()) if len(away) else nan


def cut_share(attempt: Attempt) -> float:
    """Return the share of the line that a cut goes along, within its width [1]."""
    if attempt.line is None:
        return nan
    line, cut = attempt.line, snips(attempt, idle=True)
    passed = [any(line.passes(snip, number) for snip in cut) for number in range(len(line.points))]
    return float(np.mean(passed))


def _distances(attempt: Attempt) -> FloatArray:
    if attempt.line is None:
        return np.zeros(0)
    return np.concatenate([np.zeros(0), *(attempt.line.distances(snip) for snip in snips(attempt))])
