"""A sow's tissues foretold: laws fitted to four animals together, judged on the fifth.

For each tissue an Ogden law of one term and a fibre law (a neo-Hookean matrix with fibres along the strip, stiffening
exponentially) are fitted to the geometric mean of the strips of four animals, up to the stretch that all five bear:
animals differ by factors, and the stiffest shall not count for all. The laws stand beside that mean itself, which no
law fitted to it can be expected to beat.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from trocar.model import FloatArray
from trocar.study.measured.fit import Fitted, fit_fibre, fit_ogden
from trocar.study.measured.homogeneous import uniaxial
from trocar.study.measured.strips import Strip
from trocar.tissues.law import Law

FITTED, JUDGED = ("pig04", "pig05", "pig07", "pig08"), "pig09"
_FROM, _FURTHEST = 1.02, 1.5  # stretch: below it slack, above it few strips
_POINTS = 40
_FLOOR = 0.2  # of the largest stress: below it errors count absolutely, above it relatively
_LEAST = 1e-3  # of a strip's largest stress: what slack counts as
_START_OGDEN = ((2e4, 8.0),)
_START_FIBRE = (2e4, 2e4, 1.0)


@dataclass(frozen=True, kw_only=True)
class ForetoldStrip:
    """One tissue.

    Args:
        tissue: its name.
        limit: stretch up to which it was fitted and judged [1].
        stretch: where [1], shape (n,).
        others: stress of the animals that were fitted to [Pa], shape (animals, n).
        measured: of the one that was judged [Pa], shape (n,).
        laws: Ogden's and the fibre law, by name.
        foretold: their stress [Pa], by name; and "mean of the others".
        errors: root mean square difference over root mean square stress of each [1].
    """

    tissue: str
    limit: float
    stretch: FloatArray
    others: FloatArray
    measured: FloatArray
    laws: dict[str, Fitted]
    foretold: dict[str, FloatArray]
    errors: dict[str, float]


def foretell_strips(strips: Sequence[Strip]) -> tuple[ForetoldStrip, ...]:
    """Fit and judge every tissue of which strips of the judged animal and of another are there."""
    found = []
    for tissue in dict.fromkeys(strip.tissue for strip in strips):
        own = {strip.animal: strip for strip in strips if strip.tissue == tissue}
        fitted = [own[animal] for animal in FITTED if animal in own]
        if fitted and JUDGED in own:
            found.append(_foretold(tissue, fitted, own[JUDGED]))
    return tuple(found)


def _foretold(tissue: str, fitted: Sequence[Strip], judged: Strip) -> ForetoldStrip:
    limit = min(_FURTHEST, *(float(strip.stretch[-1]) for strip in (*fitted, judged)))
    stretch = np.linspace(_FROM, limit, _POINTS)
    others = np.array([np.interp(stretch, strip.stretch, strip.stress) for strip in fitted])
    measured = np.interp(stretch, judged.stretch, judged.stress)
    mean = np.exp(np.log(np.maximum(others, _LEAST * others.max(axis=1, keepdims=True))).mean(axis=0))

    def respond(law: Law, mu: float) -> FloatArray:
        return uniaxial(law, mu, stretch)

    laws = {
        "Ogden": fit_ogden(respond, mean, _START_OGDEN, floor=_FLOOR),
        "fibre": fit_fibre(respond, mean, start=_START_FIBRE, floor=_FLOOR),
    }
    foretold = {name: uniaxial(one.law, one.shear_modulus, stretch) for name, one in laws.items()}
    foretold["mean of the others"] = mean
    return ForetoldStrip(
        tissue=tissue,
        limit=limit,
        stretch=stretch,
        others=others,
        measured=measured,
        laws=laws,
        foretold=foretold,
        errors={
            name: float(np.sqrt(((stress - measured) ** 2).mean() / (measured**2).mean()))
            for name, stress in foretold.items()
        },
    )
