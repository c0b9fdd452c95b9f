"""What the servo and its parent share: one block of memory without a name, gone with the last process that has it.

It has three areas, each written by one side under a sequence lock (Lameter 2005, Effective synchronization on
Linux/NUMA systems): the writer makes the lock's number odd, writes, makes it even; a reader copies and keeps the copy
if the number was even and has not moved. Nobody waits for anybody: a reader that meets a writer tries again a few
times, and then keeps what it had. Fences make it hold on any processor.

| area | written by | words | reals |
|---|---|---|---|
| command | parent | sequence numbers, counts of writes | poses |
| state | servo, every tick | counters, flags, sequence numbers followed | figures, records, forces on the hands |
| field | servo, every fourth tick | the tick it shows | amplitudes |

Signals are single words outside the locks: each is written whole. So are the counts of `totals`, which only grow.

The trail is what the newest ticks consumed and what came of it, a row a tick in a ring: the servo writes a row and
then counts it; a reader copies rows that were counted, looks again how far the servo is, and leaves out what may have
been written over meanwhile (`trail`).
"""

from __future__ import annotations

from multiprocessing.sharedctypes import RawArray
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
from numba import njit

from trocar.model import FloatArray
from trocar.realtime.clock import fence
from trocar.realtime.percentiles import BINS
from trocar.simulation import POSE, RECORD

IntArray = npt.NDArray[np.int64]
FieldShape = tuple[int, int, int]  # layers, M, N

# Words of the command; one for each hand from there on.
SEQUENCE, WRITES = 0, 2
# Words of the state; CONSUMED is one for each hand, PUBLISHED the clock's time [ns].
TICK, MISSED, REFUSED, FLAGS, PUBLISHED, RESETS_DONE, CONSUMED = 0, 1, 2, 3, 4, 5, 6
# The first reals of the state: [s], RATE [Hz]. Records and forces follow.
TIME, RATE, P50, P99, P999, LATE_P50, LATE_P99, FIGURES = 0, 1, 2, 3, 4, 5, 6, 7
# Signals: when the parent last lived [ns], how many resets it has asked for, not 0 when the servo is to end.
BEAT, RESETS, STOP = 0, 1, 2

# Columns of the trail: whether a tick began from rest, ticks missed before it, poses as they came and as they were
# followed, records.
BEGAN, MISSED_BEFORE, TARGETS, FOLLOWED, RECORDS = 0, 1, 2, 2 + 2 * POSE, 2 + 4 * POSE
TRAIL = RECORDS + 2 * RECORD
TRAIL_TICKS = 16384  # kept: whoever reads has so many milliseconds

READER_TRIES = 64
_LINE = 64  # bytes that processors hand over at a time; each part has lines of its own


class Area(NamedTuple):
    """What one side publishes for the other: whole numbers and reals under one lock."""

    lock: IntArray
    words: IntArray
    reals: FloatArray


class Trail(NamedTuple):
    """What the newest ticks did.

    Attributes:
        written: ticks written since the start, shape (1,).
        rows: tick t is in row t modulo TRAIL_TICKS, from 0; shape (TRAIL_TICKS, TRAIL).
    """

    written: IntArray
    rows: FloatArray


class Shared(NamedTuple):
    """The block, laid out."""

    command: Area
    state: Area
    field: Area
    signals: IntArray
    totals: IntArray
    trail: Trail


def allocate(field_shape: FieldShape) -> Any:
    """Return a zeroed block; hand it to a process as an argument of its start."""
    return RawArray("B", sum(_padded(count) for count in _counts(field_shape)) + _LINE)


def view(block: Any, field_shape: FieldShape) -> Shared:
    """Lay a block out."""
    memory = np.frombuffer(block, np.uint8)
    place = -memory.ctypes.data % _LINE
    parts: list[Any] = []
    for count in _counts(field_shape):
        parts.append(memory[place : place + 8 * count])
        place += _padded(count)
    views = [part.view(kind) for part, kind in zip(parts, _KINDS, strict=True)]
    return Shared(
        command=Area(*views[0:3]),
        state=Area(*views[3:6]),
        field=Area(*views[6:9]),
        signals=views[9],
        totals=views[10].reshape(2, BINS),
        trail=Trail(written=views[11], rows=views[12].reshape(TRAIL_TICKS, TRAIL)),
    )


def copy_of(area: Area) -> Area:
    """Return memory of one's own, to read an area into or to publish it from."""
    return Area(lock=area.lock.copy(), words=area.words.copy(), reals=area.reals.copy())


def poses_of(command: Area) -> FloatArray:
    """Return a view of the poses, shape (2, POSE)."""
    return command.reals.reshape(2, POSE)


def records_of(state: Area) -> FloatArray:
    """Return a view of the instruments' records, shape (2, RECORD)."""
    return state.reals[FIGURES : FIGURES + 2 * RECORD].reshape(2, RECORD)


def forces_of(state: Area) -> FloatArray:
    """Return a view of the forces on the hands [N], shape (2, 3)."""
    return state.reals[FIGURES + 2 * RECORD :].reshape(2, 3)


@njit(cache=True, nogil=True)
def publish(own: Area, area: Area) -> None:  # pragma: no cover - compiled
    """Copy one's own memory into an area, whole for every reader."""
    area.lock[0] += 1
    fence()
    for k in range(len(area.words)):
        area.words[k] = own.words[k]
    for k in range(len(area.reals)):
        area.reals[k] = own.reals[k]
    fence()
    area.lock[0] += 1


@njit(cache=True, nogil=True)
def read(area: Area, own: Area) -> bool:  # pragma: no cover - compiled
    """Copy an area into one's own memory.

    Returns:
        Whether the copy is whole; if not, it must not be used.
    """
    for _ in range(READER_TRIES):
        fence()
        number = area.lock[0]
        fence()
        for k in range(len(area.words)):
            own.words[k] = area.words[k]
        for k in range(len(area.reals)):
            own.reals[k] = area.reals[k]
        fence()
        if number % 2 == 0 and area.lock[0] == number:
            own.lock[0] = number
            return True
    return False


def _counts(field_shape: FieldShape) -> tuple[int, ...]:
    command = (1, WRITES + 2, 2 * POSE)
    state = (1, CONSUMED + 2, FIGURES + 2 * RECORD + 2 * 3)
    field = (1, 1, int(np.prod(field_shape)))
    return (*command, *state, *field, STOP + 1, 2 * BINS, 1, TRAIL_TICKS * TRAIL)


_KINDS = (int, int, float) * 3 + (int, int) + (int, float)


def _padded(count: int) -> int:
    return -(-8 * count // _LINE) * _LINE
