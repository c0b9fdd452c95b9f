"""How far two curves sampled at the same times agree: error over the whole curve, peaks, limits, concordance.

Errors are model minus reference, in the unit of the curves. Intervals treat the samples as independent; along
one curve they are not, so true ones are wider (`uncertainty.effective_sample_size` says by how much).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atanh, nan, sqrt, tanh

import numpy as np
import numpy.typing as npt
from scipy import stats

from trocar.errors import InputError
from trocar.model import FloatArray
from trocar.study.statistics.published import spread, t_critical
from trocar.study.statistics.samples import pairs, samples, without_rounding

CONFIDENCE = 0.95


@dataclass(frozen=True, kw_only=True)
class PeakShift:
    """How far the model's peak lies from the reference's.

    Args:
        time: of the model's peak minus the reference's [s].
        force: at the model's peak minus at the reference's [N].
        height: of the model's peak minus the reference's [unit of the curves].
        resolution: longest sampling step beside either peak [s]; a shift is known no better.
    """

    time: float
    force: float
    height: float
    resolution: float


@dataclass(frozen=True, kw_only=True)
class Limits:
    """Bland and Altman's limits of agreement, each with its 95 % confidence interval [unit of the curves]."""

    bias: float
    sd: float
    lower: float
    upper: float
    bias_interval: tuple[float, float]
    lower_interval: tuple[float, float]
    upper_interval: tuple[float, float]


@dataclass(frozen=True, kw_only=True)
class Concordance:
    """Lin's concordance correlation coefficient.

    Args:
        value: the coefficient, -1 to 1.
        low, high: its 95 % confidence interval; nan where the correlation is 0 or unknown.
        correlation: Pearson's, the precision part; nan where a curve is constant.
    """

    value: float
    low: float
    high: float
    correlation: float


def nrmse(reference: npt.ArrayLike, model: npt.ArrayLike) -> float:
    """Return the root mean square error over the range (largest minus smallest) of the reference [1].

    Args:
        reference: curve to judge by, shape (n,).
        model: curve to judge, in the same unit, shape (n,).

    Raises:
        InputError: samples are impossible or the reference is constant, so that it has no range.
    """
    one, two = pairs("reference", reference, "model", model)
    return float(np.sqrt(np.mean((two - one) ** 2))) / curve_range(one)


def curve_range(reference: FloatArray) -> float:
    """Return the largest minus the smallest value of a reference curve.

    Raises:
        InputError: the curve is constant.
    """
    width = float(np.ptp(reference))
    if width == 0:
        raise InputError("reference", "a curve that varies", float(reference[0]), "a ratio needs its range")
    return width


def largest_error(reference: npt.ArrayLike, model: npt.ArrayLike) -> tuple[float, int]:
    """Return the error of largest magnitude, with its sign, and its index.

    Args:
        reference: curve to judge by, shape (n,).
        model: curve to judge, in the same unit, shape (n,).

    Raises:
        InputError: samples are impossible.
    """
    one, two = pairs("reference", reference, "model", model)
    index = int(np.argmax(np.abs(two - one)))
    return float(two[index] - one[index]), index


def peak_shift(
    time: npt.ArrayLike, force: npt.ArrayLike, reference: npt.ArrayLike, model: npt.ArrayLike
) -> PeakShift:
    """Compare the peaks: the first samples that reach the largest value, but for rounding.

    Args:
        time: of the samples [s], ascending, shape (n,).
        force: applied then [N], shape (n,).
        reference: curve to judge by, shape (n,).
        model: curve to judge, in the same unit, shape (n,).

    Raises:
        InputError: samples are impossible or time does not ascend.
    """
    times = samples("time", time)
    if not np.all(np.diff(times) > 0):
        raise InputError("time", "ascending times", "times that stay or go back")
    _, forces = pairs("time", times, "force", force)
    _, one = pairs("time", times, "reference", reference)
    _, two = pairs("time", times, "model", model)
    at_one, at_two = _first_peak(one), _first_peak(two)
    steps = np.diff(times)
    beside = [steps[max(at - 1, 0) : at + 1].max() for at in (at_one, at_two)]
    return PeakShift(
        time=float(times[at_two] - times[at_one]),
        force=float(forces[at_two] - forces[at_one]),
        height=float(two[at_two] - one[at_one]),
        resolution=float(max(beside)),
    )


