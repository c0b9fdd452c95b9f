"""How records are printed for people."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from rich import box
from rich.console import Console, RenderableType
from rich.markup import escape
from rich.table import Table

if TYPE_CHECKING:
    from trocar.records.learning import History
    from trocar.records.opinions import Consistency, Difference, Middle
    from trocar.records.rows import AttemptRow, KeptAttempt


def print_attempts(found: Sequence[AttemptRow]) -> None:
    """Print a list of attempts; 80 columns hold it."""
    table = _table("id", "began", "trainee", "task", "level", "time", "score")
    for column in (0, 4, 5):
        table.columns[column].justify = "right"
    for column in (0, 1, 3, 4, 5, 6):
        table.columns[column].no_wrap = True
    table.columns[2].overflow = "fold"
    for row in found:
        table.add_row(
            str(row.id),
            f"{row.began.astimezone():%d %b %H:%M}",
            escape(row.trainee),
            escape(row.task),
            str(row.level),
            f"{row.duration:.1f} s",
            _status(row) if row.score is None else f"{row.score:.1f} {_verdict(row.passed)}",
        )
    _print(table)


def print_attempt(kept: KeptAttempt) -> None:
    """Print one attempt with its score card."""
    row = kept.row
    _print(
        f"[bold]attempt {row.id}: {escape(row.task)}, level {row.level}, {escape(row.trainee)}[/bold]",
        f"  began {_local(row)}, {row.duration:.1f} s, moved by {escape(row.device)}",
    )
    if kept.card is None:
        why = f": {escape(row.reason)}" if row.reason else ""
        _print(f"  {row.status.value}{why}; there is no score card")
        return
    _print(f"  [bold]{row.score:.1f} of 100, {_verdict(row.passed)}[/bold] (not yet validated on people)")
    for one in kept.mistakes:
        _print(f"  at {one['time_s']:.1f} s, step {one['step']}: {escape(one['words'])}")
    for words in kept.card["advice"]:
        _print(f"  {escape(words)}")
    table = _table("metric", "value")
    table.columns[-1].justify = "right"
    for name, one in kept.card["metrics"].items():
        unit = "" if one["unit"] == "1" else f" {one['unit']}"
        table.add_row(name.replace("_", " "), f"{one['value']:.4g}{unit}")
    _print(table)


def print_history(found: History) -> None:
    """Print a learning curve, its chart, and what remains."""
    _print(f"[bold]{escape(found.trainee)}: {escape(found.task)}, level {found.level}[/bold]")
    if not found.rows:
        _print(f"  no attempt was finished; what remains: {found.remains}.")
        return
    table = _table("attempt", "id", "began", "time", "score", "", "CUSUM")
    for column in (0, 1, 3, 4, 6):
        table.columns[column].justify = "right"
    for place, (row, height) in enumerate(zip(found.rows, found.chart, strict=True), 1):
        score = "" if row.score is None else f"{row.score:.1f}"
        table.add_row(
            str(place),
            str(row.id),
            _local(row),
            f"{row.duration:.1f} s",
            score,
            _verdict(row.passed),
            f"{height:+.3f}",
        )
    _print(table)
    chart = found.cusum
    for height, way, after, words in (
        (chart.alarm, "up", found.alarm_after, f"more than {chart.unacceptable:.0%} fail"),
        (chart.proof, "down", found.proof_after, f"no more than {chart.acceptable:.0%} fail"),
    ):
        when = "not yet" if after is None else f"after attempt {after}"
        _print(f"  CUSUM: {height:.3f} {way} says that {words}: {when}.")
    _print(f"  What remains: {found.remains}.")


def print_opinions(
    lie: Sequence[Middle], together: Consistency, between: Sequence[Difference], group_a: str, group_b: str
) -> None:
    """Print where answers lie, how two groups differ, and whether the items hang together."""
    from trocar.records.questionnaire import ITEMS

    table = _table("item, 1 disagree to 5 agree", "group", "n", "median", "quartiles")
    for column in (2, 3):
        table.columns[column].justify = "right"
    last = ""
    for one in lie:
        words, last = ("" if one.item == last else ITEMS[one.item]), one.item
        if one.quartiles is None:
            table.add_row(words, one.group, str(one.n), "", one.note)
        else:
            lower, median, upper = one.quartiles
            table.add_row(words, one.group, str(one.n), f"{median:g}", f"{lower:g} to {upper:g}")
    _print(table)
    apart = _table("item", "U", f"{group_a} above {group_b}", "p")
    for column in (1, 2, 3):
        apart.columns[column].justify = "right"
    for each in between:
        if each.u is None or each.p is None or each.chance is None:
            apart.add_row(each.item, "", "", each.note)
        else:
            apart.add_row(each.item, f"{each.u:g}", f"{each.chance:.0%}", _chance(each.p))
    _print("", apart, "")
    alpha = (
        together.note if together.alpha is None else f"{together.alpha:.2f} ({together.n} complete answers)"
    )
    _print(f"Cronbach's alpha: {alpha}")


def say(*sentences: str) -> None:
    """Print sentences as they are, each on a line of its own."""
    console = Console(highlight=False)
    for sentence in sentences:
        console.print(sentence, markup=False, soft_wrap=True)


def _chance(p: float) -> str:
    return f"{p:.3f}" if p >= 0.0005 else "<0.001"


def _status(row: AttemptRow) -> str:
    from trocar.records.rows import Status

    colour = {Status.RUNNING: "cyan", Status.INTERRUPTED: "yellow"}.get(row.status)
    return f"[{colour}]{row.status.value}[/{colour}]" if colour else row.status.value


def _verdict(passed: bool | None) -> str:
    return "" if passed is None else ("passed" if passed else "not passed")


def _local(row: AttemptRow) -> str:
    """Return when an attempt began, in this machine's time."""
    return f"{row.began.astimezone():%Y-%m-%d %H:%M}"


def _table(*columns: str) -> Table:
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, show_edge=False)
    for column in columns:
        table.add_column(column)
    return table


def _print(*things: RenderableType) -> None:
    console = Console(highlight=False)
    for thing in things:
        console.print(thing)
