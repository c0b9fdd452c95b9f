"""What is read out of the records: trainees and attempts, as plain values."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from enum import StrEnum
from typing import Any


class Status(StrEnum):
    """How an attempt stands."""

    RUNNING = "running"
    FINISHED = "finished"
    INTERRUPTED = "interrupted"


@dataclass(frozen=True, kw_only=True)
class Trainee:
    """Who trains.

    Attributes:
        id: number, never given again.
        name: as it is shown.
        began: when the trainee was first named.
        attempts: how many there are.
    """

    id: int
    name: str
    began: datetime
    attempts: int


@dataclass(frozen=True, kw_only=True)
class AttemptRow:
    """One attempt, as a list shows it.

    Attributes:
        id: number, ascending in the order in which attempts began.
        trainee: name.
        trainee_id: number.
        task: name.
        level: of it.
        device: what moved the instruments.
        status: how it stands, seen from now: one whose process has ended is interrupted.
        reason: why it was interrupted, if it was.
        began: when.
        duration: of the attempt; while it runs and where it was interrupted, of what is kept of it [s].
        score: 0 to 100 and more, once finished.
        passed: once finished.
        completed: whether every step was done, once finished.
    """

    id: int
    trainee: str
    trainee_id: int
    task: str
    level: int
    device: str
    status: Status
    reason: str | None
    began: datetime
    duration: float
    score: float | None
    passed: bool | None
    completed: bool | None

    def as_dict(self) -> dict[str, object]:
        """Return it as JSON takes it."""
        return {
            "id": self.id,
            "trainee": self.trainee,
            "task": self.task,
            "level": self.level,
            "device": self.device,
            "status": self.status.value,
            "reason": self.reason,
            "began": stamp(self.began),
            "duration_s": self.duration,
            "score": self.score,
            "passed": self.passed,
            "completed": self.completed,
        }


@dataclass(frozen=True, kw_only=True)
class KeptAttempt:
    """One attempt with all that is kept of it but its recording.

    Attributes:
        row: as in a list.
        header: what describes the recording.
        card: the score card as JSON has it, once finished.
    """

    row: AttemptRow
    header: Mapping[str, Any]
    card: Mapping[str, Any] | None

    @property
    def mistakes(self) -> Sequence[Mapping[str, Any]]:
        """In order: `time_s`, `step` and `words` of each."""
        return () if self.card is None else self.card["mistakes"]

    def as_dict(self) -> dict[str, object]:
        """Return it as JSON takes it."""
        return {**self.row.as_dict(), "header": self.header, "card": self.card}


@dataclass(frozen=True, kw_only=True)
class Metric:
    """One metric of one attempt.

    Attributes:
        name: of `trocar.training.metrics`.
        value: in its unit.
        unit: SI; 1 where there is none.
    """

    name: str
    value: float
    unit: str


def now() -> str:
    """Return the time as it is kept: UTC, ISO 8601, to the microsecond, so that text sorts as time does."""
    return stamp(datetime.now(UTC))


def stamp(time: datetime) -> str:
    """Return a time as it is kept and exported."""
    return time.astimezone(UTC).isoformat(timespec="microseconds").replace("+00:00", "Z")


def moment(text: str) -> datetime:
    """Return the time that was kept."""
    return datetime.fromisoformat(text)
