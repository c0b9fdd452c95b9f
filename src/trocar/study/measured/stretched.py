"""Rubber foretold: laws fitted to Treloar's rubber pulled one way, judged on Kawabata's pulled two ways.

No tissue, but the classical check of the code of a law: what is fitted in one dimension must hold in two. They are two
rubbers, so a part of the difference is theirs.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from trocar.errors import InputError
from trocar.model import FloatArray
from trocar.study.measured.fit import Fitted, fit_neo_hookean, fit_ogden
from trocar.study.measured.homogeneous import biaxial, uniaxial
from trocar.study.measured.rubber import Rubber
from trocar.tissues.law import Ogden

SMALL = 1.5  # stretch up to which neo-Hookean is fitted and judged
_FLOOR = 0.1  # of the largest stress: below it errors count absolutely, above it relatively
_TERMS: dict[int, tuple[tuple[float, float], ...]] = {
    1: ((3e5, 1.5),),
    2: ((4e5, 1.3), (1e3, 5.0)),
}
# R. W. Ogden 1972, table of sec. 6, for Treloar's three experiments: his mu_i [kgf/cm2] and alpha_i
_OGDEN_1972 = ((6.3, 1.3), (0.012, 5.0), (-0.1, -2.0))
_KGF_CM2 = 98066.5  # [Pa]


@dataclass(frozen=True, kw_only=True)
class FittedRubber:
    """One law on both rubbers; errors are root mean squares of difference over stress, both root mean squares.

    Args:
        name: of the law.
        fitted: the law and its modulus.
        stretch: up to which it was fitted and judged [1].
        uniaxial: error on Treloar's rubber [1].
        biaxial: on Kawabata's, both stresses [1].
        median: of the relative error there, stresses above a twentieth of a megapascal [1].
        points: how many of Kawabata's points were judged.
    """

    name: str
    fitted: Fitted
    stretch: float
    uniaxial: float
    biaxial: float
    median: float
    points: int


def foretell_rubber(rubber: Rubber) -> tuple[FittedRubber, ...]:
    """Fit neo-Hookean and Ogden laws of one and two terms to Treloar; judge them, and Ogden's own, on Kawabata.

    Raises:
        InputError: no stretch is small enough for neo-Hookean.
    """
    small = rubber.stretch <= SMALL
    if not small.any() or not (rubber.stretches <= SMALL).all(axis=1).any():
        raise InputError("rubber", f"stretches up to {SMALL:g} in both experiments", "none")
    near = rubber.stretch[small]
    found = [
        _judged(
            "neo-Hookean",
            fit_neo_hookean(lambda law, mu: uniaxial(law, mu, near), rubber.stress[small]),
            rubber,
            SMALL,
        )
    ]
    limit = float(rubber.stretch.max())
    for count, start in _TERMS.items():
        fitted = fit_ogden(
            lambda law, mu: uniaxial(law, mu, rubber.stretch), rubber.stress, start, floor=_FLOOR
        )
        found.append(_judged(f"Ogden, {count} term{'s' * (count > 1)}", fitted, rubber, limit))
    found.append(_judged("Ogden as of 1972", _ogden_1972(_OGDEN_1972), rubber, limit))
    return tuple(found)


def _judged(name: str, fitted: Fitted, rubber: Rubber, limit: float) -> FittedRubber:
    one = rubber.stretch <= limit
    two = (rubber.stretches <= limit).all(axis=1)
    measured = rubber.stresses[two]
    off = biaxial(fitted.law, fitted.shear_modulus, rubber.stretches[two]) - measured
    clear = measured > 5e4
    return FittedRubber(
        name=name,
        fitted=fitted,
        stretch=limit,
        uniaxial=_relative(
            uniaxial(fitted.law, fitted.shear_modulus, rubber.stretch[one]) - rubber.stress[one],
            rubber.stress[one],
        ),
        biaxial=_relative(off, measured),
        median=float(np.median(np.abs(off[clear] / measured[clear]))),
        points=int(np.count_nonzero(two)),
    )


def _ogden_1972(terms: Sequence[tuple[float, float]]) -> Fitted:
    moduli = np.array([0.5 * his * alpha * _KGF_CM2 for his, alpha in terms])
    mu = float(moduli.sum())
    law = Ogden(terms=tuple((float(one / mu), alpha) for one, (_, alpha) in zip(moduli, terms, strict=True)))
    return Fitted(law=law, shear_modulus=mu)


def _relative(off: FloatArray, measured: FloatArray) -> float:
    return float(np.sqrt((off**2).mean() / (measured**2).mean()))
