"""How the servo keeps time on this machine, beside a loop that does nothing.

Both run in processes of their own, set up alike, in turns: an empty loop, the servo, an empty loop, and so on to an
empty one at the end. What the machine does to both is in both; only rounds of one run are compared.

How long a tick's own work takes is told apart from what interrupts it: the same motion is played several times without
a pause, and each tick counts with its quickest time.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from time import monotonic, sleep
from typing import Any

import numpy as np
import numpy.typing as npt
from numba import njit

from trocar.devices.device import Poses
from trocar.devices.recorder import pose_table
from trocar.errors import InputError, ServoError
from trocar.model import FloatArray
from trocar.realtime.clock import now
from trocar.realtime.empty_loop import run_empty
from trocar.realtime.percentiles import BINS, DURATION, LATENESS, IntArray, quantile
from trocar.realtime.physics import Physics, live
from trocar.realtime.servo import Servo, ServoFlag
from trocar.simulation import RECORD, TOUCH, TOUCH_TOUCHING

Motion = Callable[[float], Poses]
"""Both poses at a time [s]."""

POSE_RATE = 90.0  # [Hz] at which the hands move, as from a browser
SETTLE = 1.0  # [s] of a servo's round that is not counted: hands come down, caches fill
WORK_TICKS, REPEATS = 3000, 5  # of the work by itself


@dataclass(frozen=True, kw_only=True)
class Round:
    """How one loop kept time.

    Attributes:
        loop: "servo" or "empty".
        ticks: done.
        missed: due times skipped.
        missed_percent: of both together.
        tick_p50_us, tick_p99_us, tick_p999_us: from waking to published.
        late_p50_us, late_p99_us, late_p999_us: from due to awake.
        touching: share of the looks at which an instrument touched the tissue, the lesser of both; 0 when empty.
        scheduled: whether it had a real-time class.
    """

    loop: str
    ticks: int
    missed: int
    missed_percent: float
    tick_p50_us: float
    tick_p99_us: float
    tick_p999_us: float
    late_p50_us: float
    late_p99_us: float
    late_p999_us: float
    touching: float
    scheduled: bool


@dataclass(frozen=True, kw_only=True)
class ServoBench:
    """What was measured.

    Attributes:
        processor: its name.
        rounds: in the order in which they ran.
        servo, empty: all rounds of a kind as one; None where there was none.
        work_p50_us, work_p999_us, work_max_us: of ticks by themselves, each the quickest of its repeats.
    """

    processor: str
    rounds: tuple[Round, ...]
    servo: Round | None
    empty: Round | None
    work_p50_us: float
    work_p999_us: float
    work_max_us: float

    def as_dict(self) -> dict[str, Any]:
        """Return it as JSON takes it."""
        return asdict(self)


@dataclass(frozen=True)
class _Measured:
    """Counts of one round."""

    loop: str
    totals: npt.NDArray[np.int64]
    missed: int
    touching: float
    scheduled: bool


def alternate(
    scene: Any,
    state: Any,
    motion: Motion,
    *,
    seconds: float,
    rounds: int,
    only_empty: bool = False,
    physics: Physics | None = None,
    progress: Callable[[int, int], None] | None = None,
    attend: Callable[[Servo | None], None] = lambda servo: None,
) -> ServoBench:
    """Run empty loop and servo in turns.

    Args:
        scene: for `Servo`.
        state: for `Servo`.
        motion: of the hands.
        seconds: of each round.
        rounds: of the servo; there is one more of the empty loop.
        only_empty: leave the servo out.
        physics: for `Servo`.
        progress: called with rounds done and rounds in all.
        attend: given each servo as it runs, and None when it is about to end.

    Raises:
        InputError: too short, too long or no rounds.
        ServoError: a servo did not start, or ended early.
    """
    if not 1.0 <= seconds <= 86400.0:
        raise InputError("seconds", "a number from 1 to 86400", seconds)
    if not 1 <= rounds <= 1000:
        raise InputError("rounds", "a whole number from 1 to 1000", rounds)
    kinds = ["empty", *(("empty",) if only_empty else ("servo", "empty")) * rounds]
    found: list[_Measured] = []
    for kind in kinds:
        if progress is not None:
            progress(len(found), len(kinds))
        if kind == "empty":
            empty = run_empty(round(1e9 * scene.dt), seconds)
            found.append(_Measured("empty", empty.totals, empty.missed, 0.0, empty.scheduled))
        else:
            found.append(_servo_round(scene, state, motion, seconds, physics, attend))
    work = work_alone(scene, state, motion, physics=physics)
    of = {kind: [one for one in found if one.loop == kind] for kind in ("servo", "empty")}
    return ServoBench(
        processor=_processor(),
        rounds=tuple(_round(one) for one in found),
        servo=_together(of["servo"]),
        empty=_together(of["empty"]),
        work_p50_us=float(np.median(work)),
        work_p999_us=float(np.percentile(work, 99.9)),
        work_max_us=float(work.max()),
    )


def work_alone(
    scene: Any, state: Any, motion: Motion, *, physics: Physics | None = None
) -> npt.NDArray[np.float64]:
    """Return how long the ticks of a motion take by themselves [us], each the quickest of `REPEATS`.

    Args:
        scene: the physics' parameters.
        state: put to rest, and overwritten.
        motion: of the hands.
        physics: the live one if not given.
    """
    physics = physics or live()
    first = round(SETTLE / scene.dt)
    ticks = first + WORK_TICKS
    poses = pose_table(motion, [tick * scene.dt for tick in range(ticks)])
    records = np.zeros((2, RECORD))
    quickest = np.full(ticks, np.iinfo(np.int64).max)
    took = np.zeros(ticks, dtype=np.int64)
    for _ in range(REPEATS):
        physics.come_to_rest(scene, state)
        _play(physics.advance, scene, state, poses, records, took)
        np.minimum(quickest, took, out=quickest)
    return 1e-3 * quickest[first:]


@njit(nogil=True)
def _play(
    advance: Any, scene: Any, state: Any, poses: FloatArray, records: FloatArray, took: IntArray
) -> None:  # pragma: no cover - compiled
    for tick in range(len(poses)):
        began = now()
        advance(scene, state, poses[tick], records)
        took[tick] = now() - began


def _servo_round(
    scene: Any,
    state: Any,
    motion: Motion,
    seconds: float,
    physics: Physics | None,
    attend: Callable[[Servo | None], None],
) -> _Measured:
    with Servo(scene, state, physics=physics) as servo:
        attend(servo)
        _move(servo, motion, 0.0, SETTLE)
        before, first = servo.histograms(), servo.latest()
        touches = _move(servo, motion, SETTLE, SETTLE + seconds)
        after, last = servo.histograms(), servo.latest()
        attend(None)
        if not servo.alive:
            raise ServoError(f"the servo {servo.exit_reason} while it was measured")
    share = float(np.mean(touches, axis=0).min())
    scheduled = ServoFlag.SCHEDULED in last.flags
    return _Measured("servo", after - before, last.missed - first.missed, share, scheduled)


def _move(servo: Servo, motion: Motion, begin: float, end: float) -> list[list[bool]]:
    """Play a motion in real time; return which instruments touched at each look."""
    looks: list[list[bool]] = []
    zero = monotonic() - begin
    sequence = 0
    while (time := monotonic() - zero) < end:
        sequence += 1
        for hand, pose in enumerate(motion(time)):
            servo.command(
                hand,
                present=pose.present,
                handle=pose.handle,
                roll=pose.roll,
                jaw=pose.jaw,
                sequence=sequence,
            )
        servo.beat()
        looks.append([bool(int(touch) & TOUCH_TOUCHING) for touch in servo.latest().records[:, TOUCH]])
        sleep(1 / POSE_RATE)
    return looks


def _together(parts: list[_Measured]) -> Round | None:
    if not parts:
        return None
    return _round(
        _Measured(
            loop=parts[0].loop,
            totals=np.sum([part.totals for part in parts], axis=0),
            missed=sum(part.missed for part in parts),
            touching=min(part.touching for part in parts),
            scheduled=all(part.scheduled for part in parts),
        )
    )


def _round(measured: _Measured) -> Round:
    done = int(measured.totals[DURATION].sum())
    tick = [_microseconds(measured.totals, DURATION, share) for share in (0.5, 0.99, 0.999)]
    late = [_microseconds(measured.totals, LATENESS, share) for share in (0.5, 0.99, 0.999)]
    return Round(
        loop=measured.loop,
        ticks=done,
        missed=measured.missed,
        missed_percent=100 * measured.missed / max(done + measured.missed, 1),
        tick_p50_us=tick[0],
        tick_p99_us=tick[1],
        tick_p999_us=tick[2],
        late_p50_us=late[0],
        late_p99_us=late[1],
        late_p999_us=late[2],
        touching=measured.touching,
        scheduled=measured.scheduled,
    )


def _microseconds(totals: npt.NDArray[np.int64], kind: int, share: float) -> float:
    return 1e6 * quantile(totals[kind].reshape(1, BINS), share)


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return "unknown"
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return f"{names[0]}, {os.cpu_count()} cores" if names else "unknown"
