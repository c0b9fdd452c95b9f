"""trocar tasks: what can be trained."""

from __future__ import annotations

import json
from typing import Annotated

import typer
from rich import box
from rich.console import Console
from rich.table import Table


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command(epilog="Example: trocar tasks --json")(tasks)


def tasks(
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON alone.")] = False,
) -> None:
    """List the tasks and their levels."""
    from trocar.training.tasks.catalogue import LEVELS, TASKS, task

    every = [task(name, level) for name in TASKS for level in LEVELS]
    if as_json:
        rows = [one.as_dict() for one in every]
        typer.echo(json.dumps(rows, indent=2))
        return
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, show_edge=False)
    for column in ("task", "what it trains", "ports", "levels", "time allowed"):
        table.add_column(column)
    table.columns[-1].justify = "right"
    for one in (task(name) for name in TASKS):
        levels = f"{LEVELS[0]} to {LEVELS[-1]}"
        table.add_row(one.name, f"{one.title}. {one.purpose}", one.ports, levels, f"{one.marking.cutoff:g} s")
    Console(highlight=False).print(table)
