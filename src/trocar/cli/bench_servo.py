"""`trocar bench servo`: how the 1 kHz servo keeps time on this machine, beside an empty loop."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import TYPE_CHECKING, Annotated

import typer
from rich import box
from rich.console import Console
from rich.progress import Progress
from rich.table import Table

if TYPE_CHECKING:
    from trocar.realtime.bench import Round, ServoBench


_MOST_COLUMNS = 5  # of single rounds; more would not fit a terminal


def servo(
    seconds: Annotated[float, typer.Option(help="Of each round.")] = 20.0,
    rounds: Annotated[int, typer.Option(help="Of the servo; the empty loop has one more.")] = 3,
    empty: Annotated[bool, typer.Option("--empty", help="Leave the servo out.")] = False,
    tissue: Annotated[str, typer.Option(help="A preset; see trocar tissues list.")] = "skin",
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON alone.")] = False,
) -> None:
    """Run the servo with two instruments sliding in contact, in turns with a compiled loop that does nothing."""
    from trocar.realtime.bench import alternate
    from trocar.realtime.sliding import sliding_contact
    from trocar.tissues.catalogue import tissue as preset

    scene, state, motion = sliding_contact(preset(tissue))
    with Progress(console=Console(stderr=True), transient=True) as bar:
        work = bar.add_task("rounds", total=None)
        found = alternate(
            scene,
            state,
            motion,
            seconds=seconds,
            rounds=rounds,
            only_empty=empty,
            progress=lambda done, total: bar.update(work, completed=done, total=total),
        )
    if as_json:
        typer.echo(json.dumps(found.as_dict(), indent=2, allow_nan=False))
        return
    report(found)


def report(found: ServoBench) -> None:
    """Print a table and what follows from it."""
    console = Console(highlight=False)
    console.print(_table(found))
    console.print(_sentences(found))


def _table(found: ServoBench) -> Table:
    table = Table(
        box=box.SIMPLE_HEAD,
        title=f"ticks of 1 ms, {found.processor}",
        title_justify="left",
        pad_edge=False,
        show_edge=False,
    )
    table.add_column("")
    rounds = found.rounds if len(found.rounds) <= _MOST_COLUMNS else ()
    for number, one in enumerate(rounds, 1):
        table.add_column(f"{number} {one.loop}", justify="right")
    together = [one for one in (found.servo, found.empty) if one is not None]
    for one in together:
        table.add_column(f"all {one.loop}", justify="right")
    rows: tuple[tuple[str, Callable[[Round], str]], ...] = (
        ("ticks", lambda r: f"{r.ticks}"),
        ("missed", lambda r: f"{r.missed}"),
        ("missed, %", lambda r: f"{r.missed_percent:.3f}"),
        ("tick, median, us", lambda r: f"{r.tick_p50_us:.1f}"),
        ("tick, 99 %, us", lambda r: f"{r.tick_p99_us:.1f}"),
        ("tick, 99.9 %, us", lambda r: f"{r.tick_p999_us:.1f}"),
        ("late, median, us", lambda r: f"{r.late_p50_us:.1f}"),
        ("late, 99 %, us", lambda r: f"{r.late_p99_us:.1f}"),
        ("late, 99.9 %, us", lambda r: f"{r.late_p999_us:.1f}"),
        ("both in contact, %", lambda r: "" if r.loop == "empty" else f"{100 * r.touching:.0f}"),
    )
    for name, text in rows:
        table.add_row(name, *(text(one) for one in (*rounds, *together)))
    return table


def _sentences(found: ServoBench) -> str:
    scheduled = all(one.scheduled for one in found.rounds)
    sentence = (
        f"A tick's work by itself: median {found.work_p50_us:.1f} us, 99.9 % {found.work_p999_us:.1f} us, "
        f"most {found.work_max_us:.1f} us. "
    )
    sentence += "Real-time class granted." if scheduled else "No real-time class: other programs delay ticks."
    if found.servo is None or found.empty is None:
        return sentence
    points = found.servo.missed_percent - found.empty.missed_percent
    return f"{sentence} Missed by the servo beyond the empty loop: {points:+.3f} points."
