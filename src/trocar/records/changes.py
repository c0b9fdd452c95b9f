"""What is written into the tables: every change as one function of a session, which a transaction surrounds."""

from __future__ import annotations

import json
from collections.abc import Mapping
from math import isfinite
from typing import TYPE_CHECKING

from sqlalchemy import delete, func, insert, select, text, update
from sqlalchemy.orm import Session

from trocar.errors import InputError
from trocar.records import reading
from trocar.records.owner import is_gone, this_process
from trocar.records.questionnaire import check_answers
from trocar.records.rows import Status, Trainee, now
from trocar.records.tables import AnswerTable, AttemptTable, ChunkTable, MetricTable, TraineeTable

if TYPE_CHECKING:
    from trocar.training.session import Card

_LAST_REMOVED = text("SELECT seq FROM sqlite_sequence WHERE name = 'trainee'")


def trainee(session: Session, name: str) -> Trainee:
    """Return the trainee of a name, new or not."""
    known = reading.trainees(session, TraineeTable.name == name)
    if known:
        return known[0]
    given = [session.scalar(select(func.max(TraineeTable.id))), session.scalar(_LAST_REMOVED)]
    number = 1 + max((last for last in given if last is not None), default=0)
    session.execute(insert(TraineeTable).values(id=number, name=name, began=now()))
    return reading.trainees(session, TraineeTable.name == name)[0]


def rename(session: Session, old: str, new: str) -> Trainee:
    """Give a trainee a name that nobody has."""
    found = _idle(session, old)
    if new == found.name:
        return found
    if reading.trainees(session, TraineeTable.name == new):
        advice = "trainees cannot be joined; choose another name"
        raise InputError("rename", "a name that nobody has", new, advice)
    session.execute(update(TraineeTable).where(TraineeTable.id == found.id).values(name=new))
    return reading.trainees(session, TraineeTable.id == found.id)[0]


def remove(session: Session, name: str) -> int:
    """Remove a trainee and all there is of them, and say how many attempts there were.

    The largest number that was removed is remembered, in SQLite's own table of such, so that it is never given again.
    """
    found = _idle(session, name)
    theirs = select(AttemptTable.id).where(AttemptTable.trainee_id == found.id)
    session.execute(
        delete(AnswerTable).where((AnswerTable.trainee_id == found.id) | AnswerTable.attempt_id.in_(theirs))
    )
    for table in (ChunkTable, MetricTable):
        session.execute(delete(table).where(table.attempt_id.in_(theirs)))
    session.execute(delete(AttemptTable).where(AttemptTable.trainee_id == found.id))
    session.execute(delete(TraineeTable).where(TraineeTable.id == found.id))
    last = max(found.id, session.scalar(_LAST_REMOVED) or 0)
    session.execute(text("DELETE FROM sqlite_sequence WHERE name = 'trainee'"))
    session.execute(text("INSERT INTO sqlite_sequence (name, seq) VALUES ('trainee', :last)"), {"last": last})
    return found.attempts


def _idle(session: Session, name: str) -> Trainee:
    """Return the trainee of a name, with no attempt under way."""
    known = reading.trainees(session, TraineeTable.name == name)
    if not known:
        raise InputError("trainee", "one that has records", name)
    rows = reading.attempts(session, AttemptTable.trainee_id == known[0].id)
    for row in (row for row in rows if row.status is Status.RUNNING):
        raise InputError(
            f"trainee {name}", "no attempt under way", f"attempt {row.id}", "end it first: trocar records"
        )
    return known[0]


def described(header: Mapping[str, object]) -> str:
    """Return what describes a recording as it is kept.

    Raises:
        InputError: JSON cannot take it.
    """
    try:
        return json.dumps(dict(header), allow_nan=False)
    except (TypeError, ValueError) as error:
        raise InputError("attempt: header", "what JSON takes", header, str(error)) from None


