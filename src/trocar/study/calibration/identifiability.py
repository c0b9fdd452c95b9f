"""What the data tell of the parameters, and what they cannot tell apart.

In free coordinates the Fisher information of the fit is H = sum over series of S^T S/(sigma^2 f), S the slopes and f
the inflation for rows that are not independent. An eigenvector of H is a product of powers of parameters, and one over
the root of its eigenvalue the relative error of that product. Where that exceeds `VAGUE`, a factor of two at 95 %, the
data leave the product open, and every parameter with a share in it.

A model that is off by a share delta of every reading of a series (finite elements say by how much) moves the estimate
by H^-1 S^T r delta; that is added to the covariance for each series, as if it were random.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import stats

from trocar.model import FloatArray
from trocar.study.calibration.fit import PRIOR, Fitted, Problem
from trocar.study.calibration.parameter import Parameter
from trocar.study.report.table import percent

VAGUE = 0.35  # of a free coordinate: exp(1.96 * 0.35) = 2
LEVEL = 0.95
_SHARE = 0.15  # of an eigenvector's largest component: less is not named
_NEAR_EVEN = 0.15  # by which exponents may differ that are called a product or a ratio


@dataclass(frozen=True, kw_only=True)
class Estimate:
    """One parameter.

    Attributes:
        parameter: which.
        start: [SI].
        value: [SI].
        low, high: of the 95 % interval [SI]; None where the data leave it open.
        error: standard, of the free coordinate, all counted [1]: relative, for what is no Poisson's ratio.
        from_noise, from_model: its parts [1].
        alone: the error from noise that would be left if all others were known [1].
        at_bound: whether the fit ran into the end of what it may try.
    """

    parameter: Parameter
    start: float
    value: float
    low: float | None
    high: float | None
    error: float
    from_noise: float
    from_model: float
    alone: float
    at_bound: bool

    @property
    def told(self) -> bool:
        """Whether the data tell it within a factor of two."""
        return self.low is not None

    @property
    def without_influence(self) -> bool:
        """Whether it would stay open even if all others were known."""
        return self.alone > VAGUE


@dataclass(frozen=True, kw_only=True)
class Combination:
    """A product of powers of parameters, an eigenvector of the information.

    Attributes:
        exponents: of each parameter, shape (p,), of length 1.
        error: standard, relative [1]; infinite where data say nothing.
    """

    exponents: FloatArray
    error: float

    def words(self, parameters: tuple[Parameter, ...]) -> str:
        """Return it as "the product of a and b", "the ratio a/b" or "a^0.8 b^0.6"."""
        size = np.abs(self.exponents)
        named = [int(i) for i in np.argsort(-size) if size[i] >= _SHARE * size.max()]
        powers = (self.exponents * np.sign(self.exponents[named[0]])).tolist()
        names = [parameters[i].name for i in named]
        if len(named) == 1:
            return names[0]
        even = all(abs(size[i] / size.max() - 1) < _NEAR_EVEN for i in named)
        if even and all(powers[i] > 0 for i in named):
            return f"the product of {' and '.join(names)}"
        if even and len(named) == 2:
            return f"the ratio {names[0]}/{names[1]}"
        said = " ".join(f"{name}^{powers[i]:.2f}" for name, i in zip(names, named, strict=True))
        return said.replace("^-", "^−")


@dataclass(frozen=True, kw_only=True)
class Knowledge:
    """What a fit knows.

    Attributes:
        estimates: of each parameter.
        combinations: best known first.
        correlation: of the free coordinates, shape (p, p).
        covariance: all counted, shape (p, p).
        independent: readings the data are worth.
    """

    estimates: tuple[Estimate, ...]
    combinations: tuple[Combination, ...]
    correlation: FloatArray
    covariance: FloatArray
    independent: float

    @property
    def sentences(self) -> tuple[str, ...]:
        """What the data tell, in words."""
        return _sentences(self)


def knowledge(problem: Problem, fitted: Fitted, model_error: float) -> Knowledge:
    """Assess a fit.

    Args:
        problem: what was fitted.
        fitted: where it ended.
        model_error: share of every reading the model may be off by [1].
    """
    count = len(problem.parameters)
    information, pushes, worth = np.zeros((count, count)), [], 0.0
    for i, (part, noise) in enumerate(zip(problem.probes.parts, fitted.noise, strict=True)):
        seen = problem.used[part]
        slopes, rows = fitted.slopes[part][seen], fitted.rows[part][seen]
        if problem.offset(i):
            slopes, rows = slopes - slopes.mean(axis=0), rows - rows.mean()
            worth -= 1
        weight = 1 / (max(noise.used, 1e-12) ** 2 * noise.inflation)
        information += weight * slopes.T @ slopes
        pushes.append(weight * slopes.T @ rows * model_error)
        worth += noise.worth
    values, vectors = np.linalg.eigh(information)
    order = np.argsort(-values)
    values, vectors = np.maximum(values[order], 0.0), vectors[:, order]
    covariance = (vectors / (values + PRIOR**-2)) @ vectors.T
    moved = [covariance @ push for push in pushes]
    whole = covariance + sum(np.outer(move, move) for move in moved)
    t = float(stats.t.ppf(0.5 + LEVEL / 2, max(worth - count, 1.0)))
    estimates = []
    for i, item in enumerate(problem.parameters):
        error, x = float(np.sqrt(whole[i, i])), float(fitted.free[i])
        told = error < VAGUE and not fitted.at_bound[i]
        estimates.append(
            Estimate(
                parameter=item,
                start=item.get(problem.start),
                value=item.value(x),
                low=item.value(x - t * error) if told else None,
                high=item.value(x + t * error) if told else None,
                error=error,
                from_noise=float(np.sqrt(covariance[i, i])),
                from_model=float(np.sqrt(sum(move[i] ** 2 for move in moved))),
                alone=float(1 / np.sqrt(max(information[i, i], 1e-30))),
                at_bound=bool(fitted.at_bound[i]),
            )
        )
    errors = np.sqrt(np.diag(whole))
    return Knowledge(
        estimates=tuple(estimates),
        combinations=tuple(
            Combination(
                exponents=vectors[:, i], error=float(1 / np.sqrt(values[i])) if values[i] > 0 else np.inf
            )
            for i in range(count)
        ),
        correlation=whole / np.outer(errors, errors),
        covariance=whole,
        independent=float(worth),
    )


def _sentences(known: Knowledge) -> tuple[str, ...]:
    parameters = tuple(item.parameter for item in known.estimates)
    told = [item for item in known.estimates if item.told]
    silent = [item for item in known.estimates if item.without_influence]
    said = []
    if told:
        parts = [f"{item.parameter.name} to {percent(1.96 * item.error)}" for item in told]
        said.append(f"The data tell {_listed(parts)} (half of a 95 % interval).")
    if silent:
        verb = "have" if len(silent) > 1 else "has"
        said.append(
            f"{_listed([item.parameter.name for item in silent])} {verb} no influence that stands out of the noise: "
            f"{'they stay' if len(silent) > 1 else 'it stays'} near the case file's value, which says nothing."
        )
    mixed = [item for item in known.estimates if not (item.told or item.without_influence or item.at_bound)]
    if mixed:
        names = _listed([item.parameter.name for item in mixed])
        places = [i for i, item in enumerate(known.estimates) if item in mixed]
        only = [
            f"{one.words(parameters)} (to {percent(1.96 * one.error)})"
            for one in known.combinations
            if one.error < VAGUE and np.abs(one.exponents[places]).max() > 0.3
        ]
        apart = f"The data cannot tell {names} apart" if len(mixed) > 1 else f"The data leave {names} open"
        said.append(f"{apart}: they know only {_listed(only)}." if only else f"{apart}.")
    return tuple(said)


def _listed(names: list[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"
