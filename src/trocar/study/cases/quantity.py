"""Which numbers a case may hold: every quantity's key, unit and possible range, in one table.

A range says what the models can compute in float64, not what is sensible tissue. Both borders use it: the
file, whose numbers are in the unit of the key, and the constructors, whose numbers are in SI.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite

from trocar.errors import InputError
from trocar.tissues.law import MOST_ALPHA, MOST_K2
from trocar.tissues.layer import GIVE_LONG_TERM, LARGEST_WEIGHT, LONGEST_TIME, SHORTEST_TIME
from trocar.units import DEGREE, KILOPASCAL, MILLIMETRE


@dataclass(frozen=True, kw_only=True)
class Quantity:
    """Describe one number of a case file.

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


SIDE = Quantity(name="size", key="size_mm", unit="mm", factor=MILLIMETRE, low=1, high=1000)

THICKNESS = Quantity(
    name="thickness", key="thickness_mm", unit="mm", factor=MILLIMETRE, low=0.001, high=1000,
    advice="a layer is between a micrometre and a metre thick",
)  # fmt: skip
YOUNG_MODULUS = Quantity(
    name="young_modulus", key="young_modulus_kpa", unit="kPa", factor=KILOPASCAL, low=1e-3, high=1e9
)
POISSON_RATIO = Quantity(
    name="poisson_ratio", key="poisson_ratio", unit="", factor=1.0, low=0, high=0.4999,
    advice="it must stay below 0.5; use 0.499 for nearly incompressible tissue",
)  # fmt: skip
DENSITY = Quantity(
    name="density", key="density_kg_m3", unit="kg/m3", factor=1.0, low=1, high=30000,
    advice="soft tissue is about 900 to 1200 kg/m3",
)  # fmt: skip
PRESTRESS = Quantity(
    name="prestress", key="prestress_kpa", unit="kPa", factor=KILOPASCAL, low=0, high=1e6, default=0.0,
    advice="tension is positive; a layer in compression could buckle",
)  # fmt: skip
LOSS_FACTOR = Quantity(
    name="loss_factor", key="loss_factor", unit="", factor=1.0, low=0, high=100, default=0.0
)
LOSS_FREQUENCY = Quantity(
    name="loss_frequency", key="loss_frequency_hz", unit="Hz", factor=1.0, low=1e-3, high=1e6, default=50.0
)
PRONY_WEIGHT = Quantity(
    name="prony", key="prony", unit="", factor=1.0, low=0, high=LARGEST_WEIGHT, advice=GIVE_LONG_TERM
)
PRONY_TIME = Quantity(
    name="prony", key="prony", unit="s", factor=1.0, low=SHORTEST_TIME, high=LONGEST_TIME,
    advice="leave out what relaxes faster or slower than anything seen",
)  # fmt: skip
LAYER = (THICKNESS, YOUNG_MODULUS, POISSON_RATIO, DENSITY, LOSS_FACTOR, LOSS_FREQUENCY)

SHARE = Quantity(name="share", key="ogden", unit="", factor=1.0, low=1e-9, high=1)
ALPHA = Quantity(name="alpha", key="ogden", unit="", factor=1.0, low=-MOST_ALPHA, high=MOST_ALPHA)
FIBRE = (
    Quantity(name="k1", key="k1_kpa", unit="kPa", factor=KILOPASCAL, low=0, high=1e9),
    Quantity(name="k2", key="k2", unit="", factor=1.0, low=0, high=MOST_K2),
    Quantity(
        name="dispersion", key="dispersion", unit="", factor=1.0, low=0, high=0.333334,
        advice="0 is all parallel, 1/3 isotropic",
    ),
    Quantity(name="angle", key="angle_deg", unit="deg", factor=DEGREE, low=0, high=90),
)  # fmt: skip

DIAMETER = Quantity(name="diameter", key="diameter_mm", unit="mm", factor=MILLIMETRE, low=0.01, high=1000)
POSITION = Quantity(name="position", key="position_mm", unit="mm", factor=MILLIMETRE, low=0, high=1000)
TILT = Quantity(
    name="tilt", key="tilt_deg", unit="deg", factor=DEGREE, low=0, high=90, high_open=True, default=0.0,
    advice="0 is upright; turn azimuth_deg instead of using a negative tilt",
)  # fmt: skip
AZIMUTH = Quantity(
    name="azimuth", key="azimuth_deg", unit="deg", factor=DEGREE, low=-360, high=360, default=0.0
)
PEAK = Quantity(name="peak", key="peak_n", unit="N", factor=1.0, low=1e-6, high=1e5)
RATE = Quantity(name="rate", key="rate_n_s", unit="N/s", factor=1.0, low=1e-9, high=1e9)
HOLD = Quantity(name="hold", key="hold_s", unit="s", factor=1.0, low=0, high=1e5, default=0.0)
TOOL = (DIAMETER, TILT, AZIMUTH, PEAK, RATE, HOLD)

PERIOD = Quantity(name="period", key="period_s", unit="s", factor=1.0, low=1e-6, high=1e5)

MOST_LAYERS = 50
MOST_TOOLS = 2  # a trainer has two hands
MOST_SAMPLES = 100_000
SHORTEST_RAMP = 1e-6  # [s]; with HOLD's limit, times of one history differ by far more than their rounding
LONGEST_RAMP = 1e6  # [s], eleven days
MOST_STIFFNESS_RATIO = (
    1e8  # stiffest over softest: float64 keeps 16 digits, a mesh of aspect 1e4 takes 8 of them
)
MOST_THICKNESS_RATIO = 1e4  # thickest over thinnest layer
LEAST_SLENDERNESS, MOST_SLENDERNESS = 1e-4, 10.0  # whole thickness over the shorter side
LEAST_TOOL_RATIO = 1e-3  # diameter over the longer side: at 1e-3 a footprint already needs 1e4 modes a side
