"""Limbs of people indented with an ultrasound probe: force, thicknesses of skin, fat and muscle, indentation.

MULTIS (A. Erdemir, M. L. Neumann 2018), summarised a trial a row by S. Doherty (UltrasoundML, MIT). Forces and
thicknesses are of the moment of the largest force; the probe was held by hand and there are no curves.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from trocar.model import FloatArray
from trocar.study.measured.table import read_measured_table
from trocar.units import MILLIMETRE

FOLDER = "multis_limb_indentation_mit"
TABLE = "multis_layers_indentation.csv"
LAYERS = ("Skin", "Fat", "Muscle")
_GAPS = ("TotalStrain", "Thickness", *LAYERS)


@dataclass(frozen=True, kw_only=True)
class Indentations:
    """Trials that have all their thicknesses.

    Args:
        subjects: who, shape (n,).
        sites: where, as LA_A: lower arm, anterior; shape (n,).
        force: largest [N], shape (n,).
        area: of the probe's face [m2], shape (n,).
        thickness: of skin, fat and muscle at rest [m], shape (n, 3).
        indentation: at the largest force [m], shape (n,).
        incomplete: how many trials lack a thickness or the indentation, and are left out.
    """

    subjects: tuple[str, ...]
    sites: tuple[str, ...]
    force: FloatArray
    area: FloatArray
    thickness: FloatArray
    indentation: FloatArray
    incomplete: int

    @property
    def strain(self) -> FloatArray:
        """Indentation over the thickness of all layers [1], shape (n,)."""
        return np.asarray(self.indentation / self.thickness.sum(axis=1))

    @property
    def radius(self) -> FloatArray:
        """Of a disc as large as the probe's face [m], shape (n,)."""
        return np.asarray(np.sqrt(self.area / np.pi))


def read_limbs(folder: Path) -> Indentations:
    """Read the set.

    Raises:
        InputError: the table cannot be read or a number in it is impossible.
    """
    table = read_measured_table(
        folder / TABLE, ("probe_area_mm2", "SubID", "Location", "MaxForce", *_GAPS), gaps=_GAPS
    )
    layers = np.column_stack([table.positive(layer, MILLIMETRE) for layer in LAYERS])
    total, strain = table.positive("Thickness", MILLIMETRE), table.positive("TotalStrain")
    whole = np.isfinite(layers).all(axis=1) & np.isfinite(total) & np.isfinite(strain)
    return Indentations(
        subjects=tuple(np.array(table.cells["SubID"])[whole]),
        sites=tuple(np.array(table.cells["Location"])[whole]),
        force=table.positive("MaxForce")[whole],
        area=table.positive("probe_area_mm2", MILLIMETRE**2)[whole],
        thickness=layers[whole],
        indentation=(total * strain)[whole],
        incomplete=int(np.count_nonzero(~whole)),
    )
