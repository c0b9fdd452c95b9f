"""The 2014 paper's statistics, as published: an equal-variance t-test and a normal distribution per layer.

What they cannot show: not rejecting "equal means" is no evidence of equality, and points along one curve are
neither independent nor unpaired. `equivalence` and `agreement` hold what answers the question.

Source: S. Patel and J. Suthakorn, Validation Study of a Wave Equation Model of Soft Tissue, sections 7.1 and
7.2; the test is Student's (1908) with the pooled variance.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import copysign, inf, nan, sqrt

import numpy as np
import numpy.typing as npt
from scipy import stats

from trocar.model import FloatArray
from trocar.study.statistics.samples import require, samples, without_rounding

MOST_FOR_SHAPIRO = 5000  # Royston (1995) states his p-value for n up to 5000


@dataclass(frozen=True, kw_only=True)
class TTest:
    """Outcome of a two-sample t-test.

    Args:
        t: difference of the means over its standard error; infinite where neither sample varies.
        df: degrees of freedom.
        p: two-tailed probability of a |t| at least this large if the means were equal.
        critical: two-tailed critical value at `alpha`.
        alpha: significance level.
    """

    t: float
    df: float
    p: float
    critical: float
    alpha: float

    @property
    def rejected(self) -> bool:
        """Whether "equal means" is rejected, |t| above the critical value."""
        return abs(self.t) > self.critical

    @property
    def passes_as_printed(self) -> bool:
        """The paper's criterion: p > alpha and t < critical, the sign of t kept.

        The second half alone would pass any sufficiently negative t; together with the first it does no harm.
        """
        return self.p > self.alpha and self.t < self.critical


@dataclass(frozen=True, kw_only=True)
class NormalStudy:
    """A normal distribution fitted to samples, and whether they look normal at all.

    Args:
        mean, sd: of the samples, the spread with n - 1 [unit of the samples].
        n: how many.
        shapiro_w, shapiro_p: Shapiro and Wilk's statistic and its probability if the samples were independent
            draws from a normal distribution; nan where they do not vary or n is above 5000.
    """

    mean: float
    sd: float
    n: int
    shapiro_w: float
    shapiro_p: float

    def density(self, values: FloatArray) -> FloatArray:
        """Return the fitted density at `values`, shape (n,); zero everywhere if the samples do not vary."""
        if self.sd == 0:
            return np.zeros_like(values)
        density: FloatArray = stats.norm.pdf(values, loc=self.mean, scale=self.sd)
        return density


def p_two_tailed(t: float, df: float) -> float:
    """Return the two-tailed probability of Student's t."""
    return float(2 * stats.t.sf(abs(t), df))


def t_critical(df: float, alpha: float = 0.05) -> float:
    """Return the two-tailed critical value of Student's t."""
    return float(stats.t.isf(alpha / 2, df))


def spread(values: FloatArray) -> float:
    """Return the standard deviation with n - 1, exactly 0 for a constant sample."""
    deviations = without_rounding(values - values.mean(), float(np.abs(values).max()))
    return float(sqrt(deviations @ deviations / (values.size - 1)))


def t_test(first: npt.ArrayLike, second: npt.ArrayLike, alpha: float = 0.05) -> TTest:
    """Test "equal means" as the paper did: two tails, equal variances.

    t = (m1 - m2) / (s sqrt(1/n1 + 1/n2)), s^2 = ((n1 - 1) s1^2 + (n2 - 1) s2^2) / (n1 + n2 - 2).

    Args:
        first: samples, shape (n1,).
        second: samples in the same unit, shape (n2,).
        alpha: significance level, between 0 and 1.

    Raises:
        InputError: fewer than 3 samples, values that are not finite, alpha not between 0 and 1.
    """
    one, two = samples("first", first), samples("second", second)
    require("alpha", alpha, 0 < alpha < 1, "a number between 0 and 1")
    difference, error, df = pooled_difference(one, two)
    t = ratio(difference, error)
    return TTest(t=t, df=df, p=p_two_tailed(t, df), critical=t_critical(df, alpha), alpha=alpha)


def pooled_difference(one: FloatArray, two: FloatArray) -> tuple[float, float, int]:
    """Return the difference of the means, its standard error with pooled variance, the degrees of freedom."""
    df = one.size + two.size - 2
    variance = ((one.size - 1) * spread(one) ** 2 + (two.size - 1) * spread(two) ** 2) / df
    return float(one.mean() - two.mean()), sqrt(variance * (1 / one.size + 1 / two.size)), df


def ratio(difference: float, error: float) -> float:
    """Return difference / error; without any spread 0 for no difference, else infinite with its sign."""
    if error > 0:
        return difference / error
    return 0.0 if difference == 0 else copysign(inf, difference)


def normal_study(values: npt.ArrayLike) -> NormalStudy:
    """Fit a normal distribution, as section 7.1 of the paper does, and check it with Shapiro and Wilk's test.

    Args:
        values: samples, shape (n,).

    Raises:
        InputError: fewer than 3 samples, or values that are not finite.
    """
    array = samples("values", values)
    sd = spread(array)
    w, p = nan, nan
    if sd > 0 and array.size <= MOST_FOR_SHAPIRO:
        standard = (array - array.mean()) / sd  # the test does not depend on the unit, its arithmetic might
        w, p = (float(number) for number in stats.shapiro(standard))
    return NormalStudy(mean=float(array.mean()), sd=sd, n=array.size, shapiro_w=w, shapiro_p=p)
