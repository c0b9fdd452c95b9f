"""Films for the page: attempts on record and the scripted expert's, in the frames of the live stream."""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Callable, Hashable
from dataclasses import dataclass

from trocar.errors import InputError
from trocar.records.rows import KeptAttempt, Status
from trocar.records.store import Records
from trocar.training.film import Film, film
from trocar.training.headless import attempt as attempt_of
from trocar.training.players import Skill
from trocar.training.session import Card, Recording
from trocar.training.strip import recorded
from trocar.training.tasks.catalogue import task as task_by_name
from trocar.training.tasks.task import Task
from trocar.web.source import Status as Shown
from trocar.web.stage import Stage, stage_of
from trocar.web.wire import encode

MOST_FRAMES = 100  # in one answer
_KEPT = 6  # films; a minute takes some 50 MB
_SEED = 1  # of the scripted expert


@dataclass(frozen=True, kw_only=True)
class Screening:
    """A film with the stage it is shown on.

    Attributes:
        task: that was attempted.
        stage: of the task.
        film: pictures.
        recording: they came out of.
        card: how it was marked, where that was found on the way.
    """

    task: Task
    stage: Stage
    film: Film
    recording: Recording
    card: Card | None = None

    def frames(self, first: int, count: int) -> bytes:
        """Return frames one after the other, as the live stream sends them; each is as long as the first.

        Args:
            first: number of the first, from 0.
            count: how many; fewer come at the end.

        Raises:
            InputError: the film has no such frame.
        """
        if not 0 <= first < len(self.film):
            raise InputError("film: first", f"0 to {len(self.film) - 1}", first)
        last = min(first + min(count, MOST_FRAMES), len(self.film))
        return b"".join(self._frame(number) for number in range(first, last))

    def _frame(self, number: int) -> bytes:
        time = (number + 1) * self.film.every
        snapshot = self.stage.snapshot(
            self.film.records[number],
            self.film.amplitudes[number],
            tick=round(time / self.recording.dt),
            time=time,
            status=Shown.ALIVE,
        )
        return encode(snapshot, number + 1)


class Films:
    """Make films when they are asked for, and keep the last few.

    Args:
        records: attempts are found there.
    """

    def __init__(self, records: Records) -> None:
        self._records = records
        self._kept: OrderedDict[Hashable, Screening] = OrderedDict()
        self._lock = threading.Lock()  # one is made at a time: it takes a whole core

    def of_attempt(self, kept: KeptAttempt) -> Screening:
        """Return the film of an attempt on record; of one that is under way, so far as it is kept now.

        Raises:
            InputError: nothing of it was recorded.
        """
        running = kept.row.status is Status.RUNNING
        key = (kept.row.id, kept.row.duration if running else None)
        return self._found(key, lambda: self._of_attempt(kept))

    def of_expert(self, name: str, level: int) -> Screening:
        """Return the film of the scripted expert at a task.

        Raises:
            InputError: there is no such task or level.
        """
        task = task_by_name(name, level)
        return self._found((name, level), lambda: _of_expert(task))

    def _of_attempt(self, kept: KeptAttempt) -> Screening:
        task = task_by_name(kept.row.task, kept.row.level)
        recording = recorded(*self._records.chunks(kept.row.id))
        if len(recording.poses) == 0:
            raise InputError(
                f"attempt {kept.row.id}", "one with a recording", "one of which nothing was recorded"
            )
        return Screening(task=task, stage=stage_of(task), film=film(task, recording), recording=recording)

    def _found(self, key: Hashable, make: Callable[[], Screening]) -> Screening:
        with self._lock:
            if key not in self._kept:
                self._kept[key] = make()
                while len(self._kept) > _KEPT:
                    self._kept.popitem(last=False)
            self._kept.move_to_end(key)
            return self._kept[key]


def _of_expert(task: Task) -> Screening:
    done = attempt_of(task.name, level=task.level, skill=Skill.EXPERT, seed=_SEED)
    shown = film(task, done.recording)
    return Screening(task=task, stage=stage_of(task), film=shown, recording=done.recording, card=done.card)
