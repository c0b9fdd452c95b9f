"""Silicone discs foretold: each law is fitted to one specimen up to 30 % and judged on all else.

What is fitted is the shear modulus, and Ogden's exponent where there is one, to specimen A of a composition, between
half a per cent and 30 %. What is judged is specimen A from there on and specimen B, of which nothing was fitted. It is
done twice, as if the platens let the faces slide and as if they held them: the truth lies between, and is not known.
The linear law is what every wave model of the project does between platens: one stiffness, at every compression.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from trocar.model import FloatArray
from trocar.study.measured.fit import positive_fit
from trocar.study.measured.phantom import Compression
from trocar.study.measured.platens import EXPONENTS, Faces, Platens, platens

FROM, CALIBRATED, LAST = 0.005, 0.30, 0.667
GROWTH_STRAINS = (0.02, 0.05, 0.10, 0.20, 0.30, 0.40, 0.50, 0.60, 0.66)
_NEO_HOOKEAN = 2.0
_START = 3.0


class Model(StrEnum):
    """What is fitted to a disc."""

    LINEAR = "linear"
    NEO_HOOKEAN = "neo-Hookean"
    OGDEN = "Ogden"


@dataclass(frozen=True, kw_only=True)
class PressedDisc:
    """One law, fitted to one composition between faces of one kind.

    Args:
        composition: its name.
        faces: held or free.
        model: the law.
        shear_modulus: fitted [Pa].
        exponent: fitted, Ogden's [1]; 2 for neo-Hookean.
        fitted: error where it was fitted [1]: root mean square difference of load over root mean square load.
        beyond: of the same specimen from 30 % on.
        other: of the other specimen up to 30 %.
        other_beyond: of the other specimen from 30 % on.
        growth: predicted over measured load, less 1, of the other specimen at `GROWTH_STRAINS` [1].
    """

    composition: str
    faces: Faces
    model: Model
    shear_modulus: float
    exponent: float
    fitted: float
    beyond: float
    other: float
    other_beyond: float
    growth: tuple[float, ...]


@dataclass(frozen=True, kw_only=True)
class Specimens:
    """How far two specimens of one composition lie apart, whatever model: B against A.

    Args:
        composition: its name.
        near: root mean square difference over root mean square load up to 30 % [1].
        beyond: from there on [1].
    """

    composition: str
    near: float
    beyond: float


@dataclass(frozen=True, kw_only=True)
class PhantomResults:
    """Every disc foretold.

    Args:
        discs: one for each composition, kind of faces and law.
        specimens: one for each composition.
        alone: compositions of which only one specimen is there; left out.
        platens: the table by shape of disc.
        measured: the discs that were used.
    """

    discs: tuple[PressedDisc, ...]
    specimens: tuple[Specimens, ...]
    alone: tuple[str, ...]
    platens: dict[float, Platens]
    measured: tuple[Compression, ...]

    def of(self, faces: Faces, model: Model) -> tuple[PressedDisc, ...]:
        """Return one law's discs in the order of the compositions."""
        return tuple(disc for disc in self.discs if disc.faces is faces and disc.model is model)

    def force(self, disc: PressedDisc, measured: Compression, strain: FloatArray) -> FloatArray:
        """Return the force [N] a fitted law foretells for a disc at strains [1], shape (n,)."""
        table = self.platens[_shape(measured)]
        return _force(
            table, disc.faces, disc.model, measured.area, (disc.shear_modulus, disc.exponent), strain
        )


def foretell_phantoms(
    discs: Sequence[Compression], watch: Callable[[float], None] = lambda _share: None
) -> PhantomResults:
    """Fit every law to specimen A of each composition and judge it.

    Args:
        discs: specimens; the first of each letter counts.
        watch: told the share that is done.

    Raises:
        SolverError: the bonded disc could not be computed.
    """
    shapes = sorted({_shape(disc) for disc in discs})
    tables = {}
    for number, shape in enumerate(shapes):
        tables[shape] = platens(shape, lambda share, done=number: watch((done + share) / len(shapes)))  # type: ignore[misc]
    first: dict[tuple[str, str], Compression] = {}
    for disc in discs:
        first.setdefault((disc.composition, disc.specimen), disc)
    names = list(dict.fromkeys(disc.composition for disc in discs))
    both = [name for name in names if (name, "A") in first and (name, "B") in first]
    results, apart = [], []
    for name in both:
        a, b = first[name, "A"], first[name, "B"]
        table = tables[_shape(a)]
        apart.append(_specimens(name, a, b))
        results += [_pressed(table, faces, model, a, b) for faces in Faces for model in Model]
    return PhantomResults(
        discs=tuple(results),
        specimens=tuple(apart),
        alone=tuple(name for name in names if name not in both),
        platens=tables,
        measured=tuple(first[name, letter] for name in both for letter in "AB"),
    )


def _pressed(table: Platens, faces: Faces, model: Model, a: Compression, b: Compression) -> PressedDisc:
    near = _between(a, FROM, CALIBRATED)
    strain, load = a.strain[near], a.load[near]
    exponent = _NEO_HOOKEAN
    if model is Model.OGDEN:
        exponent = float(
            positive_fit(
                lambda given: given[0] * a.area * table.force(faces, float(given[1]), strain),
                load,
                (load[-1] / (3 * a.area * strain[-1]), _START),
                floor=1.0,
                ranges=[(EXPONENTS[0], EXPONENTS[-1])],
            )[1]
        )
    unit = _force(table, faces, model, a.area, (1.0, exponent), strain)
    modulus = float(unit @ load / (unit @ unit))

    def error(disc: Compression, low: float, high: float) -> float:
        rows = _between(disc, low, high)
        return _relative(
            _force(table, faces, model, disc.area, (modulus, exponent), disc.strain[rows]), disc.load[rows]
        )

    at = np.array(GROWTH_STRAINS)
    there = _force(table, faces, model, b.area, (modulus, exponent), at)
    return PressedDisc(
        composition=a.composition,
        faces=faces,
        model=model,
        shear_modulus=modulus,
        exponent=exponent,
        fitted=error(a, FROM, CALIBRATED),
        beyond=error(a, CALIBRATED, LAST),
        other=error(b, FROM, CALIBRATED),
        other_beyond=error(b, CALIBRATED, LAST),
        growth=tuple(float(share) for share in there / _at(b, at) - 1.0),
    )


def _force(
    table: Platens,
    faces: Faces,
    model: Model,
    area: float,
    fitted: tuple[float, float],
    strain: FloatArray,
) -> FloatArray:
    modulus, exponent = fitted
    if model is Model.LINEAR:
        return modulus * area * table.linear_force(faces, strain)
    return modulus * area * table.force(faces, exponent, strain)


def _specimens(name: str, a: Compression, b: Compression) -> Specimens:
    apart = []
    for low, high in ((FROM, CALIBRATED), (CALIBRATED, LAST)):
        at = np.linspace(low, high, 100)
        apart.append(_relative(_at(a, at), _at(b, at)))
    return Specimens(composition=name, near=apart[0], beyond=apart[1])


def _at(disc: Compression, strain: FloatArray) -> FloatArray:
    rising = np.maximum.accumulate(disc.strain)
    return np.interp(strain, rising, disc.load)


def _between(disc: Compression, low: float, high: float) -> FloatArray:
    return np.asarray((disc.strain >= low) & (disc.strain <= high))


def _relative(found: FloatArray, measured: FloatArray) -> float:
    return float(np.sqrt(((found - measured) ** 2).mean() / (measured**2).mean()))


def _shape(disc: Compression) -> float:
    return round(0.5 * disc.diameter / disc.height, 6)
