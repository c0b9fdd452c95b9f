"""How a score card is printed."""

from __future__ import annotations

from math import isfinite
from typing import TYPE_CHECKING

from rich import box
from rich.console import Console
from rich.table import Table

if TYPE_CHECKING:
    from trocar.training.session import Card


def print_card(card: Card, pass_score: float) -> None:
    """Print it for people: the score first, then what to do better, then the metrics, time first."""
    from trocar.training.metrics.measures import MEASURES

    console = Console(highlight=False)
    verdict = "passed" if card.passed else "not passed"
    console.print(
        f"[bold]{card.task}, level {card.level}: {card.score:.1f} of 100, {verdict}[/bold] "
        f"(from {pass_score:g}; not yet validated on people)"
    )
    for words in card.advice:
        console.print(f"  {words}")
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