def _first_peak(curve: FloatArray) -> int:
    missing = without_rounding(
        curve.max() - curve, 64 * float(np.abs(curve).max())
    )  # a plateau, held in steps
    return int(np.argmin(missing))


def limits_of_agreement(reference: npt.ArrayLike, model: npt.ArrayLike) -> Limits:
    """Return bias and limits of agreement, bias -+ 1.96 sd, with confidence intervals.

    Standard errors: sd / sqrt(n) of the bias, sd sqrt(1/n + 1.96^2 / (2 (n - 1))) of a limit; Student's t
    with n - 1 degrees of freedom.

    Args:
        reference: curve to judge by, shape (n,).
        model: curve to judge, in the same unit, shape (n,).

    Raises:
        InputError: samples are impossible.

    Source: J. M. Bland, D. G. Altman, Stat. Methods Med. Res. 8 (1999) 135-160.
    """
    one, two = pairs("reference", reference, "model", model)
    n = one.size
    bias, sd = float((two - one).mean()), spread(two - one)
    z = float(stats.norm.isf((1 - CONFIDENCE) / 2))
    t = t_critical(n - 1, 1 - CONFIDENCE)
    of_bias, of_limit = t * sd / sqrt(n), t * sd * sqrt(1 / n + z**2 / (2 * (n - 1)))
    lower, upper = bias - z * sd, bias + z * sd
    return Limits(
        bias=bias,
        sd=sd,
        lower=lower,
        upper=upper,
        bias_interval=(bias - of_bias, bias + of_bias),
        lower_interval=(lower - of_limit, lower + of_limit),
        upper_interval=(upper - of_limit, upper + of_limit),
    )


def concordance(reference: npt.ArrayLike, model: npt.ArrayLike) -> Concordance:
    """Return Lin's concordance, 2 s12 / (s1^2 + s2^2 + (m1 - m2)^2) with moments over n, and its interval.

    The interval is symmetric in Fisher's z = atanh(value), with Lin's asymptotic variance. Two equal constant
    curves agree perfectly (1); a constant against a varying one does not agree at all (0).

    Args:
        reference: curve to judge by, shape (n,), n at least 4 for an interval.
        model: curve to judge, in the same unit, shape (n,).

    Raises:
        InputError: samples are impossible.

    Source: L. I. Lin, Biometrics 45 (1989) 255-268, with the correction of Biometrics 56 (2000) 324-325.
    """
    one, two = pairs("reference", reference, "model", model)
    scale = float(max(np.abs(one).max(), np.abs(two).max())) or 1.0
    one, two = one / scale, two / scale  # squares of tiny curves would vanish
    d1, d2 = without_rounding(one - one.mean(), 1.0), without_rounding(two - two.mean(), 1.0)
    v1, v2, v12 = float(np.mean(d1**2)), float(np.mean(d2**2)), float(np.mean(d1 * d2))
    gap = float(one.mean() - two.mean())
    whole = v1 + v2 + gap**2
    if whole == 0:
        return Concordance(value=1.0, low=1.0, high=1.0, correlation=nan)
    value = 2 * v12 / whole
    if v1 == 0 or v2 == 0:
        return Concordance(value=0.0, low=nan, high=nan, correlation=nan)
    rho = v12 / sqrt(v1 * v2)
    low, high = _fisher_interval(value, rho, gap**2 / sqrt(v1 * v2), one.size)
    return Concordance(value=value, low=low, high=high, correlation=rho)


def _fisher_interval(value: float, rho: float, shift: float, n: int) -> tuple[float, float]:
    """Return the interval of Lin's coefficient; `shift` is (m1 - m2)^2 / (s1 s2)."""
    remainder = 1 - value**2
    if remainder <= 4 * np.finfo(np.float64).eps:
        return value, value
    if rho == 0 or n < 4:
        return nan, nan
    variance = (
        (1 - rho**2) * value**2 / (remainder * rho**2)
        + 2 * value**3 * (1 - value) * shift / (rho * remainder**2)
        - value**4 * shift**2 / (2 * rho**2 * remainder**2)
    ) / (n - 2)
    half = float(stats.norm.isf((1 - CONFIDENCE) / 2)) * sqrt(max(variance, 0.0))
    return tanh(atanh(value) - half), tanh(atanh(value) + half)
