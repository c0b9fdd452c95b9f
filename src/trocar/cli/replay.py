"""trocar replay: a recorded attempt, played through its task once more and marked."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from trocar.training.session import Recording
    from trocar.training.tasks.task import Task


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command(epilog="Example: trocar replay --attempt 7 --table attempt-7.csv")(replay)


def replay(
    recording: Annotated[
        Path | None,
        typer.Argument(help="A recording; trocar train --headless --out writes one.", show_default=False),
    ] = None,
    attempt: Annotated[
        int | None,
        typer.Option(
            help="Number of an attempt on record instead; trocar records lists them.", show_default=False
        ),
    ] = None,
    task: Annotated[
        str | None,
        typer.Option(help="What was attempted in the recording; see trocar tasks.", show_default=False),
    ] = None,
    level: Annotated[int | None, typer.Option(help="Of the task.", show_default="1")] = None,
    table: Annotated[
        Path | None,
        typer.Option(
            help="Write every tick there as CSV, forces included, and the task beside it.", show_default=False
        ),
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print the score card as JSON alone.")] = False,
) -> None:
    """Print the score card of a recorded attempt: it follows from the recording alone."""
    from trocar.cli.score_card import print_card
    from trocar.training.session import assess
    from trocar.training.table import write_table

    if (recording is None) == (attempt is None):
        raise typer.BadParameter("expected one of a recording and --attempt")
    if attempt is not None:
        for option, given in (("task", task), ("level", level)):
            if given is not None:
                raise typer.BadParameter(f"--{option} is for a recording: the record says what was attempted")
        attempted, played = _on_record(attempt)
    else:
        if recording is None or task is None:
            raise typer.BadParameter("a recording needs --task; trocar tasks lists them")
        attempted, played = _in_file(recording, task, 1 if level is None else level)
    if table is not None:
        beside = write_table(table, attempted, played)
        typer.echo(f"{table} and {beside} were written", err=True)
    print_card(assess(attempted, played), attempted.marking.pass_score, as_json=as_json)


def _in_file(recording: Path, task: str, level: int) -> tuple[Task, Recording]:
    from trocar.training.tape import read_attempt
    from trocar.training.tasks.catalogue import task as task_by_name

    return task_by_name(task, level), read_attempt(recording)


def _on_record(number: int) -> tuple[Task, Recording]:
    from trocar.records.store import Records
    from trocar.training.strip import recorded
    from trocar.training.tasks.catalogue import task as task_by_name

    with Records.open(writing=False) as records:
        row = records.attempt(number).row
        return task_by_name(row.task, row.level), recorded(*records.chunks(number))
