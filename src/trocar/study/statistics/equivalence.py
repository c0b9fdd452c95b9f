"""Two one-sided tests that a difference is smaller than a margin fixed beforehand.

Equivalence is claimed when "the mean difference is at or beyond -margin" and "at or beyond +margin" are both
rejected, which is the same as the 1 - 2 alpha confidence interval lying within (-margin, margin).

Source: D. J. Schuirmann, J. Pharmacokinet. Biopharm. 15 (1987) 657-680.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import nan, sqrt

import numpy.typing as npt
from scipy import stats

from trocar.study.statistics.published import pooled_difference, ratio, spread
from trocar.study.statistics.samples import pairs, require, samples

FEWEST_EFFECTIVE = 2.0  # below, there is no degree of freedom to judge the spread with


@dataclass(frozen=True, kw_only=True)
class Equivalence:
    """Outcome of two one-sided tests.

    Args:
        difference: mean of model minus reference [unit of the samples].
        margin: largest mean difference that would not matter [same].
        low, high: confidence interval of the difference at 1 - 2 alpha [same]; nan if no test was possible.
        p: larger of the two one-sided probabilities; nan where no test was possible.
        df: degrees of freedom.
        alpha: significance level of each one-sided test.
    """

    difference: float
    margin: float
    low: float
    high: float
    p: float
    df: float
    alpha: float

    @property
    def shown(self) -> bool:
        """Whether equivalence within the margin is shown; False where no test was possible."""
        return self.p < self.alpha


def paired_equivalence(
    reference: npt.ArrayLike,
    model: npt.ArrayLike,
    *,
    margin: float,
    alpha: float = 0.05,
    effective: float | None = None,
) -> Equivalence:
    """Test equivalence of paired samples: d = model - reference, error sd(d)/sqrt(n), n - 1 degrees.

    Args:
        reference: samples to judge by, shape (n,).
        model: samples to judge, in the same unit, shape (n,).
        margin: above 0, in the same unit.
        alpha: of each one-sided test, between 0 and 0.5.
        effective: how many independent samples they are worth, at most n (`uncertainty` estimates it); None
            takes n. Below 2 no test is possible and p is nan.

    Raises:
        InputError: samples, margin, alpha or effective are impossible.
    """
    one, two = pairs("reference", reference, "model", model)
    _require_margin(margin, alpha)
    count = float(one.size) if effective is None else effective
    require("effective", count, 0 < count <= one.size, f"a number above 0, at most {one.size}")
    difference = two - one
    mean = float(difference.mean())
    if count < FEWEST_EFFECTIVE:
        return Equivalence(
            difference=mean, margin=margin, low=nan, high=nan, p=nan, df=max(count - 1, 0.0), alpha=alpha
        )
    return _two_one_sided(mean, spread(difference) / sqrt(count), count - 1, margin, alpha)


def unpaired_equivalence(
    reference: npt.ArrayLike, model: npt.ArrayLike, *, margin: float, alpha: float = 0.05
) -> Equivalence:
    """Test equivalence of two samples with pooled variance, the t-test's counterpart.

    Args:
        reference: samples to judge by, shape (n1,).
        model: samples to judge, in the same unit, shape (n2,).
        margin: above 0, in the same unit.
        alpha: of each one-sided test, between 0 and 0.5.

    Raises:
        InputError: samples, margin or alpha are impossible.
    """
    one, two = samples("reference", reference), samples("model", model)
    _require_margin(margin, alpha)
    mean, error, df = pooled_difference(two, one)
    return _two_one_sided(mean, error, df, margin, alpha)


def _require_margin(margin: float, alpha: float) -> None:
    require("margin", margin, margin > 0, "a number above 0, in the unit of the samples")
    require("alpha", alpha, 0 < alpha < 0.5, "a number between 0 and 0.5")


def _two_one_sided(mean: float, error: float, df: float, margin: float, alpha: float) -> Equivalence:
    above = float(stats.t.sf(ratio(mean + margin, error), df))  # of a difference at or below -margin
    below = float(stats.t.cdf(ratio(mean - margin, error), df))  # of a difference at or above +margin
    half = float(stats.t.isf(alpha, df)) * error
    return Equivalence(
        difference=mean,
        margin=margin,
        low=mean - half,
        high=mean + half,
        p=max(above, below),
        df=float(df),
        alpha=alpha,
    )
