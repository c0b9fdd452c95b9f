"""One silicone in two laboratories: the shear modulus of a grade pressed and of the same grade pulled.

What two laboratories make of one material is the least by which an absolute modulus is uncertain, whatever model.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from trocar.study.measured.elastomer import Pull
from trocar.study.measured.fit import fit_neo_hookean
from trocar.study.measured.homogeneous import uniaxial
from trocar.study.measured.platens import Faces
from trocar.study.measured.pressed import Model, PhantomResults

_SAME = {"EF10_0T": "Ecoflex 00-10", "EF30_0T": "Ecoflex 00-30", "EF50_0T": "Ecoflex 00-50"}
_PULLED = (1.02, 2.0)  # stretch between which a pulled grade is fitted


@dataclass(frozen=True, kw_only=True)
class Grade:
    """Neo-Hookean shear moduli of one grade.

    Args:
        name: its trade name.
        free: pressed, the faces taken to slide [Pa].
        bonded: pressed, the faces taken to be held [Pa].
        pulled: in tension [Pa].
    """

    name: str
    free: float
    bonded: float
    pulled: float


def compare_grades(pressed: PhantomResults, pulls: Sequence[Pull]) -> tuple[Grade, ...]:
    """Return the grades that both sets hold without thinner."""
    pulled = {pull.material: pull for pull in pulls}
    moduli = {
        faces: {disc.composition: disc.shear_modulus for disc in pressed.of(faces, Model.NEO_HOOKEAN)}
        for faces in Faces
    }
    found = []
    for composition, name in _SAME.items():
        if name not in pulled or composition not in moduli[Faces.FREE]:
            continue
        pull = pulled[name]
        rows = (pull.stretch >= _PULLED[0]) & (pull.stretch <= _PULLED[1])
        stretch = pull.stretch[rows]
        if not stretch.size:
            continue
        fitted = fit_neo_hookean(lambda law, mu, at=stretch: uniaxial(law, mu, at), pull.stress[rows])  # type: ignore[misc]
        found.append(
            Grade(
                name=name,
                free=moduli[Faces.FREE][composition],
                bonded=moduli[Faces.BONDED][composition],
                pulled=fitted.shear_modulus,
            )
        )
    return tuple(found)
