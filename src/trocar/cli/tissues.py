"""`trocar tissues`: list the tissue presets, show one with every value's source.

Nothing imported here is heavy: the presets need neither NumPy nor a model.
"""

from __future__ import annotations

import json
from typing import Annotated

import typer
from rich import box
from rich.console import Console, RenderableType
from rich.markup import escape
from rich.table import Table

from trocar.tissues import catalogue
from trocar.tissues.page import page, section
from trocar.tissues.record import LayerRecord, Statement, Status, TissueRecord, Usable

AsJson = Annotated[bool, typer.Option("--json", help="Print JSON alone.")]


def register(app: typer.Typer) -> None:
    """Add `trocar tissues` to an application."""
    group = typer.Typer(no_args_is_help=True, help="List and show tissues, each value with its source.")
    group.command("list", epilog="Example: trocar tissues list --json")(list_presets)
    group.command("show", epilog="Example: trocar tissues show skin --full")(show)
    app.add_typer(group, name="tissues", epilog="Example: trocar tissues show skin")


def list_presets(as_json: AsJson = False) -> None:
    """List the presets that ship with Trocar."""
    records = [catalogue.record(name) for name in catalogue.names()]
    if as_json:
        _print_json([record.summary() for record in records])
    else:
        _print(_list_table(records))


def show(
    name: Annotated[
        str | None, typer.Argument(help="A preset, or the path of a tissue file (.toml).", show_default=False)
    ] = None,
    every: Annotated[bool, typer.Option("--all", help="Show every preset.")] = False,
    full: Annotated[bool, typer.Option("--full", help="Reasons and other published values too.")] = False,
    as_json: AsJson = False,
    markdown: Annotated[bool, typer.Option("--markdown", help="Print Markdown for the docs.")] = False,
) -> None:
    """Show a tissue: every value with its spread, unit, source, method and status."""
    if every == (name is not None):
        raise typer.BadParameter("give the name of a preset, the path of a tissue file, or --all")
    if as_json and markdown:
        raise typer.BadParameter("--json and --markdown exclude each other")
    records = (
        [catalogue.record(name)]
        if name is not None
        else [catalogue.record(known) for known in catalogue.names()]
    )
    if as_json:
        _print_json([record.as_dict() for record in records] if every else records[0].as_dict())
    elif markdown:
        typer.echo(page(records) if every else section(records[0]), nl=False)
    else:
        for record in records:
            _print(*_shown_record(record, full=full))


def _print_json(content: object) -> None:
    typer.echo(json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False))


def _print(*parts: RenderableType) -> None:
    Console(highlight=False).print(*parts, sep="\n")


def _table(*columns: str, title: str | None = None) -> Table:
    table = Table(
        box=box.SIMPLE_HEAD,
        title=title,
        title_justify="left",
        title_style="bold",
        pad_edge=False,
        show_edge=False,
    )
    for column in columns:
        table.add_column(column, overflow="fold")
    return table


def _list_table(records: list[TissueRecord]) -> Table:
    table = _table("preset", "what it is", "layers", "mm", "values")
    table.columns[0].no_wrap = True
    table.columns[3].justify = "right"
    for record in records:
        counts = {status: record.count(status) for status in Status}
        said = ", ".join(f"{count} {_word(status)}" for status, count in counts.items() if count)
        usable = "" if record.usable is Usable.ANY else f"; {record.usable.value.upper()}"
        layers = ", ".join(layer.name for layer in record.layers)
        table.add_row(record.name, escape(record.title + usable), layers, f"{1e3 * record.thickness:g}", said)
    return table


def _shown_record(record: TissueRecord, *, full: bool) -> list[RenderableType]:
    parts: list[RenderableType] = [
        f"[bold]{escape(record.name)}[/bold]: {escape(record.title)}",
        escape(" ".join(record.why.split())),
    ]
    if record.usable is not Usable.ANY:
        parts.append(f"[bold]{record.usable.value.upper()}[/bold]: {escape(record.instead)}")
    for place, layer in enumerate(record.layers, start=1):
        parts += ["", _layer_table(layer, f"layer {place}: {layer.name}")]
        parts += _notes(layer) if full else []
    remembered = ", ".join(
        f"{item.title} of {layer.name}"
        for layer in record.layers
        for item in layer.stated
        if item.status is Status.REMEMBERED
    )
    if remembered:
        parts += ["", f"[bold]REMEMBERED[/bold], verify before citing: {escape(remembered)}."]
    return [*parts, ""]


def _layer_table(layer: LayerRecord, title: str) -> Table:
    table = _table("property", "value", "status", "source and method", title=escape(title))
    table.columns[2].no_wrap = True
    for item in layer.stated:
        source = escape(f"{item.source}; {item.method}")
        table.add_row(item.title, _value(item), _word(item.status), source)
    return table


def _notes(layer: LayerRecord) -> list[RenderableType]:
    reasons = [f"- why this {item.title}: {item.reason}" for item in layer.stated if item.reason]
    rivals = [f"- other {item.title}: {text}" for item in layer.stated for text in item.also]
    return [escape(line) for line in reasons + rivals]


def _value(item: Statement) -> str:
    unit = "" if item.unit == "1" else f" {item.unit}"
    spread = f"\n({item.spread_text})" if isinstance(item.spread, tuple) else f" {item.spread_text}".rstrip()
    return f"{item.value_text}{unit}{spread}" if "\n" in spread else f"{item.value_text}{spread}{unit}"


def _word(status: Status) -> str:
    """Name a status so that "remembered" stands out without colour."""
    return status.value.upper() if status is Status.REMEMBERED else status.value
