"""Strips of a sow's perineum pulled until they tear: stretch against nominal stress.

S. Iaquinta (perineal_indentation, GPL-3.0): skin, mucosae and sphincters of five sows, one strip each. The stretch is
that of the grips; slack at no load is not removed. Rows past the largest force are tearing.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from trocar.errors import InputError
from trocar.model import FloatArray
from trocar.study.measured.table import read_measured_table
from trocar.units import KILOPASCAL

FOLDER = "sow_perineum_tension_gpl3"
_LEAST_ROWS = 10
_NAME = re.compile(r"(pig\d+)_(\w+)")


@dataclass(frozen=True, kw_only=True)
class Strip:
    """One strip, up to its largest force.

    Args:
        animal: as pig04.
        tissue: as "skin" or "vaginal mucosa".
        stretch: [1], shape (n,).
        stress: nominal [Pa], shape (n,).
    """

    animal: str
    tissue: str
    stretch: FloatArray
    stress: FloatArray


def read_strip(path: Path) -> Strip:
    """Read one strip.

    Raises:
        InputError: the file's name or a row is not what it should be.
    """
    name = _NAME.fullmatch(path.stem)
    if name is None:
        raise InputError(path.name, "a name such as pig04_skin.csv", path.stem, "name animal and tissue")
    table = read_measured_table(path, ("time_s", "stretch", "nominal_stress_kPa"), least_rows=_LEAST_ROWS)
    table.rising("time_s")
    stress = table.numbers("nominal_stress_kPa", KILOPASCAL)
    before = slice(int(np.argmax(stress)) + 1)
    if before.stop < _LEAST_ROWS or not stress.max() > 0:
        raise InputError(
            path.name,
            f"{_LEAST_ROWS} rows or more up to the largest stress, which is above 0",
            f"{before.stop} rows",
            "tension counts positive",
        )
    return Strip(
        animal=name[1],
        tissue=name[2].replace("_", " "),
        stretch=table.positive("stretch")[before],
        stress=stress[before],
    )


def read_strips(folder: Path) -> tuple[Strip, ...]:
    """Read every strip in `data/` of the set's folder.

    Raises:
        InputError: as `read_strip`, or there is no file.
    """
    paths = sorted(folder.glob("data/*.csv"))
    if not paths:
        raise InputError(str(folder / "data"), "tables of strips such as pig04_skin.csv", "none")
    return tuple(read_strip(path) for path in paths)
