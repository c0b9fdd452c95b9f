"""Attempts at the live trainer: one at a time, from the choice of a task to the score card in the records.

An attempt is followed in a thread of its own. It ends when every step is done, when the time is up or when the trainee
says so, and is then marked from what was recorded; what ends otherwise stays in the records as interrupted.
"""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from trocar.errors import InputError, TrocarError
from trocar.records.store import Records
from trocar.records.trouble import RecordsError
from trocar.simulation import DT
from trocar.training.live import MARKED, Ending, Guidance, LiveAttempt
from trocar.training.session import Card, assess
from trocar.training.strip import header
from trocar.training.tasks.catalogue import task as task_by_name
from trocar.training.tasks.task import Task
from trocar.web.asking import asking
from trocar.web.messages import Guiding, State
from trocar.web.stage import stage_of
from trocar.web.trainer import HEADSET, Trainer

LOOK_EVERY = 0.04  # [s]
_TRIED_AGAIN = 2.0  # [s] between tries to put an attempt on record
_SERVO_BACK = 30.0  # [s] for a servo that died and is being started again
_TOLD_EVERY = 0.1  # [s] of what changes steadily
_TOLD_AFTER = 3.0  # [s] of setting a task's scene up
_SETTING_UP = "The task's tissue is being set up; the first time its code is compiled, a minute or two."
_SET_UP = "The task's tissue is ready."
_SHOWN_AFTERWARDS = 5.0  # [s] that the end of an attempt is told to pages that come
_LOG = logging.getLogger(__name__)


class BusyError(TrocarError):
    """Another attempt is under way."""


@dataclass(frozen=True, kw_only=True)
class _Lesson:
    number: int
    live: LiveAttempt
    thread: threading.Thread
    stop: threading.Event
    closed: threading.Event


