"""What was recorded of an attempt, replayed: where both instruments were and what they felt, tick by tick."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from math import inf, nan

import numpy as np

from trocar.contact.instrument import NAMES
from trocar.errors import InputError
from trocar.model import FloatArray
from trocar.simulation import (
    DIRECTION,
    FORCE,
    OUTSIDE,
    RECORD,
    RECORD_ROLL,
    TIP,
    TOUCH,
    TOUCH_PRESENT,
    TOUCH_TOUCHING,
)
from trocar.training.line import Line
from trocar.training.metrics.motion import SHORTEST, SmoothPath, smooth_path

USED = 5e-3  # [m] an instrument whose tip stayed within less was not used: a hand at rest trembles


@dataclass(frozen=True, kw_only=True)
class Attempt:
    """Both instruments over time.

    Attributes:
        times: of the ticks, the tissue's [s], shape (n,).
        records: as `simulation.advance` writes them, shape (n, 2, RECORD).
        force_limit: the force a task asks to stay below [N].
        ideal_length: of the shortest way that does the task, both tips together [m]; nan where there is none.
        errors: mistakes that the task's steps saw; nan where nobody looked.
        strength: tensile strength of the weakest layer that states one [Pa]; nan where none does.
        line: that was to be cut along, if one was.
        sections: areas of both tips' largest plane sections [m^2], shape (2,).
    """

    times: FloatArray
    records: FloatArray
    force_limit: float = inf
    ideal_length: float = nan
    errors: float = nan
    strength: float = nan
    line: Line | None = None
    sections: FloatArray = field(default_factory=lambda: np.full(len(NAMES), nan))

    def __post_init__(self) -> None:
        wanted = (len(self.times), len(NAMES), RECORD)
        if self.records.shape != wanted:
            raise InputError("attempt: records", f"shape {wanted}", self.records.shape)
        if not self.present.any():
            raise InputError("attempt", "an instrument in a hand at some time", "none")

    @cached_property
    def present(self) -> np.ndarray:
        """Whether each instrument is in the hand, shape (n, 2)."""
        return np.asarray((self.records[:, :, TOUCH].astype(np.int64) & TOUCH_PRESENT) != 0)

    @cached_property
    def tips(self) -> dict[str, SmoothPath]:
        """Tips of the instruments that were used [m]."""
        found = {}
        for hand, name in enumerate(NAMES):
            here = self.times[self.present[:, hand]]
            if len(here) > 1 and here[-1] - here[0] >= SHORTEST:
                tip = self._of(hand, slice(TIP, TIP + 3))
                if np.ptp(tip.places, axis=0).max() > USED:
                    found[name] = tip
        return found

    def of_used(self, columns: slice) -> dict[str, SmoothPath]:
        """Return columns of the records, filtered, of the instruments that were used."""
        return {name: self._of(NAMES.index(name), columns) for name in self.tips}

    @property
    def forces(self) -> FloatArray:
        """Absolute force on each tip [N], shape (n, 2)."""
        return np.asarray(np.linalg.norm(self.records[:, :, FORCE : FORCE + 3], axis=2), dtype=np.float64)

    @property
    def touching(self) -> np.ndarray:
        """Whether each tip touches the tissue, shape (n, 2)."""
        return np.asarray((self.records[:, :, TOUCH].astype(np.int64) & TOUCH_TOUCHING) != 0)

    @property
    def duration(self) -> float:
        """From the first tick to the last [s]."""
        return float(self.times[-1] - self.times[0])

    def _of(self, hand: int, columns: slice) -> SmoothPath:
        here = self.present[:, hand]
        return smooth_path(self.times[here], self.records[here, hand, columns])


SHAFT = slice(DIRECTION, DIRECTION + 3)
ROLL = slice(RECORD_ROLL, RECORD_ROLL + 1)
WITHDRAWN = slice(OUTSIDE, OUTSIDE + 1)
