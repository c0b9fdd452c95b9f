"""trocar replay: a recorded attempt, played through its task once more and marked."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command(epilog="Example: trocar replay attempt.csv --task palpate --level 2")(replay)


def replay(
    recording: Annotated[Path, typer.Argument(help="A recording; trocar train --headless --out writes one.")],
    task: Annotated[str, typer.Option(help="What was attempted; see trocar tasks.")],
    level: Annotated[int, typer.Option(help="Of the task.")] = 1,
    as_json: Annotated[bool, typer.Option("--json", help="Print the score card as JSON alone.")] = False,
) -> None:
    """Print the score card of a recorded attempt: it follows from the recording alone."""
    from trocar.cli.score_card import print_card
    from trocar.training.session import assess
    from trocar.training.tape import read_attempt
    from trocar.training.tasks.catalogue import task as task_by_name

    attempted = task_by_name(task, level)
    print_card(assess(attempted, read_attempt(recording)), attempted.marking.pass_score, as_json=as_json)
