"""Attempts as one tidy table: a row each, a column for each thing, units in the columns' names."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterable, Mapping, Sequence
from io import StringIO

from trocar.records.rows import AttemptRow, Metric

ABOUT = (
    "id",
    "trainee",
    "task",
    "level",
    "device",
    "status",
    "reason",
    "began",
    "duration_s",
    "score",
    "passed",
    "completed",
)
"""Columns that every table has, in this order; metrics follow by name."""

_YES_NO = {True: "yes", False: "no"}


def table(
    attempts: Iterable[AttemptRow], metrics: Mapping[int, Sequence[Metric]], *, pseudonymous: bool = False
) -> str:
    """Return the table as CSV (RFC 4180); what does not exist is an empty cell.

    Args:
        attempts: in order.
        metrics: by the attempt's number.
        pseudonymous: whether trainees are numbers instead of names.
    """
    rows = []
    for attempt in attempts:
        row = attempt.as_dict() | {column(one): one.value for one in metrics.get(attempt.id, ())}
        if pseudonymous:
            row["trainee"] = pseudonym(attempt)
        rows.append(row)
    others = sorted({name for row in rows for name in row}.difference(ABOUT))
    text = StringIO()
    lines = csv.writer(text)
    lines.writerow([*ABOUT, *others])
    for row in rows:
        lines.writerow([_cell(row.get(name)) for name in (*ABOUT, *others)])
    return text.getvalue()


def column(metric: Metric) -> str:
    """Return a metric's name with its unit, as columns and addresses have it."""
    unit = "" if metric.unit == "1" else re.sub(r"[^a-z0-9]+", "_", metric.unit.lower()).strip("_")
    return f"{metric.name}_{unit}" if unit else metric.name


def pseudonym(attempt: AttemptRow) -> str:
    """Return what stands for a trainee's name; only these records can tell whose it is."""
    return f"trainee {attempt.trainee_id}"


def _cell(value: object) -> object:
    if isinstance(value, bool):
        return _YES_NO[value]
    return repr(value) if isinstance(value, float) else value
