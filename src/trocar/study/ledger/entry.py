"""One line of the ledger, and the rule that gives its verdict."""

from __future__ import annotations

from dataclasses import dataclass
from decimal import Decimal
from enum import StrEnum
from math import isfinite

ROUNDING = Decimal("1e-12")  # a value that lies on the edge in decimals may miss it in binary


class Verdict(StrEnum):
    """What became of a published number."""

    REPRODUCED = "reproduced"  # the stated inputs give the stated value, to the printed digits
    INCONSISTENT = "inconsistent"  # they do not
    NOT_SPECIFIED = "not specified"  # the text does not say enough to tell


@dataclass(frozen=True, kw_only=True)
class Entry:
    """One number of the paper.

    Args:
        id: its name.
        printed: as the paper prints it; empty where it prints nothing.
        recomputed: our own value in `unit`; None where there is none.
        unit: of both numbers.
        verdict: what became of it.
        note: why, in a sentence or two.
    """

    id: str
    printed: str
    recomputed: float | None
    unit: str
    verdict: Verdict
    note: str

    @property
    def published(self) -> float | str | None:
        """The printed value, a number where it is one, else text; None where nothing is printed."""
        try:
            return float(self.printed)
        except ValueError:
            return self.printed or None

    def as_dict(self) -> dict[str, float | str | None]:
        """Return the entry for JSON; a recomputed infinity or nan becomes None."""
        known = self.recomputed is not None and isfinite(self.recomputed)
        return {
            "id": self.id,
            "published": self.published,
            "printed": self.printed,
            "recomputed": self.recomputed if known else None,
            "unit": self.unit,
            "verdict": self.verdict.value,
            "note": self.note,
        }


def half_digit(printed: str) -> float:
    """Return half of one unit in the last printed digit: 0.005 for "1.54", 5e-9 for "1.80e-6"."""
    exponent = Decimal(printed).as_tuple().exponent
    assert isinstance(exponent, int), printed
    return float(Decimal(5).scaleb(exponent - 1))


def agrees(printed: str, value: float) -> bool:
    """Return whether `value` rounds to the printed digits; an exact half may go either way.

    A printed 0 is a condition, not a rounded number: it must be met but for rounding.

    Args:
        printed: a decimal number as printed, such as "6.11e-6".
        value: to compare.
    """
    if not isfinite(value):
        return False
    number = Decimal(printed)
    if number == 0:
        return abs(Decimal(value)) <= ROUNDING
    reach = Decimal(half_digit(printed)) * (1 + ROUNDING) + abs(number) * ROUNDING
    return abs(Decimal(value) - number) <= reach


def recomputed_entry(name: str, printed: str, value: float, unit: str, note: str) -> Entry:
    """Return an entry judged by its printed digits.

    Args:
        name: its id.
        printed: a decimal number as printed.
        value: our own, in `unit`.
        unit: of both.
        note: why.
    """
    verdict = Verdict.REPRODUCED if agrees(printed, value) else Verdict.INCONSISTENT
    return Entry(id=name, printed=printed, recomputed=float(value), unit=unit, verdict=verdict, note=note)


def unspecified_entry(
    name: str, unit: str, note: str, value: float | None = None, printed: str = ""
) -> Entry:
    """Return an entry the text does not say enough about.

    Args:
        name: its id.
        unit: of the numbers.
        note: what is missing.
        value: our own where something can be said, in `unit`.
        printed: what the paper says about it.
    """
    return Entry(
        id=name, printed=printed, recomputed=value, unit=unit, verdict=Verdict.NOT_SPECIFIED, note=note
    )
