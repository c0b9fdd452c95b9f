"""A questionnaire as one trainee filled it in."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime


@dataclass(frozen=True, kw_only=True)
class Sheet:
    """Answers given together.

    Attributes:
        trainee: name.
        attempt: after which they were given; None after a course.
        group: what the trainee was then, one of `trocar.records.questionnaire.GROUPS`.
        values: by item, 1 to 5; items that were left out are missing.
        answered: when.
    """

    trainee: str
    attempt: int | None
    group: str
    values: Mapping[str, int]
    answered: datetime
