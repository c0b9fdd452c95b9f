"""Limbs foretold: skin, fat and muscle on bone, one set of moduli for every site, judged on people it has not seen.

Every other person fits, the rest are judged. A trial's force follows from its thicknesses, its probe and its
indentation d. With S the stiffness of the stack under a flat punch and e the indentation over the whole thickness,

    linear:       F = S d
    exponential:  F = S d (exp(b e) - 1) / (b e),

the second stiffening where b > 0 (after Y. C. Fung 1967, Am. J. Physiol. 213:1532). Both are fitted to the logarithm of
the force. Beside them stand what the data allow: a constant; a quadratic regression on the same numbers without any
mechanics; the same that also knows the site; and the linear model with each person's own stiffness, learnt from
their other sites.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.optimize import least_squares

from trocar.errors import InputError
from trocar.model import FloatArray
from trocar.study.measured.limbs import Indentations
from trocar.study.measured.stacked import punch_compliance

Rows = npt.NDArray[np.bool_]
"""Whether a trial is meant, shape (n,)."""

POISSON = 0.49
PUBLISHED = 0.254
"""Relative error published for a two-spring model of these trials [1]."""

_START = (30e3, 2e3, 5e3)  # shear moduli of skin, fat, muscle [Pa]
_FURTHEST = np.log(1e3)  # each of them may leave where it began by so much
_STEEPEST = 30.0  # b
_FEWEST_PEOPLE, _FEWEST_TRIALS = 4, 20
_NEAR = 0.7  # how far apart two trials may lie to count as alike [standard deviations]


@dataclass(frozen=True, kw_only=True)
class ForetoldLimbs:
    """One way of foretelling the force.

    Args:
        name: what it is called.
        force: foretold for every trial [N], shape (n,).
        fitted_median: of the relative error on those it was fitted to [1].
        median: on the others.
        mean: on the others.
    """

    name: str
    force: FloatArray
    fitted_median: float
    median: float
    mean: float


@dataclass(frozen=True, kw_only=True)
class LimbResults:
    """All ways of foretelling.

    Args:
        limbs: the trials.
        judged: which of them were kept from every fit, shape (n,).
        people: how many fitted, how many were judged.
        linear: layers that are linear.
        exponential: layers that stiffen, or soften.
        shear_moduli: of skin, fat and muscle, linear [Pa].
        exponential_moduli: likewise at small strain, exponential [Pa].
        steepness: b of the exponential law [1].
        baselines: without mechanics, and with each person's own stiffness.
        neighbours: median relative difference of force between trials of two people at one site that are alike in
            probe, thicknesses and indentation, over the square root of 2 [1].
        pairs: how many trials have such a neighbour.
    """

    limbs: Indentations
    judged: Rows
    people: tuple[int, int]
    linear: ForetoldLimbs
    exponential: ForetoldLimbs
    shear_moduli: tuple[float, ...]
    exponential_moduli: tuple[float, ...]
    steepness: float
    baselines: tuple[ForetoldLimbs, ...]
    neighbours: float
    pairs: int


def foretell_limbs(limbs: Indentations, watch: Callable[[float], None] = lambda _share: None) -> LimbResults:
    """Fit and judge every way.

    Args:
        limbs: the trials.
        watch: told the share that is done.

    Raises:
        InputError: there are too few.
    """
    people = np.unique(limbs.subjects)
    if len(people) < _FEWEST_PEOPLE or len(limbs.force) < _FEWEST_TRIALS:
        raise InputError(
            "limbs",
            f"at least {_FEWEST_PEOPLE} people and {_FEWEST_TRIALS} trials with every thickness",
            f"{len(people)} and {len(limbs.force)}",
        )
    fits = np.isin(limbs.subjects, people[::2])
    linear = _fit(limbs, fits, bends=False)
    watch(0.35)
    exponential = _fit(limbs, fits, bends=True)
    watch(0.9)
    forces = [_force(limbs, moduli, steepness) for moduli, steepness in (linear, exponential)]
    own = forces[0] * np.exp(_of_the_same_person(limbs, np.log(limbs.force / forces[0])))
    numbers = np.column_stack([np.log(limbs.indentation), np.log(limbs.area), np.log(limbs.thickness)])
    sites = (np.array(limbs.sites)[:, None] == np.unique(limbs.sites)).astype(np.float64)[:, 1:]
    one = np.ones((len(limbs.force), 1))
    with_site = np.exp(_regress(np.column_stack([_quadratic(numbers), sites]), np.log(limbs.force), fits))
    with_person = with_site * np.exp(_of_the_same_person(limbs, np.log(limbs.force / with_site)))
    ways = (
        ("a constant", np.exp(_regress(one, np.log(limbs.force), fits))),
        ("regression", np.exp(_regress(_quadratic(numbers), np.log(limbs.force), fits))),
        ("regression that knows the site", with_site),
        ("regression that knows site and person", with_person),
        ("linear layers, each person's own stiffness", own),
    )
    apart, pairs = _neighbours(limbs, numbers)
    return LimbResults(
        limbs=limbs,
        judged=~fits,
        people=(len(people[::2]), len(people) - len(people[::2])),
        linear=_scored("linear layers", forces[0], limbs, fits),
        exponential=_scored("exponential layers", forces[1], limbs, fits),
        shear_moduli=tuple(float(modulus) for modulus in linear[0]),
        exponential_moduli=tuple(float(modulus) for modulus in exponential[0]),
        steepness=exponential[1],
        baselines=tuple(_scored(name, force, limbs, fits) for name, force in ways),
        neighbours=apart,
        pairs=pairs,
    )


def _fit(limbs: Indentations, rows: Rows, *, bends: bool) -> tuple[FloatArray, float]:
    """Return the shear moduli [Pa] and b. One common factor is found in closed form, the mean of what is left."""
    start = np.log(_START)
    indentation, strain = limbs.indentation[rows], limbs.strain[rows]
    kept: dict[bytes, FloatArray] = {}

    def left(given: FloatArray) -> FloatArray:
        moduli = np.exp(start + np.append(given[:2], 0.0))
        key = moduli.tobytes()
        if key not in kept:
            kept[key] = np.log(
                indentation / punch_compliance(limbs.thickness[rows], moduli, POISSON, limbs.radius[rows])
            )
        bent = np.log(_bend(given[2] * strain)) if bends else 0.0
        return np.asarray(kept[key] + bent - np.log(limbs.force[rows]))

    def centred(given: FloatArray) -> FloatArray:
        residual = left(given)
        return np.asarray(residual - residual.mean())

    ends = np.array([_FURTHEST, _FURTHEST, _STEEPEST][: 2 + bends])
    found = least_squares(
        centred, np.zeros(2 + bends), bounds=(-ends, ends), diff_step=np.array(1e-3), xtol=1e-4
    ).x
    moduli = np.exp(start + np.append(found[:2], 0.0) - left(found).mean())
    return np.asarray(moduli), float(found[2]) if bends else 0.0


def _force(limbs: Indentations, moduli: FloatArray, steepness: float) -> FloatArray:
    compliance = punch_compliance(limbs.thickness, moduli, POISSON, limbs.radius)
    return np.asarray(limbs.indentation / compliance * _bend(steepness * limbs.strain))


def _bend(exponent: FloatArray) -> FloatArray:
    """Return (exp(x) - 1)/x, 1 at 0."""
    safe = np.where(np.abs(exponent) < 1e-9, 1e-9, exponent)
    return np.asarray(np.expm1(safe) / safe)


def _of_the_same_person(limbs: Indentations, left: FloatArray) -> FloatArray:
    """Return the mean of what is left at a person's other sites, 0 where there is none."""
    names, number = np.unique(limbs.subjects, return_inverse=True)
    total, count = (np.bincount(number, weights, len(names)) for weights in (left, None))
    return np.asarray((total[number] - left) / np.maximum(count[number] - 1, 1))


