"""The 2014 paper's dermis as printed, and what its equations give when they are followed.

Printed (equations 4 and 5): one mode, u = B11 cos(lambda11 t) sin(pi x/a) sin(pi y/a), from Table 1's tension and
density taken as plain numbers, and a coefficient without the factor 4/(a b) of the paper's own equation 3.

Corrected: the whole series of equation 2, with equation 3's factor, from an initial shape that is zero on the fixed
boundary, a tension along and across the fibres that is stress times thickness, and a density of skin.

Source: Patel and Suthakorn, equations 1 to 5 and Table 1; Kreyszig, Advanced Engineering Mathematics, section 12.9.
"""

from __future__ import annotations

import numpy as np

from trocar.model import FloatArray
from trocar.tissues.catalogue import paper_table
from trocar.tissues.catalogue import tissue as preset
from trocar.waves.membrane import WaveMembrane
from trocar.waves.series import Series
from trocar.waves.stack import Coupling, Sheet, Stack
from trocar.waves.state import WaveState

SHAPE_FACTOR = 5.0  # of the initial shape in equation 4
_MODES = (40, 40)  # up to the width of the tool: 6 mm of 60 mm


def printed_membrane() -> WaveMembrane:
    """Return the paper's dermis with its numbers as plain numbers, one mode: lambda11 is then 0.686.

    The tension is not the rounded 1.54e-3 of Table 1 (that gives 0.685) but what it was rounded from.
    """
    table = paper_table()
    side = table["side"].si
    prestress = np.hypot(
        table["prestress_along"].value, table["prestress_across"].value
    )  # [MPa], as plain numbers
    sheet = Sheet(
        name="dermis",
        tension_x=prestress * side,
        tension_y=prestress * side,
        areal_density=table["density"].value,
    )
    return WaveMembrane(
        Stack(sheets=(sheet,), couplings=(Coupling(stiffness=0.0),)), size=(side, side), modes=(1, 1)
    )


def printed_start(model: WaveMembrane) -> WaveState:
    """Return the printed initial state: equation 4's integral, of a shape made for a unit square, without 4/(a b)."""
    a, b = model.size
    integral = coefficient_11((a, b)) * a * b / 4
    return model.released(
        displacement={"dermis": lambda x, y: integral * np.sin(np.pi * x / a) * np.sin(np.pi * y / b)}
    )


def coefficient_11(size: tuple[float, float]) -> float:
    """Return B11 of equation 3, factor 4/(a b) included, of the printed shape 5 x (1 - x) y (1 - y)."""
    table = Series(size, (1, 1)).coefficients(lambda x, y: SHAPE_FACTOR * x * (1 - x) * y * (1 - y))
    return float(table[1, 1])


def corrected_membrane() -> WaveMembrane:
    """Return the dermis with tension = prestress x thickness along and across, and a density of skin."""
    table = paper_table()
    side, thickness = table["side"].si, table["thickness"].si
    skin = preset("skin")
    sheet = Sheet(
        name="dermis",
        tension_x=table["prestress_along"].si * thickness,
        tension_y=table["prestress_across"].si * thickness,
        areal_density=skin.layers[skin.index("dermis")].density * thickness,
    )
    return WaveMembrane(
        Stack(sheets=(sheet,), couplings=(Coupling(stiffness=0.0),)), size=(side, side), modes=_MODES
    )


def corrected_start(model: WaveMembrane) -> WaveState:
    """Return the initial state of the shape 5 x (a - x) y (b - y), which does vanish on the boundary."""
    a, b = model.size

    def shape(x: FloatArray, y: FloatArray) -> FloatArray:
        result: FloatArray = SHAPE_FACTOR * x * (a - x) * y * (b - y)
        return result

    return model.released(displacement={"dermis": shape})
