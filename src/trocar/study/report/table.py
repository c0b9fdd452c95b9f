"""A table as plain text: the template decides how it looks, the builders only what it says."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Table:
    """Rows under a head; the first cell of a row names it.

    Attributes:
        caption: what the table holds.
        head: one entry a column, units included.
        rows: each as long as the head.
        numeric: columns whose cells are numbers, counted from 0, to be set flush right.
        note: what a reader must know besides.
    """

    caption: str
    head: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    numeric: tuple[int, ...] = ()
    note: str = ""

    def __post_init__(self) -> None:
        assert all(len(row) == len(self.head) for row in self.rows), self.caption


def percent(share: float, *, signed: bool = False) -> str:
    """Return a share as "0.46 %", two significant digits below 100 %, with a true minus sign.

    Args:
        share: of one.
        signed: whether to write the plus sign too.
    """
    value = 100 * share
    if value == 0:
        return "0 %"
    places = max(0, 1 - int(f"{value:.1e}".split("e")[1]))
    return f"{value:{'+' if signed else ''}.{places}f} %".replace("-", "−")


def count(number: int) -> str:
    """Return a whole number with its thousands apart."""
    return f"{number:,}".replace(",", "\N{NARROW NO-BREAK SPACE}")
