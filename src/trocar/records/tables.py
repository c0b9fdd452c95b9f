"""The tables of the newest schema, as SQLAlchemy maps them.

What a list of attempts needs stands in short columns of `attempt`, before its two long ones; recordings lie in a table
of their own. SQLite reads a row up to the last column that is asked for, so no list ever touches a recording.
"""

from __future__ import annotations

from typing import Any, ClassVar

from sqlalchemy import Float, ForeignKey, Index, MetaData, UniqueConstraint
from sqlalchemy.orm import DeclarativeBase, Mapped, mapped_column


class Table(DeclarativeBase):
    """What all tables share."""

    metadata = MetaData()
    """All of them."""

    type_annotation_map: ClassVar[dict[Any, Any]] = {float: Float}  # eight bytes in SQLite, whatever the name


class TraineeTable(Table):
    """Who trains."""

    __tablename__ = "trainee"

    id: Mapped[int] = mapped_column(primary_key=True)
    name: Mapped[str] = mapped_column(unique=True)
    began: Mapped[str]


class AttemptTable(Table):
    """Each attempt, from its beginning on."""

    __tablename__ = "attempt"

    id: Mapped[int] = mapped_column(primary_key=True)
    trainee_id: Mapped[int] = mapped_column(ForeignKey("trainee.id"))
    task: Mapped[str]
    level: Mapped[int]
    device: Mapped[str]
    status: Mapped[str]
    reason: Mapped[str | None]
    began: Mapped[str]
    owner: Mapped[str]
    ticks: Mapped[int]
    dt_s: Mapped[float]
    score: Mapped[float | None]
    passed: Mapped[bool | None]
    completed: Mapped[bool | None]
    duration_s: Mapped[float | None]
    header: Mapped[str]
    card: Mapped[str | None]

    __table_args__ = (
        Index("attempt_of_trainee", "trainee_id", "task", "level"),
        Index("attempt_by_status", "status"),
        {"sqlite_autoincrement": True},  # an id that was given is never given again
    )


class MetricTable(Table):
    """The metrics of finished attempts that exist."""

    __tablename__ = "metric"

    attempt_id: Mapped[int] = mapped_column(ForeignKey("attempt.id"), primary_key=True)
    name: Mapped[str] = mapped_column(primary_key=True)
    value: Mapped[float]
    unit: Mapped[str]


class ChunkTable(Table):
    """Recordings, piece by piece as they were made."""

    __tablename__ = "chunk"

    attempt_id: Mapped[int] = mapped_column(ForeignKey("attempt.id"), primary_key=True)
    number: Mapped[int] = mapped_column(primary_key=True)
    ticks: Mapped[int]
    data: Mapped[bytes]


class AnswerTable(Table):
    """What trainees think of the trainer, item by item. Since schema 0002."""

    __tablename__ = "answer"

    id: Mapped[int] = mapped_column(primary_key=True)
    trainee_id: Mapped[int] = mapped_column(ForeignKey("trainee.id"))
    attempt_id: Mapped[int | None] = mapped_column(ForeignKey("attempt.id"))
    group: Mapped[str]
    item: Mapped[str]
    value: Mapped[int]
    answered: Mapped[str]

    __table_args__ = (
        UniqueConstraint("trainee_id", "attempt_id", "item", "answered", name="answer_once"),
        Index("answer_of_attempt", "attempt_id"),
    )
