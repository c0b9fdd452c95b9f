"""The live trainer behind the stream: a servo moves the tissue, a device the instruments, and the page is told.

The page's hands, or a device of the trainer's own, become handle poses for the servo; what the servo publishes becomes
snapshots. A servo that dies is started again with the tissue at rest, a few times; meanwhile forces are zero and the
page says why.
"""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Sequence
from contextlib import suppress
from typing import Any

from trocar.devices.device import Device, HandlePose
from trocar.devices.web import WebDevice
from trocar.errors import TrocarError
from trocar.realtime.servo import Servo, ServoFlag, ServoState
from trocar.simulation.kind import kind_of
from trocar.web.messages import Guiding, Hello, Notice
from trocar.web.source import Pose, Snapshot, Status
from trocar.web.stage import Stage

SMOOTHING = 8e-3  # [s] by which instruments follow poses that come at a display's rate
HEADSET = "headset"  # the name, in records, of hands that a headset's controllers are
_DEVICE_PERIOD = 4e-3  # [s] between poses of a device of the trainer's own
_TICKING = 0.5  # [s] since its last tick, at most
_RESTARTS = 3  # of a servo that died
_MOST_SEQUENCE = 2**32 - 1
_QUIET = 5.0  # [s] before the same sentence is said again

_SENTENCES = {
    ServoFlag.FAULT: (
        "warning",
        "A number in the tissue was not finite: forces are off. Reset the tissue (R).",
    ),
    ServoFlag.POSE_REFUSED: ("warning", "An impossible pose came and was ignored."),
}


