"""Classical rubber: Treloar pulled it one way, Kawabata two ways at once.

L. R. G. Treloar 1944, Trans. Faraday Soc. 40:59 (8 % sulphur, 20 C; its figure 3); S. Kawabata, M. Matsuda, K. Tei and
H. Kawai 1981, Macromolecules 14:154 (isoprene rubber). Two rubbers, not one.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from trocar.model import FloatArray
from trocar.study.measured.table import read_measured_table
from trocar.units import MEGAPASCAL

FOLDER = "rubber_treloar_kawabata_mit"


@dataclass(frozen=True, kw_only=True)
class Rubber:
    """Both measurements.

    Args:
        stretch: of the uniaxial one [1], shape (n,).
        stress: nominal [Pa], shape (n,).
        stretches: of the biaxial one along both axes [1], shape (m, 2).
        stresses: nominal, likewise [Pa], shape (m, 2).
    """

    stretch: FloatArray
    stress: FloatArray
    stretches: FloatArray
    stresses: FloatArray


def read_rubber(folder: Path) -> Rubber:
    """Read both.

    Raises:
        InputError: a table cannot be read or a number in it is impossible.
    """
    treloar = read_measured_table(folder / "treloar1944_uniaxial_fig3.csv", ("stretch", "nominal_stress_MPa"))
    kawabata = read_measured_table(
        folder / "kawabata1981_biaxial.csv",
        ("lambda1", "lambda2", "nominal_stress1_MPa", "nominal_stress2_MPa"),
    )
    return Rubber(
        stretch=treloar.positive("stretch"),
        stress=treloar.numbers("nominal_stress_MPa", MEGAPASCAL),
        stretches=np.column_stack([kawabata.positive(f"lambda{axis}") for axis in (1, 2)]),
        stresses=np.column_stack(
            [kawabata.numbers(f"nominal_stress{axis}_MPa", MEGAPASCAL) for axis in (1, 2)]
        ),
    )
