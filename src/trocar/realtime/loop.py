"""The servo's loop, compiled whole: wait until due, read, follow, step, guard, publish, leave a trail.

Nothing in it allocates, locks, logs or asks Python. A tick that is done later than one period after it was due has
cost the due times that passed meanwhile: they are skipped and counted, never made good in a burst, so the tissue's
time then falls behind the clock's.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
from numba import njit

from trocar.model import FloatArray
from trocar.realtime.clock import SECOND, now, parent_process, sleep_until
from trocar.realtime.guard import (
    LATCHED,
    LIMITED,
    STILL_WHOLE,
    GuardLimits,
    GuardState,
    forget,
    guarded,
    unloaded,
)
from trocar.realtime.percentiles import (
    DURATION,
    LATENESS,
    Pace,
    count_tick,
    last_second,
    quantile,
    unpaced,
)
from trocar.realtime.shared import (
    BEAT,
    CONSUMED,
    FIGURES,
    FLAGS,
    LATE_P50,
    LATE_P99,
    MISSED,
    P50,
    P99,
    P999,
    PUBLISHED,
    RATE,
    REFUSED,
    RESETS,
    RESETS_DONE,
    SEQUENCE,
    STOP,
    TICK,
    TIME,
    WRITES,
    Area,
    FieldShape,
    Shared,
    copy_of,
    forces_of,
    poses_of,
    publish,
    read,
    records_of,
)
from trocar.realtime.tracking import Following, TrackState, absent, aim, arrive, follow
from trocar.realtime.trail import leave
from trocar.simulation import HANDLE, HANDLE_FORCE, PRESENT

IntArray = npt.NDArray[np.int64]

# What the servo says of itself, bits of FLAGS.
SCHEDULED, IN_MEMORY, SHARP_TIMER = 1, 2, 4  # what the system allowed
DEGRADED, UNHEARD, FAULT, POSE_REFUSED, FORCE_LIMITED, HURRIED = 8, 16, 32, 64, 128, 256
ALLOWED = SCHEDULED | IN_MEMORY | SHARP_TIMER

# Why the loop ended.
STOPPED, ORPHANED, FORGOTTEN = 0, 1, 2

FIELD_EVERY = 4  # ticks
FORGOTTEN_AFTER = 2 * SECOND  # [ns] without a beat
ACHIEVED, MOST_MISSED = 0.99, 0.01  # of the requested rate; below, above: degraded
_ASLEEP = SECOND // 10  # [ns] of lateness that only a stopped process has


class Settings(NamedTuple):
    """What the loop is told at the start.

    Attributes:
        period: of a tick [ns].
        parent: number of the process that started it; 0 where nobody need live.
        allowed: bits the system granted.
    """

    period: int
    parent: int
    allowed: int


class Work(NamedTuple):
    """The loop's own memory.

    Attributes:
        guard, track, pace: of the parts.
        command: the parent's, as read last.
        poses: its poses, a view, shape (2, POSE).
        seen: how often each pose had been written when last looked at, shape (2,).
        state: what is published next.
        records, forces, figures: views of it, shapes (2, RECORD), (2, 3), (FIGURES,).
        field: what is published next.
        amplitudes: a view of it, shape (layers, M, N).
        second: scratch, shape (2,).
    """

    guard: GuardState
    track: TrackState
    pace: Pace
    command: Area
    poses: FloatArray
    seen: IntArray
    state: Area
    records: FloatArray
    forces: FloatArray
    figures: FloatArray
    field: Area
    amplitudes: FloatArray
    second: FloatArray


def make_work(shared: Shared, field_shape: FieldShape) -> Work:
    """Return fresh memory for one run of the loop."""
    command, state, field = copy_of(shared.command), copy_of(shared.state), copy_of(shared.field)
    return Work(
        guard=unloaded(),
        track=absent(),
        pace=unpaced(shared.totals),
        command=command,
        poses=poses_of(command),
        seen=np.zeros(2, np.int64),
        state=state,
        records=records_of(state),
        forces=forces_of(state),
        figures=state.reals[:FIGURES],
        field=field,
        amplitudes=field.reals.reshape(field_shape),
        second=np.zeros(2),
    )


def serve(
    advance: Any,
    amplitudes: Any,
    come_to_rest: Any,
    scene: Any,
    state: Any,
    shared: Shared,
    work: Work,
    settings: Settings,
    following: Following,
    limits: GuardLimits,
) -> int:  # pragma: no cover - compiled
    """Run until told to stop, or until nobody is there to tell; to be compiled (`physics.with_own_cache`).

    Args:
        advance: pointer to the physics' step (`physics`).
        amplitudes: pointer to what writes its field.
        come_to_rest: pointer to what puts it back.
        scene: the physics' parameters.
        state: the physics' state, overwritten.
        shared: with the parent.
        work: from `make_work`.
        settings: the rest.
        following: how poses are followed.
        limits: what a hand may feel.

    Returns:
        `STOPPED`, `ORPHANED` or `FORGOTTEN`.
    """
    period = settings.period
    dt = 1e-9 * period
    tick = 0
    missed = 0
    refused = 0
    refused_at = -FORGOTTEN_AFTER
    fault = False
    degraded = 0
    words = work.state.words
    signals = shared.signals
    resets = signals[RESETS]
    begins = True
    due = now() + period
    heard = due
    while True:
        sleep_until(due)
        woke = now()
        if woke - due > _ASLEEP:  # the process was stopped; the parent may have been too, and is given time
            heard += woke - due
        beat = signals[BEAT]
        heard = max(heard, beat)
        silence = 1e-9 * max(woke - (beat if beat > 0 else heard), 0)
        if signals[STOP] != 0:
            return STOPPED
        if settings.parent != 0 and parent_process() != settings.parent:
            return ORPHANED
        if woke - heard > FORGOTTEN_AFTER:
            return FORGOTTEN

        flags = settings.allowed | degraded
        if silence > STILL_WHOLE:
            flags |= UNHEARD
        if signals[RESETS] != resets:
            resets = signals[RESETS]
            come_to_rest(scene, state)
            forget(work.guard)
            fault = False
            begins = True
        if read(shared.command, work.command):
            for hand in range(2):
                writes = work.command.words[WRITES + hand]
                if writes != work.seen[hand]:
                    work.seen[hand] = writes
                    if aim(work.track, hand, work.poses[hand]):
                        words[CONSUMED + hand] = work.command.words[SEQUENCE + hand]
                    else:
                        refused += 1
                        refused_at = woke
        if woke - refused_at < SECOND:
            flags |= POSE_REFUSED
        if begins:
            arrive(work.track)
        for hand in range(2):
            if follow(following, work.track, hand, dt):
                flags |= HURRIED

        if not fault:
            fault = not advance(scene, state, work.track.pose, work.records)
        if fault:
            work.records[:] = 0.0
        for hand in range(2):
            pose = work.track.pose[hand]
            wanted = work.records[hand, HANDLE_FORCE : HANDLE_FORCE + 3]
            place = pose[HANDLE : HANDLE + 3]
            held = pose[PRESENT] != 0.0 and not fault
            did = guarded(limits, work.guard, hand, wanted, place, held, silence, dt, work.forces[hand])
            if did == LATCHED:
                fault = True
            elif did == LIMITED:
                flags |= FORCE_LIMITED
        if fault:
            flags |= FAULT
            work.records[:] = 0.0
            work.forces[:] = 0.0

        tick += 1
        if tick % FIELD_EVERY == 1:
            if fault:
                work.amplitudes[:] = 0.0
            else:
                amplitudes(scene, state, work.amplitudes)
            work.field.words[0] = tick
            publish(work.field, shared.field)
        work.figures[TIME] = tick * dt
        words[TICK] = tick
        words[MISSED] = missed
        words[REFUSED] = refused
        words[FLAGS] = flags
        words[RESETS_DONE] = resets
        words[PUBLISHED] = now()
        publish(work.state, shared.state)
        leave(shared.trail, begins, missed, work.track, work.records)
        begins = False

        ended = now()
        late = (ended - due) // period
        missed += late
        if count_tick(work.pace, due, woke, ended, late):
            degraded = _report(work.pace, work.second, work.figures, period)
        due += (1 + late) * period


@njit(cache=True, nogil=True)
def _report(pace: Pace, second: FloatArray, figures: FloatArray, period: int) -> int:  # pragma: no cover
    """Work the pace out; return `DEGRADED` where it is too slow."""
    figures[P50] = quantile(pace.windows[:, DURATION], 0.5)
    figures[P99] = quantile(pace.windows[:, DURATION], 0.99)
    figures[P999] = quantile(pace.windows[:, DURATION], 0.999)
    figures[LATE_P50] = quantile(pace.windows[:, LATENESS], 0.5)
    figures[LATE_P99] = quantile(pace.windows[:, LATENESS], 0.99)
    if not last_second(pace, second):
        return 0
    done, skipped = second[0], second[1]
    figures[RATE] = done
    slow = done * period < ACHIEVED * SECOND
    return DEGRADED if slow or skipped > MOST_MISSED * (done + skipped) else 0
