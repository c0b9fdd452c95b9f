"""A hand's path from point to point, as smooth as people reach.

Between two points at rest the path is the straight one of least squared jerk (Flash and Hogan 1985, Journal of
Neuroscience 5:1688-1703),

    x = x0 + (x1 - x0) (10 s^3 - 15 s^4 + 6 s^5),   s = time/duration,

whose peak speed is 15/8 of its mean speed. Roll and jaw go along by the same law.
"""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass
from itertools import accumulate
from math import isfinite

from trocar.contact.instrument import Vector
from trocar.errors import InputError


@dataclass(frozen=True, kw_only=True, slots=True)
class Waypoint:
    """A point where the tip comes to rest.

    Args:
        after: time since the waypoint before [s].
        tip: position of the tip [m].
        roll: angle about the shaft [rad].
        jaw: opening, 0 closed to 1 open.
    """

    after: float
    tip: Vector
    roll: float = 0.0
    jaw: float = 1.0


class Path:
    """Waypoints joined by minimum-jerk segments; before the first and after the last the tip stays.

    Args:
        waypoints: in order; the first is where the path begins, whatever its `after`.

    Raises:
        InputError: there is no waypoint, or a segment takes no time.
    """

    def __init__(self, waypoints: tuple[Waypoint, ...]) -> None:
        if not waypoints:
            raise InputError("path", "at least one waypoint", waypoints)
        for place, waypoint in enumerate(waypoints[1:], start=1):
            if not (isfinite(waypoint.after) and waypoint.after > 0):
                raise InputError(f"path: waypoint {place}: after", "a time above 0 s", waypoint.after)
        self.waypoints = waypoints
        self._arrivals = list(accumulate((waypoint.after for waypoint in waypoints[1:]), initial=0.0))

    @property
    def duration(self) -> float:
        """Time from the first waypoint to the last [s]."""
        return self._arrivals[-1]

    def at(self, time: float) -> tuple[Vector, float, float]:
        """Return tip [m], roll [rad] and jaw at a time [s]."""
        place = bisect_right(self._arrivals, time)
        if place == 0 or place == len(self.waypoints):
            held = self.waypoints[max(place - 1, 0)]
            return held.tip, held.roll, held.jaw
        start, end = self.waypoints[place - 1], self.waypoints[place]
        share = _least_jerk((time - self._arrivals[place - 1]) / end.after)
        x, y, z = (between(a, b, share) for a, b in zip(start.tip, end.tip, strict=True))
        return (x, y, z), between(start.roll, end.roll, share), between(start.jaw, end.jaw, share)


def between(start: float, end: float, share: float) -> float:
    """Return a number that goes linearly from `start` to `end`, and by no rounding beyond either."""
    low, high = (start, end) if start <= end else (end, start)
    return min(max(start + (end - start) * share, low), high)


def _least_jerk(s: float) -> float:
    return s**3 * (10.0 - s * (15.0 - 6.0 * s))
