"""What is asked of the tables: every question as one function of a session, answered in plain values."""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import Any

from sqlalchemy import ColumnElement, Row, func, select
from sqlalchemy.orm import Session

from trocar.errors import InputError
from trocar.records.names import as_kept
from trocar.records.owner import is_gone
from trocar.records.rows import AttemptRow, KeptAttempt, Metric, Status, Trainee, moment
from trocar.records.sheets import Sheet
from trocar.records.tables import AnswerTable, AttemptTable, ChunkTable, MetricTable, TraineeTable

GONE = "its process ended without closing it"
"""Why an attempt is interrupted that nobody interrupted."""

_LISTED = (
    AttemptTable.id,
    TraineeTable.name.label("trainee"),
    AttemptTable.trainee_id,
    AttemptTable.task,
    AttemptTable.level,
    AttemptTable.device,
    AttemptTable.status,
    AttemptTable.reason,
    AttemptTable.began,
    AttemptTable.owner,
    AttemptTable.ticks,
    AttemptTable.dt_s,
    AttemptTable.score,
    AttemptTable.passed,
    AttemptTable.completed,
    AttemptTable.duration_s,
)


def trainees(session: Session, *which: ColumnElement[bool]) -> list[Trainee]:
    """Return trainees in the order in which they were first named, with how many attempts each has."""
    attempts = (
        select(func.count()).where(AttemptTable.trainee_id == TraineeTable.id).correlate(TraineeTable)
    ).scalar_subquery()
    asked = select(TraineeTable.id, TraineeTable.name, TraineeTable.began, attempts).where(*which)
    return [
        Trainee(id=number, name=name, began=moment(began), attempts=count)
        for number, name, began, count in session.execute(asked.order_by(TraineeTable.id))
    ]


def attempts(session: Session, *which: ColumnElement[bool]) -> list[AttemptRow]:
    """Return attempts, oldest first; no recording and no card is read for it."""
    asked = select(*_LISTED).join(TraineeTable, TraineeTable.id == AttemptTable.trainee_id).where(*which)
    return [_listed(row) for row in session.execute(asked.order_by(AttemptTable.id))]


def of(trainee: str | None, task: str | None, level: int | None) -> Iterable[ColumnElement[bool]]:
    """Yield the conditions for attempts of a trainee, a task, a level; None asks for all."""
    if trainee is not None:
        yield TraineeTable.name == as_kept(trainee)
    if task is not None:
        yield AttemptTable.task == task
    if level is not None:
        yield AttemptTable.level == level


def attempt(session: Session, number: int) -> KeptAttempt:
    """Return one attempt with its card.

    Raises:
        InputError: there is none of that number.
    """
    rows = attempts(session, AttemptTable.id == number)
    if not rows:
        raise no_attempt(session, number)
    header, card = session.execute(
        select(AttemptTable.header, AttemptTable.card).where(AttemptTable.id == number)
    ).one()
    return KeptAttempt(
        row=rows[0], header=json.loads(header), card=None if card is None else json.loads(card)
    )


def chunks(session: Session, number: int) -> list[bytes]:
    """Return a recording's pieces in order."""
    asked = select(ChunkTable.data).where(ChunkTable.attempt_id == number).order_by(ChunkTable.number)
    return list(session.scalars(asked))


def metrics(session: Session) -> dict[int, list[Metric]]:
    """Return the metrics of every attempt that has any, by the attempt's number."""
    found: dict[int, list[Metric]] = {}
    asked = select(MetricTable.attempt_id, MetricTable.name, MetricTable.value, MetricTable.unit)
    for number, name, value, unit in session.execute(asked.order_by(MetricTable.attempt_id)):
        found.setdefault(number, []).append(Metric(name=name, value=value, unit=unit))
    return found


def sheets(session: Session) -> list[Sheet]:
    """Return every questionnaire that was filled in, oldest first."""
    asked = (
        select(
            TraineeTable.name,
            AnswerTable.attempt_id,
            AnswerTable.group,
            AnswerTable.answered,
            AnswerTable.item,
            AnswerTable.value,
        )
        .join(TraineeTable, TraineeTable.id == AnswerTable.trainee_id)
        .order_by(AnswerTable.answered, AnswerTable.id)
    )
    together: dict[tuple[str, int | None, str, str], dict[str, int]] = {}
    for name, number, group, answered, item, value in session.execute(asked):
        together.setdefault((name, number, group, answered), {})[item] = value
    return [
        Sheet(trainee=name, attempt=number, group=group, values=values, answered=moment(answered))
        for (name, number, group, answered), values in together.items()
    ]


def no_attempt(session: Session, number: int) -> InputError:
    """Return what to say where there is no attempt of a number."""
    last = session.scalar(select(func.max(AttemptTable.id)))
    expected = "the number of an attempt" if last is None else f"the number of an attempt, at most {last}"
    return InputError("attempt", expected, number, "trocar records lists them")


def _listed(row: Row[*tuple[Any, ...]]) -> AttemptRow:
    gone = row.status == Status.RUNNING and is_gone(row.owner)
    return AttemptRow(
        id=row.id,
        trainee=row.trainee,
        trainee_id=row.trainee_id,
        task=row.task,
        level=row.level,
        device=row.device,
        status=Status.INTERRUPTED if gone else Status(row.status),
        reason=GONE if gone else row.reason,
        began=moment(row.began),
        duration=row.ticks * row.dt_s if row.duration_s is None else row.duration_s,
        score=row.score,
        passed=row.passed,
        completed=row.completed,
    )
