"""How a score card is printed."""

from __future__ import annotations

import json
from collections.abc import Mapping
from math import isfinite
from typing import TYPE_CHECKING

import typer
from rich import box
from rich.console import Console
from rich.table import Table

if TYPE_CHECKING:
    from trocar.training.session import Card


def print_card(
    card: Card, pass_score: float, *, as_json: bool, besides: Mapping[str, object] | None = None
) -> None:
    """Print a card: for people the score first, then what to do better, then the metrics, time first.

    Args:
        card: what is printed.
        pass_score: of its task.
        as_json: as JSON alone.
        besides: what JSON says of the attempt besides.
    """
    from trocar.training.metrics.measures import MEASURES

    if as_json:
        typer.echo(json.dumps({**(besides or {}), **card.as_dict()}, indent=2, allow_nan=False))
        return
    console = Console(highlight=False)
    verdict = "passed" if card.passed else "not passed"
    console.print(
        f"[bold]{card.task}, level {card.level}: {card.score:.1f} of 100, {verdict}[/bold] "
        f"(from {pass_score:g}; not yet validated on people)"
    )
    for words in card.advice:
        console.print(f"  {words}")
    if card.skipped > 0:
        console.print(
            f"  The servo skipped {card.skipped:.3f} s; the tissue's clock, by which you are timed, stood still."
        )
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, show_edge=False)
    table.add_column("metric")
    table.add_column("value", justify="right")
    table.add_column("what it cannot tell")
    for measure in MEASURES:
        value = card.metrics[measure.name]
        unit = "" if measure.unit == "1" else f" {measure.unit}"
        shown = f"{value:.4g}{unit}" if isfinite(value) else "none"
        table.add_row(measure.name.replace("_", " "), shown, measure.cannot_tell)
    console.print(table)
