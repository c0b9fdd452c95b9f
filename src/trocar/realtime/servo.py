"""The parent's handle on the servo: start it, tell it where the hands are, see what it published, end it.

The servo runs in a process of its own, started afresh (spawn), so that what goes wrong in it, or here, stops there: if
it dies, hangs or falls silent, forces read here are zero within 100 ms of its last tick, and it can be started again
with the tissue at rest; if this process dies, the servo ends within two seconds. Call `beat` every 20 ms or so.
"""

from __future__ import annotations

import os
import signal
import time
from dataclasses import dataclass
from enum import IntFlag
from multiprocessing import get_context
from multiprocessing.connection import Connection
from multiprocessing.context import SpawnProcess
from threading import Lock, current_thread, main_thread
from typing import Any, Self

import numpy as np
import numpy.typing as npt

from trocar.errors import InputError, ServoError
from trocar.model import FloatArray
from trocar.realtime import loop, shared
from trocar.realtime.child import start_deaf
from trocar.realtime.clock import now
from trocar.realtime.guard import GuardLimits, beat_factor
from trocar.realtime.physics import Physics, live
from trocar.realtime.process import EXIT_COULD_NOT_START, EXIT_OF_LOOP, Orders, compiled_loop, run
from trocar.realtime.tracking import Following
from trocar.simulation import DRAG, FORCE, HANDLE, HANDLE_FORCE, JAW, PRESENT, ROLL

START_WITHIN = 300.0  # [s] for compiling everything on a slow and busy machine, the first time
_STOP_WITHIN = 0.5  # [s] for the loop to see the flag, then for SIGTERM to work
_WAIT = 5e-3  # [s] between looks


class ServoFlag(IntFlag):
    """What the servo says of itself."""

    SCHEDULED = loop.SCHEDULED  # the system gave it a real-time class
    IN_MEMORY = loop.IN_MEMORY  # its memory stays in memory
    SHARP_TIMER = loop.SHARP_TIMER  # its timers are not put off
    DEGRADED = loop.DEGRADED  # below 99 % of the rate, or more than 1 % missed, in the last second
    UNHEARD = loop.UNHEARD  # no beat for 50 ms: forces are falling or zero
    FAULT = loop.FAULT  # a number was not finite: forces are zero until a reset
    POSE_REFUSED = loop.POSE_REFUSED  # an impossible pose came in the last second
    FORCE_LIMITED = loop.FORCE_LIMITED  # a hand feels less than the tissue's force
    HURRIED = loop.HURRIED  # a hand was faster than an instrument may be


@dataclass(frozen=True, kw_only=True)
class ServoState:
    """What the servo published last, copied; never changed afterwards.

    Attributes:
        alive: whether its process runs.
        age: how long ago [s].
        tick: ticks since the start.
        time: the tissue's [s].
        records: of both instruments (`trocar.simulation`), shape (2, RECORD); forces in it fall to zero when the servo
            is silent.
        hand_forces: what the hands may feel [N], shape (2, 3); the same.
        sequences: numbers of the poses followed, left and right.
        resets: resets done.
        missed: ticks missed since the start.
        refused: poses refused since the start.
        rate: ticks in the last second [Hz]; 0 until there has been a whole one.
        tick_p50, tick_p99, tick_p999: duration of a tick in the last second or two [s].
        late_p50, late_p99: how late ticks began [s].
        flags: what the servo says of itself.
        amplitudes: of u_z [m], shape (layers, M, N).
        amplitudes_tick: the tick they show.
    """

    alive: bool
    age: float
    tick: int
    time: float
    records: FloatArray
    hand_forces: FloatArray
    sequences: tuple[int, int]
    resets: int
    missed: int
    refused: int
    rate: float
    tick_p50: float
    tick_p99: float
    tick_p999: float
    late_p50: float
    late_p99: float
    flags: ServoFlag
    amplitudes: FloatArray
    amplitudes_tick: int


