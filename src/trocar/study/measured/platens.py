"""Force on the platens for a unit shear modulus and unit area, as a function of Ogden's exponent and the compression.

Between faces that slide the disc stays a cylinder and the answer is closed; between faces that are held it comes from
axially symmetric finite elements, computed at a few exponents and drawn through them with splines. Neo-Hookean is the
exponent 2. A linear model has one stiffness at every compression.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from scipy.interpolate import CubicSpline, PchipInterpolator

from trocar.errors import SolverError
from trocar.model import FloatArray
from trocar.reference.cylinder import Cylinder
from trocar.study.measured.homogeneous import uniaxial
from trocar.tissues.law import Ogden

EXPONENTS = (1.0, 2.0, 3.0, 4.5)
STRAINS = np.concatenate([[0.005], np.linspace(0.035, 0.665, 19), [0.67]])
BULK = 1000.0  # of mu: silicone hardly changes its volume; four times more moves the force by less than 0.5 %


class Faces(StrEnum):
    """Whether the faces of a disc slide on the platens."""

    FREE = "free"
    BONDED = "bonded"


@dataclass(frozen=True, kw_only=True)
class Platens:
    """Force over mu and area of one shape of disc [1].

    Args:
        shape: radius over height.
        table: with held faces, shape (exponents, strains).
        stiffness: with held faces, force over mu, area and strain as the strain becomes small.
    """

    shape: float
    table: FloatArray
    stiffness: float

    def force(self, faces: Faces, exponent: float, strain: FloatArray) -> FloatArray:
        """Return the force over mu and area [1], shape (n,).

        Args:
            faces: held or free.
            exponent: Ogden's; for held faces within `EXPONENTS`, beyond which the nearest is taken.
            strain: compression over height [1], below 0.67 for held faces; shape (n,).
        """
        if faces is Faces.FREE:
            return -uniaxial(Ogden(terms=((1.0, exponent),)), 1.0, 1.0 - strain)
        within = float(np.clip(exponent, EXPONENTS[0], EXPONENTS[-1]))
        at_exponent = CubicSpline(EXPONENTS, self.table)(within)
        shares = PchipInterpolator(STRAINS, at_exponent / STRAINS)  # near rest nearly constant
        return np.asarray(shares(np.clip(strain, STRAINS[0], STRAINS[-1])) * strain)

    def linear_force(self, faces: Faces, strain: FloatArray) -> FloatArray:
        """Return what a linear model answers, of mu and area [1], shape (n,)."""
        return (3.0 if faces is Faces.FREE else self.stiffness) * strain


def platens(
    shape: float, watch: Callable[[float], None] = lambda _share: None, *, bulk: float = BULK
) -> Platens:
    """Compute the table of one shape of disc.

    Args:
        shape: radius over height.
        watch: told the share that is done.
        bulk: modulus over mu of the held disc [1].

    Raises:
        SolverError: the disc could not be followed to two thirds of its height.
    """
    rows, stiffness = [], 0.0
    for number, exponent in enumerate(EXPONENTS):
        disc = Cylinder(
            radius=shape,
            height=1.0,
            law=Ogden(terms=((1.0, exponent),)),
            shear_modulus=1.0,
            bulk_modulus=bulk,
            bonded=True,
        )
        curve = disc.press(STRAINS)
        if curve.stopped:
            raise SolverError(
                f"a bonded disc with Ogden's exponent {exponent:g} could be pressed by "
                f"{100 * curve.strain[-1]:.0f} % and no more: {curve.stopped}"
            )
        rows.append(curve.force / (np.pi * shape**2))
        stiffness = disc.linear_stiffness / (np.pi * shape**2)
        watch((number + 1) / len(EXPONENTS))
    return Platens(shape=shape, table=np.array(rows), stiffness=stiffness)
