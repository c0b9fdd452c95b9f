"""One tick as a task sees it: where both instruments are and what they feel, and nothing of who moves them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trocar.model import FloatArray
from trocar.simulation import CUT, DEPTH, FORCE, OPENED, RECORD_JAW, TIP, TOUCH, TOUCH_HOLDING, TOUCH_TOUCHING

STRAYED = 1e-3  # [m] below the rest surface; no dent that a tip has just left is so deep


@dataclass(frozen=True, slots=True)
class Moment:
    """A tick.

    Attributes:
        time: the tissue's, since the attempt began [s].
        records: of both instruments, as `simulation.advance` writes them, shape (2, RECORD).
    """

    time: float
    records: FloatArray

    def tip(self, hand: int) -> FloatArray:
        """Return a tip's place [m], shape (3,)."""
        return self.records[hand, TIP : TIP + 3]

    def force(self, hand: int) -> float:
        """Return the force on a tip [N]."""
        return float(np.sqrt((self.records[hand, FORCE : FORCE + 3] ** 2).sum()))

    def touches(self, hand: int) -> bool:
        """Return whether a tip touches the tissue."""
        return bool(int(self.records[hand, TOUCH]) & TOUCH_TOUCHING)

    def jaw(self, hand: int) -> float:
        """Return how far a jaw is open, 0 to 1."""
        return float(self.records[hand, RECORD_JAW])

    def depth(self, hand: int) -> float:
        """Return how deep a tip's lowest point lies below the surface at rest [m], 0 above it."""
        return float(self.records[hand, DEPTH])

    def strayed(self, hand: int) -> bool:
        """Return whether a tip is in the tissue without touching it: it was in there before the tissue was."""
        return self.depth(hand) > STRAYED and not self.touches(hand) and not self.holds(hand)

    def holds(self, hand: int) -> bool:
        """Return whether a jaw holds the tissue."""
        return bool(int(self.records[hand, TOUCH]) & TOUCH_HOLDING)

    def snip(self, hand: int) -> tuple[tuple[float, float], tuple[float, float]] | None:
        """Return both ends, at rest, of what blades cut last, for a while after it [m]; None of what cut nothing."""
        x0, y0, x1, y1 = self.records[hand, CUT + 1 : CUT + 5].tolist()
        return ((x0, y0), (x1, y1)) if x0 or y0 or x1 or y1 else None

    def opened(self, hand: int) -> bool:
        """Return whether blades have been wide open since they last closed."""
        return bool(self.records[hand, OPENED])

    def away(self, hand: int, place: tuple[float, float]) -> float:
        """Return how far a tip is from a place, seen from above [m]."""
        x, y, _ = self.tip(hand)
        return float(np.hypot(x - place[0], y - place[1]))
