"""How long ticks take and how late they begin, while they run: histograms over logarithmic bins, no allocation.

A bin is a sixteenth of an octave wide, so a percentile is right within 2.2 %. Two windows of a second take turns;
what is reported covers the last second or two. Rates come from eighths of a second: the last eight whole ones.
"""

from __future__ import annotations

from math import exp2, log2
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from numba import njit

from trocar.model import FloatArray
from trocar.realtime.clock import SECOND

IntArray = npt.NDArray[np.int64]

PER_OCTAVE = 16
SHORTEST = 100.0  # [ns] what is shorter falls into the first bin
BINS = 22 * PER_OCTAVE  # up to 0.42 s; what is longer falls into the last
SLOTS = 8
SLOT = SECOND // SLOTS  # [ns]
DURATION, LATENESS = 0, 1  # of a tick: from waking to published; from due to awake
_DONE, _SKIPPED = 0, 1


class Pace(NamedTuple):
    """What the loop knows of its own pace.

    Attributes:
        windows: counts of the current second and the one before, of both kinds, shape (2, 2, BINS).
        totals: counts since the start, shape (2, BINS); DURATION, LATENESS.
        slots: ticks done and ticks missed in each eighth of a second, a ring, shape (SLOTS + 1, 2).
        place: current window; current slot's number since the clock's zero; slots begun since the first, up to
            SLOTS + 1; shape (3,).
    """

    windows: IntArray
    totals: IntArray
    slots: IntArray
    place: IntArray


def unpaced(totals: IntArray | None = None) -> Pace:
    """Return a pace of nothing yet; `totals` is where counts since the start are kept, if somewhere else."""
    return Pace(
        windows=np.zeros((2, 2, BINS), np.int64),
        totals=np.zeros((2, BINS), np.int64) if totals is None else totals,
        slots=np.zeros((SLOTS + 1, 2), np.int64),
        place=np.zeros(3, np.int64),
    )


@njit(cache=True, nogil=True)
def bin_of(nanoseconds: float) -> int:  # pragma: no cover - compiled
    """Return the bin a time [ns] falls into."""
    if not nanoseconds > SHORTEST:
        return 0
    return min(int(PER_OCTAVE * log2(nanoseconds / SHORTEST)), BINS - 1)


@njit(cache=True, nogil=True)
def quantile(counts: IntArray, share: float) -> float:  # pragma: no cover - compiled
    """Return the time [s] below which a share of the counted ones lies; 0 where none is counted.

    Args:
        counts: one for each bin, shape (n, BINS); the n are added.
        share: 0.5 for the median.
    """
    total = 0
    for i in range(BINS):
        for n in range(len(counts)):
            total += counts[n, i]
    if total == 0:
        return 0.0
    seen = 0
    for i in range(BINS):
        for n in range(len(counts)):
            seen += counts[n, i]
        if seen >= share * total:
            return 1e-9 * SHORTEST * exp2((i + 0.5) / PER_OCTAVE)
    return 1e-9 * SHORTEST * exp2(BINS / PER_OCTAVE)


@njit(cache=True, nogil=True)
def count_tick(
    pace: Pace, due: int, woke: int, ended: int, missed: int
) -> bool:  # pragma: no cover - compiled
    """Count one tick.

    Args:
        pace: overwritten.
        due: when it was due [ns].
        woke: when it began [ns].
        ended: when it was done [ns].
        missed: due times that had passed when it was done, and are skipped.

    Returns:
        Whether an eighth of a second is over, so that the figures are worth reading again.
    """
    duration, lateness = bin_of(ended - woke), bin_of(woke - due)
    window = pace.place[0]
    pace.windows[window, DURATION, duration] += 1
    pace.windows[window, LATENESS, lateness] += 1
    pace.totals[DURATION, duration] += 1
    pace.totals[LATENESS, lateness] += 1
    slot = ended // SLOT
    last = pace.place[1]
    over = slot != last
    if over:
        if last == 0:  # the first slot is never a whole one, and is not counted
            pace.slots[:] = 0
        for number in range(max(last + 1, slot - SLOTS), slot + 1):
            pace.slots[number % (SLOTS + 1), :] = 0
        pace.place[2] = 0 if last == 0 else min(pace.place[2] + slot - last, SLOTS + 1)
        if last // SLOTS != slot // SLOTS:
            pace.place[0] = 1 - window
            pace.windows[1 - window] = 0
        pace.place[1] = slot
    pace.slots[slot % (SLOTS + 1), _DONE] += 1
    pace.slots[slot % (SLOTS + 1), _SKIPPED] += missed
    return bool(over)


@njit(cache=True, nogil=True)
def last_second(pace: Pace, out: FloatArray) -> bool:  # pragma: no cover - compiled
    """Write ticks done and ticks missed in the last eight whole slots, shape (2,).

    Returns:
        Whether there are eight whole slots; before, both are zero.
    """
    out[:] = 0.0
    if pace.place[2] <= SLOTS:  # the first of them began before the servo did
        return False
    current = pace.place[1] % (SLOTS + 1)
    for k in range(SLOTS + 1):
        if k != current:
            out[_DONE] += pace.slots[k, _DONE]
            out[_SKIPPED] += pace.slots[k, _SKIPPED]
    return True
