"""Silicones of soft robots pulled until they fail: stretch against nominal stress.

L. Marechal et al. 2020, Soft Robotics, 10.1089/soro.2019.0115 (ODbL). One curve a material; the strain is that of the
crossheads, which makes the material look softer than it is. The times are not read: one of the files miscounts them.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from trocar.errors import InputError
from trocar.model import FloatArray
from trocar.study.measured.table import read_measured_table
from trocar.units import MEGAPASCAL

FOLDER = "soft_robotics_elastomers_odbl"


@dataclass(frozen=True, kw_only=True)
class Pull:
    """One material pulled once.

    Args:
        material: its trade name.
        stretch: [1], shape (n,).
        stress: nominal [Pa], shape (n,).
    """

    material: str
    stretch: FloatArray
    stress: FloatArray


def read_pulls(folder: Path) -> tuple[Pull, ...]:
    """Read every material in `data/` of the set's folder.

    Raises:
        InputError: a table cannot be read, or there is none.
    """
    paths = sorted(folder.glob("data/*.csv"))
    if not paths:
        raise InputError(str(folder / "data"), "tables of materials such as Ecoflex_00-30.csv", "none")
    return tuple(read_pull(path) for path in paths)


def read_pull(path: Path) -> Pull:
    """Read one material.

    Raises:
        InputError: the table cannot be read.
    """
    table = read_measured_table(
        path,
        ("Engineering Strain", "Engineering Stress (MPa)"),
        delimiter=";",
        least_rows=10,
    )
    return Pull(
        material=path.stem.replace("_", " "),
        stretch=1.0 + table.numbers("Engineering Strain"),
        stress=table.numbers("Engineering Stress (MPa)", MEGAPASCAL),
    )
