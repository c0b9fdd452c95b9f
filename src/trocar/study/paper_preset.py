"""The paper's formula as printed, beside what its own equations give when they are followed.

Printed: u = B11 cos(lambda11 t) sin(pi x/a) sin(pi y/b), equation 5. Corrected: equations 1 to 3 with the factor
4/(a b), a shape that is zero on the fixed boundary, tensions that are stress times thickness, and a density of skin.

Source: Patel and Suthakorn, equations 1 to 5 and Table 1; see `trocar.waves.paper`.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, sqrt

import numpy as np

from trocar.model import FloatArray
from trocar.waves.membrane import WaveMembrane
from trocar.waves.paper import (
    SHAPE_FACTOR,
    coefficient_11,
    corrected_membrane,
    corrected_start,
    printed_membrane,
    printed_start,
)
from trocar.waves.state import WaveState

SAMPLES = 401
SWINGS = 2.5  # periods of the lowest mode that are followed


@dataclass(frozen=True, kw_only=True)
class Swing:
    """One membrane let go from its start.

    Attributes:
        b11: amplitude of the lowest mode at the start [m].
        lambda11: its angular frequency [rad/s]; for the printed formula a plain number the paper reads so.
        speed_along, speed_across: of waves along x and y [m/s]; likewise.
        tension_along, tension_across: [N/m]; likewise.
        areal_density: [kg/m2]; likewise.
        peak: largest displacement at the start [m].
        on_boundary: displacement of the start's shape at the middle of a fixed side [m].
        modes: how many the series has.
        time: [s], shape (n,).
        centre: displacement of the middle [m], shape (n,).
    """

    b11: float
    lambda11: float
    speed_along: float
    speed_across: float
    tension_along: float
    tension_across: float
    areal_density: float
    peak: float
    on_boundary: float
    modes: int
    time: FloatArray
    centre: FloatArray

    @property
    def period(self) -> float:
        """Period of the lowest mode [s]."""
        return 2 * pi / self.lambda11


@dataclass(frozen=True, kw_only=True)
class PaperStudy:
    """The paper's formula, printed and corrected.

    Attributes:
        b11_with_factor: equation 4 as it is written, factor 4/(a b) included, for the printed shape [m].
        printed, corrected: both let go.
    """

    b11_with_factor: float

    printed: Swing
    corrected: Swing


def run_paper_study() -> PaperStudy:
    """Follow both membranes through a few periods of their lowest mode."""
    printed, corrected = printed_membrane(), corrected_membrane()
    a, b = printed.size
    rim = SHAPE_FACTOR * a * (1 - a) * (b / 2) * (1 - b / 2)  # equation 4's f at x = a, y = b/2
    return PaperStudy(
        b11_with_factor=coefficient_11(printed.size),
        printed=_swing(printed, printed_start(printed), rim),
        corrected=_swing(corrected, corrected_start(corrected), 0.0),
    )


def _swing(model: WaveMembrane, start: WaveState, on_boundary: float) -> Swing:
    (sheet,) = model.stack.sheets
    a, b = model.size
    lambda11 = pi * sqrt((sheet.tension_x / a**2 + sheet.tension_y / b**2) / sheet.areal_density)
    middle = np.array([[a / 2, b / 2, 0.0]])
    time = np.linspace(0.0, SWINGS * 2 * pi / lambda11, SAMPLES)
    centre = np.empty(SAMPLES)
    for i, moment in enumerate(time):  # each from the start: the step is exact, so nothing adds up
        state = model.step(start, (), (), float(moment)) if i else start
        centre[i] = model.displacement(state, middle)[0, 2]
    return Swing(
        b11=float(model.amplitudes(start)[1, 1]),
        lambda11=lambda11,
        speed_along=sqrt(sheet.tension_x / sheet.areal_density),
        speed_across=sqrt(sheet.tension_y / sheet.areal_density),
        tension_along=float(sheet.tension_x),
        tension_across=float(sheet.tension_y),
        areal_density=sheet.areal_density,
        peak=float(np.abs(centre[0])),
        on_boundary=on_boundary,
        modes=model.modes[0] * model.modes[1],
        time=time,
        centre=centre,
    )
