"""The servo's trail: the poses that each tick consumed, which ticks were skipped, and what came of them.

Writing a row costs the servo a tenth of a microsecond and it waits for nobody; who reads too late has lost rows, and
is told how many.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from numba import njit

from trocar.model import FloatArray
from trocar.realtime.clock import fence
from trocar.realtime.shared import (
    BEGAN,
    FOLLOWED,
    MISSED_BEFORE,
    RECORDS,
    TARGETS,
    TRAIL,
    TRAIL_TICKS,
    Trail,
)
from trocar.realtime.tracking import TrackState
from trocar.simulation import POSE, RECORD

_MARGIN = 64  # ticks the servo may go on while a row is being copied


@dataclass(frozen=True, kw_only=True)
class Ticks:
    """Ticks one after the other.

    Attributes:
        first: number of the first, from 0 at the servo's start.
        lost: ticks before it that were asked for and are gone.
        began: whether a tick began from rest, with both instruments where their poses said, shape (n,).
        missed: ticks missed before each since the servo's start, shape (n,).
        targets: newest good poses, shape (n, 2, POSE).
        poses: as they were followed, shape (n, 2, POSE).
        records: what `simulation.advance` wrote; zero where something was not finite; shape (n, 2, RECORD).
    """

    first: int
    lost: int
    began: npt.NDArray[np.bool_]
    missed: npt.NDArray[np.int64]
    targets: FloatArray
    poses: FloatArray
    records: FloatArray

    def __len__(self) -> int:
        return len(self.began)


@njit(cache=True, nogil=True)
def leave(
    trail: Trail, begins: bool, missed: int, track: TrackState, records: FloatArray
) -> None:  # pragma: no cover - compiled
    """Write the next row; who reads sees it whole or not at all."""
    row = trail.rows[trail.written[0] % TRAIL_TICKS]
    row[BEGAN] = 1.0 if begins else 0.0
    row[MISSED_BEFORE] = missed
    for hand in range(2):
        for k in range(POSE):
            row[TARGETS + hand * POSE + k] = track.target[hand, k]
            row[FOLLOWED + hand * POSE + k] = track.pose[hand, k]
        for k in range(RECORD):
            row[RECORDS + hand * RECORD + k] = records[hand, k]
    fence()
    trail.written[0] += 1


def read_trail(trail: Trail, first: int) -> Ticks:
    """Copy the ticks there are from a number on; at once, whatever the servo does.

    Args:
        trail: shared with the servo.
        first: number of the first that is wanted, from 0.
    """
    end = int(trail.written[0])
    begin = min(max(first, end - TRAIL_TICKS + _MARGIN, 0), end)
    rows = np.empty((end - begin, TRAIL))
    _copy(trail, begin, rows)
    # The row that is being written now is number `written`, over number `written` - TRAIL_TICKS.
    whole = min(max(begin, int(trail.written[0]) - TRAIL_TICKS + 1), end)
    found = rows[whole - begin :]
    count = len(found)
    return Ticks(
        first=whole,
        lost=max(whole - first, 0),
        began=found[:, BEGAN] != 0.0,
        missed=found[:, MISSED_BEFORE].astype(np.int64),
        targets=found[:, TARGETS:FOLLOWED].reshape(count, 2, POSE),
        poses=found[:, FOLLOWED:RECORDS].reshape(count, 2, POSE),
        records=found[:, RECORDS:].reshape(count, 2, RECORD),
    )


@njit(cache=True, nogil=True)
def _copy(trail: Trail, begin: int, rows: FloatArray) -> None:  # pragma: no cover - compiled
    fence()
    for number in range(len(rows)):
        row = trail.rows[(begin + number) % TRAIL_TICKS]
        for k in range(TRAIL):
            rows[number, k] = row[k]
    fence()
