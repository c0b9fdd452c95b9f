"""Which numbers a case may hold besides those of laws and memory: key, unit and possible range, in one table."""

from __future__ import annotations

from trocar.tissues.key_quantity import KeyQuantity
from trocar.units import DEGREE, KILOPASCAL, MILLIMETRE

SIDE = KeyQuantity(name="size", key="size_mm", unit="mm", factor=MILLIMETRE, low=1, high=1000)

SPACING = KeyQuantity(name="spacing", key="spacing_mm", unit="mm", factor=MILLIMETRE, low=0.01, high=1000)

THICKNESS = KeyQuantity(
    name="thickness", key="thickness_mm", unit="mm", factor=MILLIMETRE, low=0.001, high=1000,
    advice="a layer is between a micrometre and a metre thick",
)  # fmt: skip
YOUNG_MODULUS = KeyQuantity(
    name="young_modulus", key="young_modulus_kpa", unit="kPa", factor=KILOPASCAL, low=1e-3, high=1e9
)
POISSON_RATIO = KeyQuantity(
    name="poisson_ratio", key="poisson_ratio", unit="", factor=1.0, low=0, high=0.4999,
    advice="it must stay below 0.5; use 0.499 for nearly incompressible tissue",
)  # fmt: skip
DENSITY = KeyQuantity(
    name="density", key="density_kg_m3", unit="kg/m3", factor=1.0, low=1, high=30000,
    advice="soft tissue is about 900 to 1200 kg/m3",
)  # fmt: skip
PRESTRESS = KeyQuantity(
    name="prestress", key="prestress_kpa", unit="kPa", factor=KILOPASCAL, low=0, high=1e6, default=0.0,
    advice="tension is positive; a layer in compression could buckle",
)  # fmt: skip
LOSS_FACTOR = KeyQuantity(
    name="loss_factor", key="loss_factor", unit="", factor=1.0, low=0, high=100, default=0.0
)
LOSS_FREQUENCY = KeyQuantity(
    name="loss_frequency", key="loss_frequency_hz", unit="Hz", factor=1.0, low=1e-3, high=1e6, default=50.0
)
LAYER = (THICKNESS, YOUNG_MODULUS, POISSON_RATIO, DENSITY, LOSS_FACTOR, LOSS_FREQUENCY)

DIAMETER = KeyQuantity(name="diameter", key="diameter_mm", unit="mm", factor=MILLIMETRE, low=0.01, high=1000)
POSITION = KeyQuantity(name="position", key="position_mm", unit="mm", factor=MILLIMETRE, low=0, high=1000)
TILT = KeyQuantity(
    name="tilt", key="tilt_deg", unit="deg", factor=DEGREE, low=0, high=90, high_open=True, default=0.0,
    advice="0 is upright; turn azimuth_deg instead of using a negative tilt",
)  # fmt: skip
AZIMUTH = KeyQuantity(
    name="azimuth", key="azimuth_deg", unit="deg", factor=DEGREE, low=-360, high=360, default=0.0
)
PEAK = KeyQuantity(name="peak", key="peak_n", unit="N", factor=1.0, low=1e-6, high=1e5)
RATE = KeyQuantity(name="rate", key="rate_n_s", unit="N/s", factor=1.0, low=1e-9, high=1e9)
HOLD = KeyQuantity(name="hold", key="hold_s", unit="s", factor=1.0, low=0, high=1e5, default=0.0)
TOOL = (DIAMETER, TILT, AZIMUTH, PEAK, RATE, HOLD)

PERIOD = KeyQuantity(name="period", key="period_s", unit="s", factor=1.0, low=1e-6, high=1e5)

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