class Lessons:
    """What a trainee does at the trainer.

    Args:
        trainer: running; its stage is changed to a task's where that is another.
        records: open for writing.
    """

    def __init__(self, trainer: Trainer, records: Records) -> None:
        self._trainer, self.records = trainer, records
        self._lesson: _Lesson | None = None
        self._lock = threading.Lock()
        self._closing = threading.Event()

    def begin(self, trainee: str, name: str, level: int) -> int:
        """Begin an attempt and return the number of its record; the task's scene is at rest then.

        Raises:
            InputError: there is no such task or level, or nobody can be called so.
            BusyError: another attempt is under way.
            TrocarError: nothing can be recorded, or the scene could not be set up.
        """
        task = task_by_name(name, level)
        if not self._lock.acquire(blocking=False):
            raise BusyError("the trainer: another attempt is just beginning")
        try:
            if self._lesson is not None and not self._lesson.closed.is_set():
                raise BusyError(f"the trainer: attempt {self._lesson.number} is under way; end it first")
            self._set_up(task)
            servo = self._trainer.servo
            number = self.records.begin(
                self.records.trainee(trainee),
                task=task.name,
                level=level,
                device=self._trainer.device_name,
                header=header(DT, servo.following),
                dt=DT,
            )
            live = LiveAttempt(task, servo, lambda data, ticks: self.records.add(number, data, ticks))
            self._trainer.begin_device()
            stop, closed = threading.Event(), threading.Event()
            thread = threading.Thread(target=self._follow, args=(number, live, stop, closed), name="lesson")
            self._lesson = _Lesson(number=number, live=live, thread=thread, stop=stop, closed=closed)
            thread.start()
            return number
        finally:
            self._lock.release()

    def end(self, number: int) -> None:
        """End an attempt as it stands; it is marked like any other.

        Raises:
            InputError: it is not under way.
        """
        lesson = self._lesson
        if lesson is None or lesson.number != number or lesson.closed.is_set():
            raise InputError("attempt", "the one that is under way", number)
        lesson.live.give_up()

    def close(self) -> None:
        """Interrupt what is under way; what was done of it is kept."""
        self._closing.set()
        lesson = self._lesson
        if lesson is not None:
            lesson.stop.set()
            lesson.thread.join(10.0)

    def _set_up(self, task: Task) -> None:
        if not self._trainer.stage.suits(task):
            with self._told_if_long():
                self._trainer.enter(stage_of(task))
        end = time.monotonic() + _SERVO_BACK
        while not self._trainer.runs:
            if time.monotonic() > end:
                raise TrocarError("the trainer: its servo does not run; stop the trainer and start it anew")
            time.sleep(LOOK_EVERY)

    @contextmanager
    def _told_if_long(self) -> Iterator[None]:
        """Say what takes so long, if it does, and when it is over."""
        began = time.monotonic()
        telling = threading.Timer(_TOLD_AFTER, self._trainer.say, ("info", _SETTING_UP))
        telling.start()
        try:
            yield
        finally:
            telling.cancel()
        if time.monotonic() - began > _TOLD_AFTER:
            self._trainer.say("info", _SET_UP)

    def _follow(self, number: int, live: LiveAttempt, stop: threading.Event, closed: threading.Event) -> None:
        """Be an attempt's thread."""
        told = -_TOLD_EVERY
        guidance = live.look()

        def tell(state: State, reason: str = "") -> None:
            self._trainer.guide(_guiding(number, live.task, guidance, state, reason))

        before: Guidance | None = None
        device = self._trainer.device_name
        while guidance.ending is Ending.NOT_YET and not stop.wait(LOOK_EVERY):
            guidance = live.look()
            if device != HEADSET:  # somebody may enter a headset, or leave it, meanwhile
                device = self._trainer.device_name
            if guidance.time - told >= _TOLD_EVERY or before is None or _differ(before, guidance):
                told, before = guidance.time, guidance
                tell("running")
        if guidance.ending is Ending.NOT_YET:
            live.give_up()  # the last of it is kept; it is not marked, for nobody wanted it to end
        if guidance.ending in MARKED:
            tell("marking")
        state, reason = self._close(number, live, guidance, device, tell)
        closed.set()
        tell(state, reason)
        self._closing.wait(_SHOWN_AFTERWARDS)
        if self._lesson is not None and self._lesson.number == number:
            self._trainer.guide(None)

    def _close(
        self,
        number: int,
        live: LiveAttempt,
        guidance: Guidance,
        device: str,
        tell: Callable[[State, str], None],
    ) -> tuple[State, str]:
        """Mark an attempt that is over, or say why it cannot be; return how it stands and why.

        What cannot be put on record, as on a full disk, is said and tried again until it can: nothing is lost while
        the trainer runs.
        """
        reason, card = str(guidance.ending) or "the trainer stopped", None
        if guidance.ending in MARKED:
            try:
                card = assess(live.task, live.recording)
            except InputError:
                reason = "nobody held an instrument"
            except Exception:  # noqa: BLE001 - a fault of ours must not leave the page waiting
                _LOG.exception("attempt %d could not be marked", number)
                reason = "it could not be marked"
        while (trouble := self._kept(number, live, card, reason, device)) is not None:
            tell("marking", trouble)
            if self._closing.wait(_TRIED_AGAIN):
                _LOG.warning("attempt %d: %s", number, trouble)
                return "interrupted", trouble
        return ("interrupted" if card is None else "finished"), reason

    def _kept(
        self, number: int, live: LiveAttempt, card: Card | None, reason: str, device: str
    ) -> str | None:
        """Put the end of an attempt on record; return what hinders it, if anything does."""
        trouble = live.look().trouble  # the last of the strip first
        if trouble:
            return trouble
        try:
            if card is not None:
                self.records.finish(number, card, device=device)
            else:
                self.records.interrupt(number, reason, device=device)
        except RecordsError as error:
            return str(error)
        return None


def _differ(one: Guidance, other: Guidance) -> bool:
    return (one.number, one.hint, one.mistakes, one.trouble) != (
        other.number,
        other.hint,
        other.mistakes,
        other.trouble,
    )


def _guiding(number: int, task: Task, guidance: Guidance, state: State, reason: str) -> Guiding:
    done = guidance.number >= len(task.steps)
    return Guiding(
        attempt=number,
        state=state,
        step=guidance.number,
        **asking(None if done else task.steps[guidance.number]),
        hint=guidance.hint,
        mistakes=guidance.mistakes,
        mistake=guidance.mistake,
        time_s=guidance.time,
        left_s=max(task.marking.cutoff - guidance.time, 0.0),
        reason=reason or guidance.trouble,
    )