class Servo:
    """A scene that runs by itself.

    Args:
        scene: parameters, with `dt` [s], `modes` (M, N) and `layers` (how many).
        state: where the tissue begins, at every start.
        physics: functions that move them; `trocar.simulation`'s if not given.
        smoothing: how far instruments lag behind poses [s]; 0 where a pose comes every tick.
        speed: of a handle at most [m/s].
        limits: what a hand may feel.
        scheduled: whether to ask for a real-time class.
    """

    def __init__(
        self,
        scene: Any,
        state: Any,
        *,
        physics: Physics | None = None,
        smoothing: float = 8e-3,
        speed: float = 1.0,
        limits: GuardLimits | None = None,
        scheduled: bool = True,
    ) -> None:
        _require("smoothing", smoothing, 0.0, 1.0)
        _require("speed", speed, 1e-3, 100.0)
        _require("scene.dt", scene.dt, 1e-4, 1.0)
        self._shape = (int(scene.layers), int(scene.modes[0]), int(scene.modes[1]))
        self._orders: dict[str, Any] = {
            "physics": live() if physics is None else physics,
            "scene": scene,
            "state": state,
            "period": round(1e9 * scene.dt),
            "field_shape": self._shape,
            "following": Following(smoothing=float(smoothing), speed=float(speed)),
            "limits": _checked(GuardLimits() if limits is None else limits),
            "scheduled": scheduled,
            "parent": os.getpid(),
        }
        self._lock = Lock()  # of this side's threads among themselves; the servo knows nothing of it
        self._process: SpawnProcess | None = None
        self._resets = 0
        self._prepare()

    def _prepare(self) -> None:
        self._block = shared.allocate(self._shape)
        self._shared = shared.view(self._block, self._shape)
        self._command = shared.copy_of(self._shared.command)
        self._state = shared.copy_of(self._shared.state)
        self._field = shared.copy_of(self._shared.field)
        shared.publish(self._command, self._shared.command)  # compiled before anything depends on it
        self.latest()

    def __enter__(self) -> Self:
        self.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def compile(self) -> None:
        """Compile here what the servo's own process will need, into numba's caches: it then starts in seconds."""
        compiled_loop(Orders(**self._orders, tied=False), self._shared)

    def start(self, *, within: float = START_WITHIN) -> None:
        """Start the process and wait for its first tick.

        Args:
            within: how long to wait at most [s].

        Raises:
            ServoError: it runs already, or did not get so far.
        """
        if self.alive:
            raise ServoError("the servo: expected none to run, got one that does; close it first")
        context = get_context("spawn")
        trouble, sender = context.Pipe(duplex=False)
        orders = Orders(**self._orders, tied=current_thread() is main_thread())
        process = context.Process(
            target=run, args=(orders, self._block, sender), name="trocar servo", daemon=True
        )
        start_deaf(process)
        sender.close()
        self._process = process
        try:
            self._await_first_tick(process, trouble, within)
        except BaseException:  # an interrupt too: nothing stays behind
            self.close()
            raise
        finally:
            trouble.close()

    def _await_first_tick(self, process: SpawnProcess, trouble: Connection, within: float) -> None:
        end = time.monotonic() + within
        while self._shared.state.words[shared.TICK] == 0:
            self.beat()
            if trouble.poll(_WAIT):
                try:
                    sentence = trouble.recv()
                except EOFError:  # it ended, or closed its end
                    sentence = ""
                if sentence:
                    process.join(10 * _STOP_WITHIN)  # it is on its way out
                    raise ServoError(f"the servo could not start: {sentence}")
                if not self.alive:
                    raise ServoError(f"the servo could not start: it {self.exit_reason}")
                time.sleep(_WAIT)
            if time.monotonic() > end:
                raise ServoError(f"the servo: expected a first tick within {within:g} s, got none")
        self.beat()

    def command(
        self,
        instrument: int,
        *,
        present: bool,
        handle: tuple[float, float, float],
        roll: float = 0.0,
        jaw: float = 1.0,
        sequence: int = 0,
    ) -> None:
        """Say where an instrument's handle is; the servo checks it.

        Args:
            instrument: 0 left, 1 right.
            present: whether the instrument is in the hand.
            handle: its place [m].
            roll: about the shaft [rad].
            jaw: opening, 0 closed to 1 open.
            sequence: any number; comes back with the first tick that follows this pose.

        Raises:
            InputError: there is no such instrument.
        """
        if instrument not in (0, 1):
            raise InputError("instrument", "0 (left) or 1 (right)", instrument)
        with self._lock:
            pose = shared.poses_of(self._command)[instrument]
            pose[PRESENT] = float(present)
            pose[HANDLE : HANDLE + 3] = handle
            pose[ROLL] = roll
            pose[JAW] = jaw
            self._command.words[shared.SEQUENCE + instrument] = sequence
            self._command.words[shared.WRITES + instrument] += 1
            shared.publish(self._command, self._shared.command)

    def beat(self) -> None:
        """Say that this process lives."""
        self._shared.signals[shared.BEAT] = now()

    def reset(self) -> None:
        """Put the tissue to rest and forget faults, at the next tick; instruments are where their poses say."""
        with self._lock:
            self._shared.signals[shared.RESETS] += 1

    def latest(self) -> ServoState:
        """Copy the newest state; at once, whatever the servo does."""
        alive = self.alive
        with self._lock:  # what could not be read whole stays what it was, and ages
            state, field = shared.copy_of(self._state), shared.copy_of(self._field)
            if shared.read(self._shared.state, state):
                self._state = state
            if shared.read(self._shared.field, field):
                self._field = field
            state, field = self._state, self._field
        published = state.words[shared.PUBLISHED]
        age = 1e-9 * max(now() - int(published), 0) if published else float("inf")
        share = beat_factor(age) if alive else 0.0
        records = shared.records_of(state).copy()
        for first, past in ((FORCE, FORCE + 3), (HANDLE_FORCE, HANDLE_FORCE + 3), (DRAG, DRAG + 2)):
            records[:, first:past] *= share
        words = [int(word) for word in state.words]
        figures = [float(figure) for figure in state.reals[: shared.FIGURES]]
        return ServoState(
            alive=alive,
            age=age,
            tick=words[shared.TICK],
            time=figures[shared.TIME],
            records=_frozen(records),
            hand_forces=_frozen(share * shared.forces_of(state)),
            sequences=(words[shared.CONSUMED], words[shared.CONSUMED + 1]),
            resets=words[shared.RESETS_DONE],
            missed=words[shared.MISSED],
            refused=words[shared.REFUSED],
            rate=figures[shared.RATE] if alive else 0.0,
            tick_p50=figures[shared.P50],
            tick_p99=figures[shared.P99],
            tick_p999=figures[shared.P999],
            late_p50=figures[shared.LATE_P50],
            late_p99=figures[shared.LATE_P99],
            flags=ServoFlag(words[shared.FLAGS]),
            amplitudes=_frozen(field.reals.reshape(self._shape)),
            amplitudes_tick=int(field.words[0]),
        )

    @property
    def trail(self) -> shared.Trail:
        """What the newest ticks did (`trail.read_trail`), of this start of the servo; kept while it is referred to."""
        return self._shared.trail

    @property
    def following(self) -> Following:
        """How poses are followed."""
        following: Following = self._orders["following"]
        return following

    def histograms(self) -> npt.NDArray[np.int64]:
        """Return how many ticks took how long and began how late since the start (`percentiles`), (2, BINS)."""
        return self._shared.totals.copy()

    @property
    def alive(self) -> bool:
        """Whether the process runs."""
        return self._process is not None and self._process.is_alive()

    @property
    def process_id(self) -> int | None:
        """The process's number, while there is one."""
        return None if self._process is None else self._process.pid

    @property
    def exit_reason(self) -> str:
        """How the process ended, to go on after "the servo": "was killed by SIGKILL"; "" while it runs."""
        if self._process is None:
            return "was not started"
        return _reason(self._process.exitcode)

    def restart(self, *, within: float = START_WITHIN) -> None:
        """Start again with the tissue at rest and no instrument in a hand; end what still runs first.

        Raises:
            ServoError: as in `start`.
        """
        self.close()
        self._prepare()
        self.start(within=within)

    def close(self) -> None:
        """End the process, within two seconds whatever it does; calling it again does nothing."""
        process = self._process
        if process is None:
            return
        self._shared.signals[shared.STOP] = 1
        process.join(_STOP_WITHIN)
        if process.is_alive():
            process.terminate()
            process.join(_STOP_WITHIN)
        if process.is_alive():
            process.kill()
            process.join()


def _reason(code: int | None) -> str:
    if code is None:
        return ""
    if code < 0:
        return f"was killed by {signal.Signals(-code).name}"
    return {
        EXIT_COULD_NOT_START: "could not start",
        EXIT_OF_LOOP + loop.STOPPED: "was stopped",
        EXIT_OF_LOOP + loop.ORPHANED: "ended because its parent was gone",
        EXIT_OF_LOOP + loop.FORGOTTEN: "ended because it had no beat for two seconds",
    }.get(code, f"ended with code {code}")


def _require(where: str, value: float, low: float, high: float) -> None:
    if not low <= value <= high:
        raise InputError(where, f"a number from {low:g} to {high:g}", value)


def _checked(limits: GuardLimits) -> GuardLimits:
    for name, value in limits._asdict().items():
        if not 0.0 <= value < float("inf"):
            raise InputError(f"limits.{name}", "a number that is not negative", value)
    return GuardLimits(*(float(value) for value in limits))


def _frozen(array: FloatArray) -> FloatArray:
    array.flags.writeable = False
    return array
