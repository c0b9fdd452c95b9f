"""One number under a key that carries its unit, such as `thickness_mm`, and those that laws and memory are stated by.

A range says what the models can compute in float64, not what is sensible tissue. Both borders use it: the file,
whose numbers are in the unit of the key, and the constructors, whose numbers are in SI.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite

from trocar.errors import InputError
from trocar.tissues.law import MOST_ALPHA, MOST_K2
from trocar.tissues.layer import GIVE_LONG_TERM, LARGEST_WEIGHT, LONGEST_TIME, SHORTEST_TIME
from trocar.units import DEGREE, KILOPASCAL


@dataclass(frozen=True, kw_only=True)
class KeyQuantity:
    """Describe one number of a file.

    Args:
        name: the SI attribute it becomes, such as "thickness".
        key: its key in a file, such as "thickness_mm".
        unit: the unit written after numbers in messages; empty for a ratio.
        factor: SI value of one unit.
        low, high: the range, in the unit of the file.
        high_open: whether `high` itself is refused.
        default: value in the unit of the file where the key may be left out; None where it may not.
        advice: what to do about a number outside the range.
    """

    name: str
    key: str
    unit: str
    factor: float
    low: float
    high: float
    high_open: bool = False
    default: float | None = None
    advice: str = ""

    @property
    def expected(self) -> str:
        """The range in words, in the unit of the file."""
        unit = f" {self.unit}" if self.unit else ""
        if self.high_open:
            return f"a number at least {self.low:g} and below {self.high:g}{unit}"
        return f"a number from {self.low:g} to {self.high:g}{unit}"

    def allows(self, value: float) -> bool:
        """Return whether a finite `value`, in the unit of the file, lies in the range."""
        if not isfinite(value):
            return False
        return self.low <= value < self.high if self.high_open else self.low <= value <= self.high

    def check(self, where: str, value: float) -> None:
        """Refuse a value [SI] outside the range.

        Multiplying by the same factor keeps order, so what `allows` accepts before conversion passes here.

        Raises:
            InputError: at `where`, in the unit of the file.
        """
        low, high = self.low * self.factor, self.high * self.factor
        if not (isfinite(value) and low <= value and (value < high if self.high_open else value <= high)):
            shown = value / self.factor if isfinite(value) else value
            raise InputError(where, self.expected, shown, self.advice)


PRONY_WEIGHT = KeyQuantity(
    name="prony", key="prony", unit="", factor=1.0, low=0, high=LARGEST_WEIGHT, advice=GIVE_LONG_TERM
)
PRONY_TIME = KeyQuantity(
    name="prony", key="prony", unit="s", factor=1.0, low=SHORTEST_TIME, high=LONGEST_TIME,
    advice="leave out what relaxes faster or slower than anything seen",
)  # fmt: skip

SHARE = KeyQuantity(name="share", key="ogden", unit="", factor=1.0, low=1e-9, high=1)
ALPHA = KeyQuantity(name="alpha", key="ogden", unit="", factor=1.0, low=-MOST_ALPHA, high=MOST_ALPHA)
FIBRE = (
    KeyQuantity(name="k1", key="k1_kpa", unit="kPa", factor=KILOPASCAL, low=0, high=1e9),
    KeyQuantity(name="k2", key="k2", unit="", factor=1.0, low=0, high=MOST_K2),
    KeyQuantity(
        name="dispersion", key="dispersion", unit="", factor=1.0, low=0, high=0.333334,
        advice="0 is all parallel, 1/3 isotropic",
    ),
    KeyQuantity(name="angle", key="angle_deg", unit="deg", factor=DEGREE, low=0, high=90),
)  # fmt: skip

MOST_LAYERS = 50  # of a file
