"""What the numbers themselves are worth: independent samples in a curve, error left by the mesh.

An error between two models means something only where it is larger than the uncertainty of computing it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from math import expm1, inf, isfinite, log, nan, sqrt

import numpy as np
import numpy.typing as npt

from trocar.errors import InputError
from trocar.study.statistics.samples import require, samples, without_rounding

SAFETY = 1.25  # of the grid convergence index with three meshes; Roache (1994)
EXPANSION = 1.15  # index over standard uncertainty; ASME V&V 20-2009
SAME = 1e-14  # relative: two results that differ by rounding alone


def lag_one_autocorrelation(values: npt.ArrayLike) -> float:
    """Return the correlation of a series with itself one sample later; 0 for a constant series.

    sum (x_i - m)(x_{i+1} - m) / sum (x_i - m)^2.

    Raises:
        InputError: samples are impossible.
    """
    array = samples("values", values)
    deviation = without_rounding(array - array.mean(), float(np.abs(array).max()))
    whole = float(deviation @ deviation)
    return 0.0 if whole == 0 else float(deviation[1:] @ deviation[:-1]) / whole


def effective_sample_size(values: npt.ArrayLike) -> float:
    """Return how many independent samples a series is worth for its mean, n (1 - r)/(1 + r), 1 to n.

    r is the lag-one autocorrelation. Exact for a first-order autoregressive series, a rough guide for a
    deterministic curve. It shows that 81 points along one curve are not 81 experiments.

    Raises:
        InputError: samples are impossible.

    Source: H. J. Thiebaux, F. W. Zwiers, J. Climate Appl. Meteor. 23 (1984) 800-811.
    """
    array = samples("values", values)
    r = lag_one_autocorrelation(array)
    return float(np.clip(array.size * (1 - r) / (1 + r), 1.0, array.size))


class Convergence(StrEnum):
    """How three results behave under refinement."""

    CONVERGED = "converged"  # the two finest agree to rounding
    MONOTONE = "monotone"
    OSCILLATORY = "oscillatory"  # differences shrink and change sign
    DIVERGENT = "divergent"  # the last difference is not smaller


@dataclass(frozen=True, kw_only=True)
class Refinement:
    """What three refinements say about the finest.

    Args:
        kind: how they behave.
        order: used for extrapolation: the observed one, at most the formal one; nan unless monotone.
        observed_order: nan unless monotone.
        extrapolated: estimate of the exact result; the finest result unless monotone.
        index: grid convergence index of the finest result, about its 95 % error bound [unit of the result].
    """

    kind: Convergence
    order: float
    observed_order: float
    extrapolated: float
    index: float

    @property
    def standard_uncertainty(self) -> float:
        """Numerical standard uncertainty u_num of the finest result [unit of the result]."""
        return self.index / EXPANSION


def refinement(results: Sequence[float], sizes: Sequence[float], formal_order: float = 2.0) -> Refinement:
    """Estimate the error of the finest of three refinements by Richardson extrapolation.

    With f = exact + C h^p, f1 and h1 the finest, r = h2/h1 and s = h3/h2, the order p solves
    (f3 - f2)/(f2 - f1) = r^p (s^p - 1)/(r^p - 1); exact = f1 + (f1 - f2)/(r^p - 1) and the index is
    1.25 |f1 - f2| / (r^p - 1). Where the results oscillate or diverge nothing is extrapolated, and the index
    is 1.25 (oscillating) or 3 (diverging) times their whole spread.

    Args:
        results: three, coarsest first.
        sizes: mesh size or one over the number of modes of each, descending.
        formal_order: order of the method; a higher observed one is chance and is not trusted.

    Raises:
        InputError: not three finite results, or sizes that do not shrink.

    Source: P. J. Roache, J. Fluids Eng. 116 (1994) 405-413; I. B. Celik et al., the same 130 (2008) 078001.
    """
    if len(results) != 3 or not all(isfinite(one) for one in results):
        raise InputError("results", "three finite results, coarsest first", tuple(results))
    if len(sizes) != 3 or not inf > sizes[0] > sizes[1] > sizes[2] > 0:
        raise InputError("sizes", "three sizes above 0, descending", tuple(sizes))
    if not formal_order > 0:
        raise InputError("formal_order", "a number above 0", formal_order)
    f3, f2, f1 = (float(one) for one in results)
    coarse, fine = f3 - f2, f2 - f1
    width = max(results) - min(results)

    def stopped(kind: Convergence, index: float) -> Refinement:
        return Refinement(kind=kind, order=nan, observed_order=nan, extrapolated=f1, index=index)

    if abs(fine) <= SAME * max(abs(f1), abs(f2)):
        return stopped(Convergence.CONVERGED, 0.0)
    r, s = sizes[1] / sizes[2], sizes[0] / sizes[1]
    growth = coarse / fine
    if growth < 0 and abs(growth) > 1:
        return stopped(Convergence.OSCILLATORY, SAFETY * width)
    observed = _order(growth, r, s)
    if not observed > 0:
        return stopped(Convergence.DIVERGENT, 3 * width)
    order = min(observed, formal_order)
    step = -fine / (r**order - 1)
    return Refinement(
        kind=Convergence.MONOTONE,
        order=order,
        observed_order=observed,
        extrapolated=f1 + step,
        index=SAFETY * abs(step),
    )


def _order(growth: float, r: float, s: float) -> float:
    """Return the p at which r^p (s^p - 1)/(r^p - 1) = growth, 0 where there is none above 0.

    The left side rises with p from ln s / ln r at p = 0, so a bisection finds the only root.
    """

    def excess(p: float) -> float:
        return float(r**p) * expm1(p * log(s)) / expm1(p * log(r)) - growth

    low, high = 1e-6, 50.0
    if growth <= 0 or excess(low) > 0:
        return 0.0
    if excess(high) < 0:
        return high
    for _ in range(80):  # halves 50 to below rounding
        middle = (low + high) / 2
        low, high = (middle, high) if excess(middle) < 0 else (low, middle)
    return (low + high) / 2


@dataclass(frozen=True, kw_only=True)
class Validation:
    """A comparison error beside the uncertainty of finding it.

    Args:
        error: simulation minus data, E = S - D [unit of the results].
        uncertainty: standard validation uncertainty, the root of the sum of squares of its parts [same].
    """

    error: float
    uncertainty: float

    @property
    def model_error(self) -> tuple[float, float]:
        """Interval E -+ 2 u the model's own error lies in with about 95 % confidence."""
        return self.error - 2 * self.uncertainty, self.error + 2 * self.uncertainty

    @property
    def resolved(self) -> bool:
        """Whether the error stands out of its uncertainty, |E| > 2 u; else only a bound is known."""
        return abs(self.error) > 2 * self.uncertainty


def validation(simulation: float, data: float, *uncertainties: float) -> Validation:
    """Compare a simulated number with its reference.

    Args:
        simulation: S.
        data: D, in the same unit.
        uncertainties: standard uncertainties of both, numerical, input and measured ones alike, same unit.

    Raises:
        InputError: a number is not finite or an uncertainty is negative.

    Source: ASME V&V 20-2009, E = S - D, u_val^2 = u_num^2 + u_input^2 + u_D^2.
    """
    for name, value in (("simulation", simulation), ("data", data)):
        require(name, value, True, "a finite number")
    for value in uncertainties:
        require("uncertainties", value, value >= 0, "finite numbers, 0 or above")
    return Validation(error=simulation - data, uncertainty=sqrt(sum(value**2 for value in uncertainties)))
