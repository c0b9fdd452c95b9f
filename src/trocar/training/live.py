"""An attempt as it happens: the servo's trail is followed, the trainee told what to do, and every tick kept.

The task sees what the servo wrote, tick by tick; since playing the kept poses again gives the same bits, the guidance
of the moment and the score card that follows agree. What cannot be kept for a while, as on a full disk, stays in
memory and is tried again.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from threading import Lock

import numpy as np

from trocar.errors import TrocarError
from trocar.model import FloatArray
from trocar.realtime.servo import Servo, ServoFlag
from trocar.realtime.trail import Ticks, read_trail
from trocar.simulation import DT
from trocar.training.session import LONGEST, Recording
from trocar.training.strip import KEEP_EVERY, Piece, joined, write_piece
from trocar.training.tasks.moment import Moment
from trocar.training.tasks.progress import Progress
from trocar.training.tasks.task import Task


class Ending(StrEnum):
    """Why an attempt is over."""

    NOT_YET = ""
    DONE = "every step was done"
    OUT_OF_TIME = "the time was up"
    GIVEN_UP = "the trainee ended it"
    FAULT = "a number in the tissue was not finite"
    NO_SERVO = "the servo ended"
    LOST = "ticks were lost"


MARKED = (Ending.DONE, Ending.OUT_OF_TIME, Ending.GIVEN_UP)
"""Endings after which there is a score card; after the others an attempt was interrupted."""


@dataclass(frozen=True, kw_only=True)
class Guidance:
    """What a trainee is told.

    Attributes:
        number: of the step that is on, from 0; as many as there are when all is done.
        hint: what would bring it nearer.
        mistakes: how many so far.
        mistake: the last one.
        time: since the attempt began [s].
        ending: why it is over, if it is.
        trouble: why the newest ticks are not kept yet, if they are not.
    """

    number: int
    hint: str
    mistakes: int
    mistake: str
    time: float
    ending: Ending
    trouble: str


class LiveAttempt:
    """Follow an attempt at a task from rest to its end; to be looked at every 50 ms or so.

    Args:
        task: what is attempted.
        servo: that moves the task's scene; it is put to rest.
        keep: takes each piece of the strip and how many ticks it holds; what it raises as `TrocarError` is told, and
            the piece brought again.
    """

    def __init__(self, task: Task, servo: Servo, keep: Callable[[bytes, int], None]) -> None:
        self.task = task
        self._servo, self._keep = servo, keep
        self._trail = servo.trail
        self._limit = min(LONGEST, task.marking.cutoff)
        self._progress = Progress(task)
        self._next = int(self._trail.written[0])
        self._under_way = False
        self._missed = 0
        self._pieces: list[Piece] = []
        self._poses: list[FloatArray] = []
        self._unkept: list[Piece] = []
        self._ticks = 0
        self._ending = Ending.NOT_YET
        self._trouble = ""
        self._lock = Lock()
        servo.reset()

    def look(self) -> Guidance:
        """Take what the servo did since the last look, and say what to do now."""
        with self._lock:
            if self._ending is Ending.NOT_YET:
                self._take(read_trail(self._trail, self._next))
            over = self._ending is not Ending.NOT_YET
            if over or sum(map(len, self._unkept)) * DT >= KEEP_EVERY:
                self._store()
            return self._guidance()

    def give_up(self) -> None:
        """End the attempt as it stands; calling it again does nothing."""
        with self._lock:
            if self._ending is Ending.NOT_YET:
                self._take(read_trail(self._trail, self._next))
            if self._ending is Ending.NOT_YET:
                self._ending = Ending.GIVEN_UP
            self._store()

    @property
    def recording(self) -> Recording:
        """What was done so far."""
        with self._lock:
            whole = joined(self._pieces)
            poses = np.concatenate(self._poses) if self._poses else whole.targets
        resets = np.flatnonzero(whole.began)[1:]
        return Recording(
            poses=poses, dt=DT, resets=tuple(resets.tolist()), skipped=int(whole.skipped[1:].sum())
        )

    def _take(self, ticks: Ticks) -> None:
        self._next = ticks.first + len(ticks)
        first = 0
        if not self._under_way:
            begins = np.flatnonzero(ticks.began)
            if len(begins):
                self._under_way, first = True, int(begins[-1])
                self._missed = int(ticks.missed[first])
        if self._under_way:
            if ticks.lost:
                self._ending = Ending.LOST
                return
            count = self._advance(ticks.records[first:])
            self._note(ticks, slice(first, first + count))
        if self._ending is Ending.NOT_YET:
            if self._servo.trail is not self._trail or not self._servo.alive:
                self._ending = Ending.NO_SERVO
            elif ServoFlag.FAULT in self._servo.latest().flags and self._under_way:
                self._ending = Ending.FAULT

    def _advance(self, records: FloatArray) -> int:
        """Let the task see new ticks; return how many until it was over."""
        for count, both in enumerate(records, 1):
            moment = Moment(DT * (self._ticks + count), both)
            self._progress.advance(moment)
            if self._progress.done:
                self._ending = Ending.DONE
                return count
            if moment.time >= self._limit:
                self._ending = Ending.OUT_OF_TIME
                return count
        return len(records)

    def _note(self, ticks: Ticks, which: slice) -> None:
        missed = ticks.missed[which]
        if len(missed) == 0:
            return
        piece = Piece(
            targets=ticks.targets[which].copy(),
            began=ticks.began[which].copy(),
            skipped=np.diff(missed, prepend=self._missed),
        )
        self._missed = int(missed[-1])
        self._ticks += len(piece)
        self._pieces.append(piece)
        self._unkept.append(piece)
        self._poses.append(ticks.poses[which].copy())

    def _store(self) -> None:
        if not self._unkept:
            return
        piece = joined(self._unkept)
        try:
            self._keep(write_piece(piece), len(piece))
        except TrocarError as error:
            self._trouble = str(error)
        else:
            self._unkept.clear()
            self._trouble = ""

    def _guidance(self) -> Guidance:
        progress = self._progress
        mistakes = progress.mistakes
        return Guidance(
            number=progress.number,
            hint=progress.now,
            mistakes=len(mistakes),
            mistake=mistakes[-1].words if mistakes else "",
            time=DT * self._ticks,
            ending=self._ending,
            trouble=self._trouble,
        )