def begin(
    session: Session,
    trainee: Trainee,
    *,
    task: str,
    level: int,
    device: str,
    header: Mapping[str, object],
    dt: float,
) -> int:
    """Begin an attempt of this process and return its number; `Records.begin` says what is what."""
    if not (isfinite(dt) and dt > 0):
        raise InputError("attempt: dt", "a finite number of seconds above 0", dt)
    begun = AttemptTable(
        trainee_id=trainee.id,
        task=task,
        level=level,
        device=device,
        status=Status.RUNNING.value,
        began=now(),
        owner=this_process(),
        ticks=0,
        dt_s=dt,
        header=described(header),
    )
    session.add(begun)
    session.flush()
    return begun.id


def add(session: Session, number: int, data: bytes, ticks: int) -> None:
    """Add a piece to the recording of an attempt that runs."""
    if not data or ticks < 1:
        raise InputError("attempt: piece", "at least one byte and one tick", (len(data), ticks))
    change(session, number, ticks=AttemptTable.ticks + ticks)
    after = select(func.coalesce(func.max(ChunkTable.number) + 1, 0)).where(ChunkTable.attempt_id == number)
    session.execute(
        insert(ChunkTable).values(
            attempt_id=number, number=session.scalar(after), ticks=ticks, data=bytes(data)
        )
    )


def finish(session: Session, number: int, card: Card, device: str | None = None) -> None:
    """Close an attempt that runs with its score card; metrics that do not exist are left out."""
    row = reading.attempt(session, number).row
    if (row.task, row.level) != (card.task, card.level):
        expected = f"one of {row.task}, level {row.level}, as the attempt"
        raise InputError(f"attempt {number}: card", expected, f"{card.task}, level {card.level}")
    shown = card.as_dict()
    change(
        session,
        number,
        status=Status.FINISHED.value,
        score=card.score,
        passed=card.passed,
        completed=card.completed,
        duration_s=card.duration,
        card=json.dumps(shown, allow_nan=False),
        **_moved_by(device),
    )
    metrics = shown["metrics"]
    assert isinstance(metrics, dict)
    session.add_all(
        MetricTable(attempt_id=number, name=name, value=each["value"], unit=each["unit"])
        for name, each in metrics.items()
    )


def interrupt(session: Session, number: int, reason: str, device: str | None = None) -> None:
    """Close an attempt that runs and will not be finished."""
    change(session, number, status=Status.INTERRUPTED.value, reason=reason, **_moved_by(device))


def _moved_by(device: str | None) -> dict[str, object]:
    return {} if device is None else {"device": device}


def answer(
    session: Session, trainee: Trainee, number: int | None, group: str, values: Mapping[str, int]
) -> None:
    """Keep answers that were given together."""
    check_answers(group, values)
    if number is not None:
        row = reading.attempt(session, number).row
        if row.trainee_id != trainee.id:
            raise InputError("answers: attempt", f"one of {trainee.name}'s", f"{row.trainee}'s")
    answered = now()
    session.add_all(
        AnswerTable(
            trainee_id=trainee.id,
            attempt_id=number,
            group=group,
            item=item,
            value=value,
            answered=answered,
        )
        for item, value in values.items()
    )


def change(session: Session, number: int, **values: object) -> None:
    """Change an attempt that runs, and refuse any other."""
    running = AttemptTable.status == Status.RUNNING.value
    changed = session.execute(
        update(AttemptTable)
        .where(AttemptTable.id == number, running)
        .values(**values)
        .returning(AttemptTable.id)
        .execution_options(synchronize_session=False)
    ).scalar()
    if changed is None:
        status = reading.attempt(session, number).row.status
        raise InputError(f"attempt {number}", "one that runs", status.value, "begin another one")


def close_abandoned(session: Session) -> str:
    """Mark attempts whose process has ended as interrupted, and say how many there were."""
    running = select(AttemptTable.id, AttemptTable.owner).where(AttemptTable.status == Status.RUNNING.value)
    gone = [number for number, owner in session.execute(running) if is_gone(owner)]
    for number in gone:
        change(session, number, status=Status.INTERRUPTED.value, reason=reading.GONE)
    if not gone:
        return ""
    return (
        f"Attempt {gone[0]} is interrupted: its process has ended."
        if len(gone) == 1
        else f"Attempts {', '.join(map(str, gone))} are interrupted: their processes have ended."
    )
