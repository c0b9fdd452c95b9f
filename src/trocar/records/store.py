"""The records: whoever trains, every attempt from its beginning on, and what people think of the trainer.

An attempt is kept while it goes on. `begin` gives it a number, each `add` is on the disk when it returns, and `finish`
or `interrupt` closes it; one that nobody closed because its process died is interrupted, with all that was added.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Self

from sqlalchemy import Engine, create_engine
from sqlalchemy.orm import Session
from sqlalchemy.pool import StaticPool

from trocar.records import changes, reading
from trocar.records.database import (
    PATIENCE,
    clear_out,
    engine_for_reading,
    engine_for_writing,
    use_write_ahead,
    writes,
)
from trocar.records.folder import FILE, check_folder, make_folder, records_folder
from trocar.records.learning import History
from trocar.records.names import as_kept, scripted_name, trainee_name
from trocar.records.rows import AttemptRow, KeptAttempt, Metric, Status, Trainee
from trocar.records.schema import NEWEST, WITH_ANSWERS, bring_up, version
from trocar.records.sheets import Sheet
from trocar.records.tables import AttemptTable, Table
from trocar.records.trouble import RecordsError, told

if TYPE_CHECKING:
    from trocar.training.session import Card


class Records:
    """The records of one folder; any number of threads may use them at once. Made by `Records.open`."""

    def __init__(self, path: Path, engine: Engine, *, writing: bool, note: str = "") -> None:
        self.path = path
        """Of the file."""
        self.note = note
        """What opening did, as sentences; empty if nothing."""
        self._engine = engine
        self._writes = writes(engine) if writing else None

    @classmethod
    def open(
        cls,
        folder: str | os.PathLike[str] | None = None,
        *,
        writing: bool = True,
        patience: float = PATIENCE,
    ) -> Self:
        """Open the records of a folder.

        For writing, the folder and the file are made where they are missing, an older file is brought to the newest
        schema after a copy of it was put beside it, and attempts whose process has ended are marked as interrupted.
        For reading, nothing is made or changed; where there are no records, there are none to list.

        Args:
            folder: they lie in; None takes `TROCAR_DATA` or the platform's place.
            writing: whether anything is to be kept.
            patience: how long another process may hold the file [s].

        Raises:
            InputError: the folder is a file.
            RecordsError: they cannot be opened; the sentence says why and what to do.
        """
        place = records_folder() if folder is None else Path(folder)
        path = place / FILE
        check_folder(place)
        reader = cls(path, engine_for_reading(path, patience), writing=False)
        with reader._reading():  # refuses another's file, or a newer Trocar's, before anything touches it
            pass
        if not writing:
            return reader
        make_folder(place)
        use_write_ahead(path, patience)
        engine = engine_for_writing(path, patience)
        try:
            with told(path), writes(engine).begin() as connection:
                notes = [bring_up(connection, path, patience)]
                with Session(connection) as session:
                    notes.append(changes.close_abandoned(session))
        except BaseException:
            engine.dispose()
            raise
        return cls(path, engine, writing=True, note=" ".join(note for note in notes if note))

    def close(self) -> None:
        """Let go of the file. Attempts that run stay so."""
        self._engine.dispose()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    # What is kept.

    def trainee(self, name: str) -> Trainee:
        """Return the person of that name, who is from now on known.

        Raises:
            InputError: nobody can be called so.
            RecordsError: nothing can be written.
        """
        kept = trainee_name(name)
        with self._writing() as session:
            return changes.trainee(session, kept)

    def scripted_trainee(self, skill: str) -> Trainee:
        """Return the scripted trainee of a skill, whose name `trainee` gives to nobody.

        Raises:
            RecordsError: nothing can be written.
        """
        with self._writing() as session:
            return changes.trainee(session, scripted_name(skill))

    def begin(
        self,
        trainee: Trainee,
        *,
        task: str,
        level: int,
        device: str,
        header: Mapping[str, object],
        dt: float,
    ) -> int:
        """Begin an attempt and return its number; it runs as long as this process does.

        Args:
            trainee: who attempts.
            task: name.
            level: of it.
            device: what moves the instruments.
            header: what describes the recording, as JSON takes it.
            dt: length of a tick [s].

        Raises:
            InputError: the header is nothing that JSON takes, or dt is no length.
            RecordsError: nothing can be written.
        """
        with self._writing() as session:
            return changes.begin(
                session, trainee, task=task, level=level, device=device, header=header, dt=dt
            )

    def add(self, attempt: int, data: bytes, ticks: int) -> None:
        """Add a piece to an attempt's recording; when this returns it is on the disk, whatever happens.

        Args:
            attempt: number of one that runs.
            data: the piece, in whatever form the recording has.
            ticks: how many there are in it.

        Raises:
            InputError: the attempt does not run, or the piece is empty.
            RecordsError: nothing can be written; the piece may be added again later.
        """
        with self._writing() as session:
            changes.add(session, attempt, data, ticks)

    def finish(self, attempt: int, card: Card, *, device: str | None = None) -> None:
        """Close an attempt with its score card.

        Args:
            attempt: number of one that runs.
            card: of the same task and level.
            device: what moved the instruments, where that is another than was said at the beginning.

        Raises:
            InputError: the attempt does not run, or the card is of another task or level.
            RecordsError: nothing can be written; the attempt still runs.
        """
        with self._writing() as session:
            changes.finish(session, attempt, card, device)

    def interrupt(self, attempt: int, reason: str, *, device: str | None = None) -> None:
        """Close an attempt that will not be finished; what was added to it stays.

        Args:
            attempt: number of one that runs.
            reason: why, in words.
            device: as in `finish`.

        Raises:
            InputError: the attempt does not run.
            RecordsError: nothing can be written.
        """
        with self._writing() as session:
            changes.interrupt(session, attempt, reason, device)

    def answer(self, trainee: Trainee, attempt: int | None, group: str, values: Mapping[str, int]) -> None:
        """Keep the answers a trainee gave together.

        Args:
            trainee: who answers.
            attempt: after which; None after a course.
            group: what the trainee is, one of `trocar.records.questionnaire.GROUPS`.
            values: by item, 1 to 5.

        Raises:
            InputError: that was not asked, or the attempt is not this trainee's.
            RecordsError: nothing can be written.
        """
        with self._writing() as session:
            changes.answer(session, trainee, attempt, group, values)

    def rename(self, old: str, new: str) -> Trainee:
        """Give a trainee another name, and return the trainee.

        Raises:
            InputError: nobody has the old name, somebody has the new one or nobody can, or an attempt is under way.
            RecordsError: nothing can be written.
        """
        kept = trainee_name(new)
        with self._writing() as session:
            return changes.rename(session, as_kept(old), kept)

    def remove(self, name: str) -> int:
        """Remove a trainee with attempts, metrics, recordings and answers, all or nothing; return how many attempts.

        Raises:
            InputError: nobody has that name, or an attempt of theirs is under way.
            RecordsError: nothing can be written.
        """
        with self._writing() as session:
            return changes.remove(session, as_kept(name))

    def give_back_space(self) -> None:
        """Write the file anew without what was removed: until then it can still be read there.

        Raises:
            RecordsError: another process is at it, or there is no room for a second file; try again later.
        """
        with told(self.path):
            clear_out(self._engine, self.path)

    def older_copies(self) -> list[Path]:
        """Return the files kept beside this one when it was brought to a newer schema."""
        return sorted(self.path.parent.glob(f"{self.path.name}.schema-*"))

    # What is asked.

    def trainees(self) -> list[Trainee]:
        """Return everyone who trains, in the order in which they came."""
        with self._reading() as session:
            return reading.trainees(session)

    def attempts(
        self, trainee: str | None = None, task: str | None = None, level: int | None = None
    ) -> list[AttemptRow]:
        """Return attempts, oldest first.

        Args:
            trainee: name; None asks for everyone's.
            task: name; None asks for all.
            level: None asks for all.
        """
        with self._reading() as session:
            return reading.attempts(session, *reading.of(trainee, task, level))

    def attempt(self, number: int) -> KeptAttempt:
        """Return one attempt with its card.

        Raises:
            InputError: there is none of that number.
        """
        with self._reading() as session:
            return reading.attempt(session, number)

    def chunks(self, number: int) -> tuple[Mapping[str, object], list[bytes]]:
        """Return what describes an attempt's recording, and its pieces in the order in which they were added.

        Raises:
            InputError: there is no attempt of that number.
        """
        with self._reading() as session:
            return reading.attempt(session, number).header, reading.chunks(session, number)

    def metrics(self) -> dict[int, list[Metric]]:
        """Return the metrics of every finished attempt, by its number."""
        with self._reading() as session:
            return reading.metrics(session)

    def answers(self) -> list[Sheet]:
        """Return every questionnaire that was filled in, oldest first."""
        with self._reading() as session:
            return reading.sheets(session) if session.info["schema"] >= WITH_ANSWERS else []

    def history(self, trainee: str, task: str, level: int = 1) -> History:
        """Return a trainee's way through a task at a level: what was finished, in order."""
        finished = AttemptTable.status == Status.FINISHED.value
        with self._reading() as session:
            rows = reading.attempts(session, finished, *reading.of(trainee, task, level))
        return History(trainee=trainee, task=task, level=level, rows=tuple(rows))

    @contextmanager
    def _writing(self) -> Iterator[Session]:
        if self._writes is None:
            raise RecordsError(f"{self.path}: expected records opened for writing, got some for reading")
        with told(self.path), Session(self._writes) as session, session.begin():
            yield session

    @contextmanager
    def _reading(self) -> Iterator[Session]:
        with told(self.path):
            if _is_there(self.path):
                with Session(self._engine) as session:
                    schema = version(session.connection(), self.path)
                    if schema is not None:
                        session.info["schema"] = schema
                        yield session
                        return
            nothing = create_engine("sqlite://", poolclass=StaticPool)
            Table.metadata.create_all(nothing)
            try:
                with Session(nothing, info={"schema": NEWEST}) as session:
                    yield session
            finally:
                nothing.dispose()


def _is_there(path: Path) -> bool:
    try:
        return path.exists()
    except OSError as error:  # a folder that may not be looked into
        raise RecordsError(
            f"{path}: expected a folder that can be looked into, got {error.strerror or error}; "
            "change its permissions, or set TROCAR_DATA to another"
        ) from None