def _quadratic(numbers: FloatArray) -> FloatArray:
    scaled = (numbers - numbers.mean(axis=0)) / numbers.std(axis=0)
    rows, columns = np.triu_indices(numbers.shape[1])
    return np.column_stack([np.ones(len(scaled)), scaled, scaled[:, rows] * scaled[:, columns]])


def _regress(features: FloatArray, wanted: FloatArray, rows: Rows) -> FloatArray:
    solution = np.linalg.lstsq(features[rows], wanted[rows], rcond=None)[0]
    return np.asarray(features @ solution)


def _neighbours(limbs: Indentations, numbers: FloatArray) -> tuple[float, int]:
    scaled = (numbers - numbers.mean(axis=0)) / numbers.std(axis=0)
    sites, people = np.array(limbs.sites), np.array(limbs.subjects)
    apart = []
    for row in range(len(scaled)):
        others = np.flatnonzero((sites == sites[row]) & (people != people[row]))
        if not others.size:
            continue
        distance = np.linalg.norm(scaled[others] - scaled[row], axis=1)
        nearest = int(np.argmin(distance))
        if distance[nearest] <= _NEAR:
            apart.append(abs(np.log(limbs.force[others[nearest]] / limbs.force[row])))
    if not apart:
        return float("nan"), 0
    return float(np.expm1(np.median(apart) / np.sqrt(2))), len(apart)


def _scored(name: str, force: FloatArray, limbs: Indentations, fits: Rows) -> ForetoldLimbs:
    error = np.abs(force / limbs.force - 1)
    return ForetoldLimbs(
        name=name,
        force=force,
        fitted_median=float(np.median(error[fits])),
        median=float(np.median(error[~fits])),
        mean=float(error[~fits].mean()),
    )