class Trainer:
    """A tissue, two instruments and what moves them, as the stream wants them.

    Args:
        stage: what the page is shown of, at first.
        device: what moves the instruments; the page's hands if not given.
        lessons: whether there are tasks to do with it.
    """

    def __init__(self, stage: Stage, *, device: Device | None = None, lessons: bool = False) -> None:
        self._device = WebDevice(instruments=stage.instruments) if device is None else device
        self._lessons = lessons
        self._stage, self._hello = stage, self._greeting(stage)
        self._servo = servo_of(stage)
        self._notices: deque[Notice] = deque(maxlen=16)
        self._guiding: Guiding | None = None
        self._said: dict[str, float] = {}
        self._seen = ServoFlag(0)
        self._restarts = 0
        self._restarting: threading.Thread | None = None
        self._changing = threading.Lock()  # of the stage, one change at a time
        self._showing = threading.Lock()  # of servo and stage, which belong to each other
        self._ended = threading.Event()
        self._began: float | None = None  # when the device's time began: with the first page
        self._driving: threading.Thread | None = None
        self._tracked = [False, False]  # whether a headset's controllers hold the page's hands
        self._shown: tuple[tuple[Servo, int, int], Snapshot] | None = None

    def open(self) -> None:
        """Start the servo and the device; wait until the tissue ticks.

        Raises:
            TrocarError: one of them could not be started.
        """
        self._servo.start()
        try:
            self._device.open()
        except BaseException:
            self._servo.close()
            raise
        if not self._device.steered_by_page:
            self._driving = threading.Thread(target=self._drive, name="device", daemon=True)
            self._driving.start()

    def close(self) -> None:
        """End both; calling it again does nothing."""
        self._ended.set()
        for thread in (self._driving, self._restarting):
            if thread is not None:
                thread.join(5.0)
        with suppress(TrocarError):
            self._device.close()
        self._servo.close()

    @property
    def servo(self) -> Servo:
        """What moves the tissue."""
        return self._servo

    @property
    def runs(self) -> bool:
        """Whether the servo ticks."""
        return self._servo.alive and self._servo.latest().age < _TICKING

    @property
    def stage(self) -> Stage:
        """What the page is shown of."""
        return self._stage

    @property
    def device_name(self) -> str:
        """What moves the instruments now, as records name it: the page's hands are `web`, or `headset`."""
        return HEADSET if any(self._tracked) else self._device.name

    def begin_device(self) -> None:
        """Let the time of a device of the trainer's own begin now."""
        self._began = time.monotonic()

    def enter(self, stage: Stage) -> None:
        """Show another stage from now on; it takes as long as a servo takes to start.

        Raises:
            TrocarError: its servo could not be started; all stays as it was.
        """
        with self._changing:
            servo = servo_of(stage)
            servo.start()
            greeting = self._greeting(stage)
            with self._showing:
                before, self._servo = self._servo, servo
                self._stage, self._hello = stage, greeting
            before.close()
            if self._ended.is_set():
                servo.close()

    def hello(self) -> Hello:
        """Return what never changes; a device of the trainer's own begins with the first page that asks."""
        if self._began is None:
            self._began = time.monotonic()
        return self._hello

    def latest(self) -> Snapshot:
        """Return the newest state, whole."""
        with self._showing:
            servo = self._servo
            state = servo.latest()
            key = (servo, state.tick, state.amplitudes_tick)
            if self._shown is not None and self._shown[0] == key and state.age < 0.05:
                return self._shown[1]
            snapshot = self.snapshot_of(state)
            self._shown = (key, snapshot)
            return snapshot

    def snapshot_of(self, state: ServoState) -> Snapshot:
        """Return what the page is shown of a servo's state."""
        status = Status(0)
        if state.alive and state.age < 0.1:
            status |= Status.ALIVE
        if ServoFlag.DEGRADED in state.flags:
            status |= Status.DEGRADED
        silent = not state.alive or state.age >= 0.05
        if silent or ServoFlag.UNHEARD in state.flags or ServoFlag.FAULT in state.flags:
            status |= Status.FORCES_CUT
        self._tell_of(state.flags)
        return self._stage.snapshot(
            state.records,
            state.amplitudes,
            tick=state.tick,
            time=state.time,
            status=status,
            hand_forces=state.hand_forces,
            pose_sequence=(state.sequences[0] & _MOST_SEQUENCE, state.sequences[1] & _MOST_SEQUENCE),
            rate=state.rate,
            missed_ticks=state.missed,
            tick_p50=state.tick_p50,
            tick_p99=state.tick_p99,
        )

    def pose(self, instrument: int, pose: Pose, /) -> None:
        """Take a pose of the page's; where the trainer has a device of its own, it is none of the page's business."""
        if not self._device.steered_by_page:
            return
        self._tracked[instrument] = pose.tracked and pose.present
        held = HandlePose(present=pose.present, handle=pose.handle, roll=pose.roll, jaw=pose.jaw)
        if isinstance(self._device, WebDevice):
            self._device.take(instrument, held)
        self._follow(instrument, held, pose.sequence)

    def reset(self) -> None:
        """Put the tissue back to rest; a device of the trainer's own begins anew."""
        self._servo.reset()
        self.begin_device()

    def guiding(self) -> Guiding | None:
        """Return what to do now, if an attempt is under way."""
        return self._guiding

    def guide(self, guiding: Guiding | None) -> None:
        """Say what to do now; nothing, when no attempt is under way."""
        self._guiding = guiding

    def notices(self) -> Sequence[Notice]:
        """Return what the user should read and has not been given yet."""
        waiting = []
        while self._notices:
            waiting.append(self._notices.popleft())
        return waiting

    def beat(self) -> None:
        """Pass the server's life sign on to the servo, and look after the servo."""
        self._servo.beat()
        if not self._servo.alive and not self._ended.is_set():
            self._revive()

    def _greeting(self, stage: Stage) -> Hello:
        return stage.hello(by_page=self._device.steered_by_page, lessons=self._lessons)

    def _follow(self, instrument: int, pose: HandlePose, sequence: int) -> None:
        self._servo.command(
            instrument,
            present=pose.present,
            handle=pose.handle,
            roll=pose.roll,
            jaw=pose.jaw,
            sequence=sequence,
        )

    def _drive(self) -> None:
        """Hand a device's poses on until the end, and its forces back."""
        sequence, over = 0, False
        while not self._ended.wait(_DEVICE_PERIOD):
            now = time.monotonic() - self._began if self._began is not None else 0.0
            sequence += 1
            for instrument, pose in enumerate(self._device.poses(now)):
                self._follow(instrument, pose, sequence)
            left, right = self._servo.latest().hand_forces.tolist()
            self._device.feel((tuple(left), tuple(right)))
            if self._device.finished(now) and not over:
                self.say("info", f"The {self._device.name} hands have finished. Reset (R) begins anew.")
            over = self._device.finished(now)

    def _revive(self) -> None:
        if self._restarting is not None and self._restarting.is_alive():
            return
        reason = self._servo.exit_reason
        if self._restarts >= _RESTARTS:
            self.say(
                "stopped", f"The servo {reason} again. Forces are off: stop the trainer and start it anew."
            )
            return
        self._restarts += 1
        self.say("warning", f"The servo {reason}. Forces are off; it is being started again.")
        self._restarting = threading.Thread(target=self._restart, name="restart", daemon=True)
        self._restarting.start()

    def _restart(self) -> None:
        try:
            with self._changing:
                self._servo.restart()
        except TrocarError as error:
            self.say("warning", f"{error}.")
        else:
            self.say("info", "The servo runs again; the tissue is at rest.")
            self._began = time.monotonic()

    def _tell_of(self, flags: ServoFlag) -> None:
        for flag, (level, text) in _SENTENCES.items():
            if flag in flags and flag not in self._seen:
                self.say(level, text)
        self._seen = flags

    def say(self, level: Any, text: str) -> None:
        """Tell the user a sentence, unless it has just been told."""
        now = time.monotonic()
        if now - self._said.get(text, -_QUIET) >= _QUIET:
            self._said[text] = now
            self._notices.append(Notice(level=level, text=text))


def servo_of(stage: Stage) -> Servo:
    """Return what moves a stage's scene, not started."""
    return Servo(
        stage.scene, kind_of(stage.scene).at_rest(stage.scene), physics=stage.physics, smoothing=SMOOTHING
    )
