"""Whether a record and a case can belong together: columns exchanged, units a thousand off, nothing left to fit."""

from __future__ import annotations

import numpy as np

from trocar.errors import InputError
from trocar.model import FloatArray
from trocar.study.calibration.fit import Problem
from trocar.study.calibration.reading import FEWEST_ROWS
from trocar.tissues.key_table import Words
from trocar.units import MILLIMETRE

_FAR = 300.0  # a start whose compliance is this many times off is a wrong unit, or no start
_ODD = 20.0  # one this far off is looked at twice: are the columns exchanged?
_NEAR = 3.0  # exchanged, it would be this near
_LEAST_CHANGE = 0.1  # of the largest force, within the rows that are fitted


def check_seen(problem: Problem) -> None:
    """Refuse a fit of too few rows, or of rows in which the force stands still.

    Raises:
        InputError: that is so.
    """
    seen = problem.used[problem.probes.parts[0]]
    least = max(FEWEST_ROWS, 2 * len(problem.parameters))
    where = problem.measurement.source
    if seen.sum() < least:
        raise InputError(
            where, f"at least {least} rows to fit", int(seen.sum()), "hold out less, or measure more often"
        )
    if (
        np.ptp(problem.measurement.force[seen]) < _LEAST_CHANGE * problem.measurement.peak
        and not problem.zeroed
    ):
        raise InputError(
            where,
            "a force that changes by a tenth of the largest in the rows that are fitted",
            Words("a force that stands still"),
            "hold out less, record the ramp too, or say --zeroed where the displacement's zero is true",
        )


def check_scale(problem: Problem, rows: FloatArray) -> None:
    """Refuse columns that look exchanged, and units that look a thousand off.

    Args:
        problem: with the measurement.
        rows: predicted at the start [m].

    Raises:
        InputError: that is so.
    """
    part = problem.probes.parts[0]
    measurement = problem.measurement
    depth, force = measurement.series[0].value, measurement.force
    measured, expected = np.ptp(depth) / np.ptp(force), np.ptp(rows[part]) / np.ptp(force)
    times = measured / expected
    if 1 / _ODD < times < _ODD:
        return
    exchanged = MILLIMETRE * np.ptp(force) / (np.ptp(depth) / MILLIMETRE) / expected
    where = f"{measurement.source}: displacement_mm"
    said = Words(f"{measured / MILLIMETRE:.3g} mm a newton, {times:.2g} times that")
    wanted = f"about {expected / MILLIMETRE:.3g} mm a newton, as the case file's layers give"
    if 1 / _NEAR < exchanged < _NEAR:
        raise InputError(
            where,
            wanted,
            said,
            "the columns of force and displacement look exchanged: name them the other way round; if not, write "
            "moduli nearer to the truth into the case file",
        )
    if not 1 / _FAR < times < _FAR:
        raise InputError(
            where,
            wanted,
            said,
            "is a unit a thousand off (micrometres, metres, millinewtons)? If not, write moduli nearer to the truth "
            "into the case file",
        )
