"""What can be stated of a tissue: each quantity's units as people write them, and the bounds of the possible.

The bounds are wide on purpose. They do not judge biology; they catch a slipped unit or exponent, such as a
density in g/m3 where kg/m3 was meant.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

from trocar.units import KILOPASCAL, MEGAPASCAL, MILLIMETRE

_GRAM = 1e-3  # [kg]
_LENGTH = {"um": 1e-6, "mm": MILLIMETRE, "m": 1.0}
_STRESS = {"Pa": 1.0, "kPa": KILOPASCAL, "MPa": MEGAPASCAL}
_DENSITY = {"kg/m3": 1.0, "g/cm3": 1e3}
_RATIO = {"1": 1.0}


@dataclass(frozen=True, kw_only=True)
class Quantity:
    """Describe one quantity.

    Args:
        title: how it is called in tables.
        si_unit: its SI unit.
        units: factor to SI of each unit it may be written in.
        low, high: bounds of the possible [SI], both allowed.
        required: whether a layer must state it.
    """

    title: str
    si_unit: str
    units: Mapping[str, float] = field(repr=False)
    low: float
    high: float
    required: bool = True

    @property
    def expected(self) -> str:
        """What is accepted, in words."""
        unit = "" if self.si_unit == "1" else f" {self.si_unit}"
        return f"a finite number from {self.low:g} to {self.high:g}{unit}"

    def holds(self, value: float) -> bool:
        """Whether a value [SI] is possible; NaN is not."""
        return self.low <= value <= self.high


def _stress(title: str, low: float, *, required: bool) -> Quantity:
    return Quantity(title=title, si_unit="Pa", units=_STRESS, low=low, high=1e12, required=required)


LAYER_QUANTITIES: Mapping[str, Quantity] = MappingProxyType(
    {
        "thickness": Quantity(title="thickness", si_unit="m", units=_LENGTH, low=1e-6, high=1.0),
        "young_modulus": _stress("Young's modulus", 1.0, required=True),
        # 0.4999, not 0.5: at 0.5 the bulk modulus is infinite and no compressible model can be built.
        "poisson_ratio": Quantity(title="Poisson's ratio", si_unit="1", units=_RATIO, low=0.0, high=0.4999),
        "density": Quantity(title="density", si_unit="kg/m3", units=_DENSITY, low=50.0, high=25e3),
        "prestress_x": _stress("prestress along x", 0.0, required=False),
        "prestress_y": _stress("prestress along y", 0.0, required=False),
        "loss_factor": Quantity(
            title="loss factor", si_unit="1", units=_RATIO, low=0.0, high=10.0, required=False
        ),
        "loss_frequency": Quantity(
            title="loss frequency",
            si_unit="Hz",
            units={"Hz": 1.0, "kHz": 1e3},
            low=1e-4,
            high=1e6,
            required=False,
        ),
        "tensile_strength": _stress("tensile strength", 1.0, required=False),
    }
)
"""What a layer of a tissue states, by key."""

BONDED_KEYS = (("prestress_x", "prestress_y"), ("loss_factor", "loss_frequency"))
"""Keys that mean nothing alone: stating one asks for the other."""


def _printed(title: str, si_unit: str, unit: str, factor: float) -> Quantity:
    return Quantity(title=title, si_unit=si_unit, units={unit: factor}, low=0.0, high=1e12)


PAPER_QUANTITIES: Mapping[str, Quantity] = MappingProxyType(
    {
        "side": _printed("side", "m", "mm", MILLIMETRE),
        "area": _printed("area", "m2", "mm2", MILLIMETRE**2),
        "thickness": _printed("thickness", "m", "mm", MILLIMETRE),
        "volume": _printed("volume", "m3", "mm3", MILLIMETRE**3),
        "weight_per_area": _printed("weight per area", "kg/m2", "g/mm2", _GRAM / MILLIMETRE**2),
        "weight": _printed("weight", "kg", "g", _GRAM),
        "density": _printed("density", "kg/m3", "g/m3", _GRAM),
        "density_per_mm3": _printed("density, per mm3", "kg/m3", "g/mm3", _GRAM / MILLIMETRE**3),
        "prestress_along": _printed("prestress along the fibres", "Pa", "MPa", MEGAPASCAL),
        "prestress_across": _printed("prestress across the fibres", "Pa", "MPa", MEGAPASCAL),
        "prestress": _printed("prestress", "Pa", "MPa", MEGAPASCAL),
        "tension": _printed("tension", "N/m", "N/m", 1.0),
    }
)
"""What Table 1 of the 2014 paper states of the dermis, by key, in the units printed there."""
