"""The presets as one page of documentation, so that no table of values is ever typed twice."""

from __future__ import annotations

from collections.abc import Iterable

from trocar.tissues.record import LayerRecord, Statement, Status, TissueRecord, Usable

_HEAD = """\
# Tissue presets

Written by `trocar tissues show --all --markdown`; do not edit. How the values were chosen:
[Where the tissues come from](../explanation/tissues.md).

A spread after ± is a standard deviation, "a to b" a range. *read*: we read the value in the source or in
its abstract; *derived*: computed from values read; *chosen*: our engineering choice; **remembered**: from
memory, verify before citing. What a layer does not state is zero (prestress, loss) or unknown (strength).
"""


def page(records: Iterable[TissueRecord]) -> str:
    """Return the page in Markdown.

    Args:
        records: the tissues, in the order they shall stand.
    """
    return "\n".join([_HEAD, *(section(record) for record in records)])


def section(record: TissueRecord) -> str:
    """Return one tissue in Markdown: why, then a table, the reasons and the rival values of each layer."""
    parts = [f"## {record.name}", f"{record.title}.", " ".join(record.why.split())]
    if record.usable is not Usable.ANY:
        parts.append(f"**Usable: {record.usable.value}**; {record.instead}.")
    for layer in record.layers:
        parts += [f"### {record.name}: {layer.name}", _table(layer), *_notes(layer)]
    return "\n\n".join(parts) + "\n"


def _table(layer: LayerRecord) -> str:
    rows = ["| property | value | unit | status | source | method |", "|---|---|---|---|---|---|"]
    for item in layer.stated:
        cells = (item.title, _value(item), item.unit, _status(item), item.source, str(item.method))
        rows.append(f"| {' | '.join(map(_cell, cells))} |")
    return "\n".join(rows)


def _cell(text: str) -> str:
    return text.replace("|", r"\|")


def _value(item: Statement) -> str:
    return f"{item.value_text} {_spread(item)}".strip()


def _spread(item: Statement) -> str:
    return f"({item.spread_text})" if isinstance(item.spread, tuple) else item.spread_text


def _status(item: Statement) -> str:
    return f"**{item.status.value}**" if item.status is Status.REMEMBERED else item.status.value


def _notes(layer: LayerRecord) -> list[str]:
    reasons = [f"- {item.title}: {item.reason}" for item in layer.stated if item.reason]
    rivals = [f"- {item.title}: {text}" for item in layer.stated for text in item.also]
    notes = []
    if reasons:
        notes.append("\n".join(["Reasons:", "", *reasons]))
    if rivals:
        notes.append("\n".join(["Other published values:", "", *rivals]))
    return notes
