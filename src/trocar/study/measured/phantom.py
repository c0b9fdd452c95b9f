"""Silicone phantoms pressed between platens: discs of Ecoflex with thinner, compression against load.

Dawood et al. 2026, "Hyperelastic Characterisation of Silicone Tissue Phantoms" (data CC BY 4.0). Two specimens of each
composition, A and B. Whether the platens were lubricated is not stated, so the faces of a disc may have been free to
slide, held, or between the two.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from math import pi
from pathlib import Path

from trocar.errors import InputError
from trocar.model import FloatArray
from trocar.study.measured.table import MeasuredTable, read_measured_table
from trocar.units import MILLIMETRE

FOLDER = "ecoflex_phantom_compression_ccby"
COLUMNS = ("Time (s)", "Compression (mm)", "Load (N)")
LEAST_STRAIN = 0.66
"""Compression over height that a disc must reach [1]: laws are judged to two thirds."""

_NAME = re.compile(r"(EF\d+_[\d_]+T)_([AB])\d+")


@dataclass(frozen=True, kw_only=True)
class Compression:
    """One disc pressed once.

    Args:
        composition: grade and share of thinner, as EF10_50T.
        specimen: "A" or "B".
        diameter: of the disc [m].
        height: at rest [m].
        compression: how much lower it became [m], shape (n,).
        load: it bore [N], shape (n,).
    """

    composition: str
    specimen: str
    diameter: float
    height: float
    compression: FloatArray
    load: FloatArray

    @property
    def strain(self) -> FloatArray:
        """Compression over height [1], shape (n,)."""
        return self.compression / self.height

    @property
    def area(self) -> float:
        """Of a face at rest [m2]."""
        return pi / 4 * self.diameter**2


def read_compression(path: Path) -> Compression:
    """Read one disc.

    Raises:
        InputError: the file's name, its preamble or a row is not what its authors write.
    """
    name = _NAME.fullmatch(path.stem)
    if name is None:
        raise InputError(
            path.name, "a name such as EF10_50T_A1.csv", path.stem, "name composition, specimen and repeat"
        )
    table = read_measured_table(path, COLUMNS)
    table.rising("Time (s)")
    disc = Compression(
        composition=name[1],
        specimen=name[2],
        diameter=_length(table, "Cylinder Diameter"),
        height=_length(table, "Cylinder Height"),
        compression=table.numbers("Compression (mm)", MILLIMETRE),
        load=table.numbers("Load (N)"),
    )
    if not LEAST_STRAIN <= disc.strain.max() < 1:
        raise InputError(
            path.name,
            f"a compression that reaches {100 * LEAST_STRAIN:.0f} % of the height",
            f"{100 * disc.strain.max():.3g} %",
            "take the disc out of the folder",
        )
    return disc


def read_phantoms(folder: Path) -> tuple[Compression, ...]:
    """Read every disc in `data/` of the set's folder, by grade and share of thinner.

    Raises:
        InputError: as `read_compression`, or there is no file.
    """
    paths = sorted(folder.glob("data/*.csv"))
    if not paths:
        raise InputError(str(folder / "data"), "tables of discs such as EF10_50T_A1.csv", "none")
    return tuple(sorted((read_compression(path) for path in paths), key=_order))


def thinner(composition: str) -> float:
    """Return the share of thinner in a composition's name [%]."""
    return float(composition.split("_", 1)[1].rstrip("T").replace("_", "."))


def _order(disc: Compression) -> tuple[str, float, str]:
    return disc.composition.split("_")[0], thinner(disc.composition), disc.specimen


def _length(table: MeasuredTable, key: str) -> float:
    for number, line in enumerate(table.preamble, start=1):
        found = re.match(rf"{key}:\s*(\S+?)\s*mm", line)
        if found:
            try:
                value = float(found[1])
            except ValueError:
                value = 0.0
            if not 0 < value < 1e4:
                raise InputError(f"{table.file}, line {number}, {key}", "a length above 0 mm", found[1])
            return value * MILLIMETRE
    raise InputError(table.file, f"a line '{key}: ... mm' above the head", "none", "write it there")
