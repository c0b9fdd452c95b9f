"""Attempts as xAPI statements, for a learning record store.

Who did what, with what result: the form is that of the Experience API, version 1.0.3, part two. Verbs and the kind of
activity are those of ADL's vocabulary. Statements are about attempts that have ended; one that runs says nothing yet.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from urllib.parse import quote
from uuid import UUID, uuid5

from trocar.errors import InputError
from trocar.records.rows import AttemptRow, Metric, Status, stamp
from trocar.records.tidy import column, pseudonym

HOME_PAGE = "https://trocar.invalid/"
"""Where accounts live if nobody says: an address that never is one (RFC 2606)."""

FULL_SCORE = 100.0  # of a score without advantage in time; what is above it goes into an extension alone

_VERBS = "http://adlnet.gov/expapi/verbs/"
_SIMULATION = "http://adlnet.gov/expapi/activities/simulation"
_STATEMENTS = UUID("6f1b6a52-2a51-4c53-9b8e-6a1f6d0f4b57")  # chosen once at random, ours alone


def statements(
    attempts: Iterable[AttemptRow],
    metrics: Mapping[int, Sequence[Metric]],
    *,
    home_page: str = HOME_PAGE,
    pseudonymous: bool = False,
) -> list[dict[str, object]]:
    """Return one statement for each attempt that has ended.

    Args:
        attempts: in order.
        metrics: by the attempt's number.
        home_page: address of the place whose names the trainees' are.
        pseudonymous: whether trainees are numbers instead of names.

    Raises:
        InputError: the home page is no address.
    """
    if not re.fullmatch(r"https?://[^\s<>\"{}|\\^`]+", home_page):
        raise InputError("xapi: home page", "an address such as https://hospital.example/", home_page)
    return [
        _statement(row, metrics.get(row.id, ()), home_page, pseudonym(row) if pseudonymous else row.trainee)
        for row in attempts
        if row.status is not Status.RUNNING
    ]


def duration(seconds: float) -> str:
    """Return a duration as ISO 8601 has it, to a hundredth of a second."""
    return f"PT{seconds:.2f}S"


def _statement(row: AttemptRow, metrics: Sequence[Metric], home_page: str, name: str) -> dict[str, object]:
    began = stamp(row.began)
    return {
        "id": str(uuid5(_STATEMENTS, "\n".join((home_page, name, str(row.id), began)))),
        "actor": {"objectType": "Agent", "account": {"homePage": home_page, "name": name}},
        "verb": _verb(row),
        "object": {
            "objectType": "Activity",
            "id": f"urn:trocar:task:{quote(row.task, safe='')}:level:{row.level}",
            "definition": {
                "name": {"en": f"{row.task}, level {row.level}"},
                "type": _SIMULATION,
                "extensions": {"urn:trocar:level": row.level},
            },
        },
        "result": _result(row, metrics),
        "context": {"platform": "Trocar", "extensions": {"urn:trocar:device": row.device}},
        "timestamp": began,
    }


def _verb(row: AttemptRow) -> dict[str, object]:
    if row.status is Status.INTERRUPTED:
        word = "terminated"
    elif row.passed is None:
        word = "completed"
    else:
        word = "passed" if row.passed else "failed"
    return {"id": f"{_VERBS}{word}", "display": {"en": word}}


def _result(row: AttemptRow, metrics: Sequence[Metric]) -> dict[str, object]:
    extensions: dict[str, object] = {f"urn:trocar:metric:{column(one)}": one.value for one in metrics}
    result: dict[str, object] = {"completion": bool(row.completed), "duration": duration(row.duration)}
    if row.status is Status.INTERRUPTED:
        extensions["urn:trocar:reason"] = row.reason or ""
    if row.passed is not None:
        result["success"] = row.passed
    if row.score is not None:
        raw = min(row.score, FULL_SCORE)  # a raw score above its largest would be no valid statement
        result["score"] = {"scaled": raw / FULL_SCORE, "raw": raw, "min": 0.0, "max": FULL_SCORE}
        extensions["urn:trocar:score"] = row.score
    if extensions:
        result["extensions"] = extensions
    return result
