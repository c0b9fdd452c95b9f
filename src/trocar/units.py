"""Where values cross a border: the factors between SI and the units people write.

Inside, everything is SI. Multiply by one of these when reading a file or an argument, divide when printing.
"""

from __future__ import annotations

from math import pi

MILLIMETRE = 1e-3  # [m]
KILOPASCAL = 1e3  # [Pa]
MEGAPASCAL = 1e6  # [Pa]
MILLISECOND = 1e-3  # [s]
DEGREE = pi / 180.0  # [rad]
