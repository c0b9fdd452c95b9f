"""A line to be cut along, and how near to it a cut went.

A cut is told as the scene tells it (`simulation.sheet_step`): one straight snip after the other, each from end to end
in places at rest.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import dist, hypot

import numpy as np

from trocar.model import FloatArray

_FINEST = 1e-4  # [m] between places of a snip that are looked at

Place = tuple[float, float]
Snip = tuple[Place, Place]


@dataclass(frozen=True, kw_only=True)
class Line:
    """A line of points.

    Attributes:
        points: x, y one after the other [m].
        width: how far to either side of it a cut may go [m].
    """

    points: tuple[Place, ...]
    width: float

    def passes(self, snip: Snip, number: int) -> bool:
        """Return whether a snip goes by a point, near enough, and half of the way to the points before and after.

        So snips that go by neighbouring points leave nothing between them.
        """
        (x0, y0), (x1, y1) = snip
        x, y = self.points[number]
        length = hypot(x1 - x0, y1 - y0)
        if length == 0.0:
            return False
        foot = ((x - x0) * (x1 - x0) + (y - y0) * (y1 - y0)) / length
        beside = ((x - x0) * (y1 - y0) - (y - y0) * (x1 - x0)) / length
        half = 0.5 * dist(self.points[max(number - 1, 0)], self.points[max(number, 1)])
        return half <= foot <= length - half and abs(beside) <= self.width

    def farthest(self, snip: Snip) -> float:
        """Return how far from the line a snip goes [m]."""
        return _farthest(self, snip)

    def distances(self, snip: Snip) -> FloatArray:
        """Return how far places of a snip, a tenth of a millimetre apart, are from the line [m], shape (n,)."""
        begin, end = np.array(snip)
        count = int(np.hypot(*(end - begin)) / _FINEST) + 2
        places = begin + np.linspace(0.0, 1.0, count)[:, None] * (end - begin)
        points = np.array(self.points)
        starts, ways = points[:-1], np.diff(points, axis=0)
        away = places[:, None] - starts
        share = np.clip((away * ways).sum(axis=2) / (ways**2).sum(axis=1), 0.0, 1.0)
        nearest: FloatArray = np.hypot(*np.moveaxis(away - share[..., None] * ways, 2, 0)).min(axis=1)
        return nearest


@lru_cache(maxsize=64)
def _farthest(line: Line, snip: Snip) -> float:
    return float(line.distances(snip).max())  # asked for in every tick in which the same snip is told
