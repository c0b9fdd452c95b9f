"""One model's curve against the reference's: every statistic of the study in one record."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from math import isfinite, isnan

import numpy.typing as npt

from trocar.errors import InputError
from trocar.study.statistics.agreement import (
    Concordance,
    Limits,
    PeakShift,
    concordance,
    curve_range,
    largest_error,
    limits_of_agreement,
    nrmse,
    peak_shift,
)
from trocar.study.statistics.equivalence import Equivalence, paired_equivalence, unpaired_equivalence
from trocar.study.statistics.published import NormalStudy, TTest, normal_study, t_test
from trocar.study.statistics.samples import pairs, samples
from trocar.study.statistics.uncertainty import effective_sample_size


@dataclass(frozen=True, kw_only=True)
class CurveComparison:
    """How far a model's curve agrees with a reference's.

    Args:
        n: samples.
        unit: of the curves.
        margin: largest mean difference that would not matter [unit of the curves].
        reference_range: largest minus smallest value of the reference, the normaliser of `nrmse` [same].
        nrmse: root mean square error over `reference_range` [1].
        largest_error: error of largest magnitude, with its sign [unit of the curves].
        largest_error_time: when it occurs [s].
        largest_relative_error: its magnitude over `reference_range` [1].
        peak: how far the peaks lie apart.
        published_t_test: model against reference as the 2014 paper tests them.
        published_normal_reference, published_normal_model: the paper's normal distributions.
        effective_n: independent samples the differences are worth.
        equivalence: paired, with `effective_n`: the one to quote.
        equivalence_if_independent: paired, as if all n samples were independent.
        equivalence_unpaired: pooled, the t-test's counterpart, as if independent.
        limits: Bland and Altman's.
        concordance: Lin's.
    """

    n: int
    unit: str
    margin: float
    reference_range: float
    nrmse: float
    largest_error: float
    largest_error_time: float
    largest_relative_error: float
    peak: PeakShift
    published_t_test: TTest
    published_normal_reference: NormalStudy
    published_normal_model: NormalStudy
    effective_n: float
    equivalence: Equivalence
    equivalence_if_independent: Equivalence
    equivalence_unpaired: Equivalence
    limits: Limits
    concordance: Concordance

    def as_dict(self) -> dict[str, object]:
        """Return plain numbers, lists and dictionaries for JSON; what is not finite becomes None."""
        plain = _plain(asdict(self))
        assert isinstance(plain, dict)
        for key in ("equivalence", "equivalence_if_independent", "equivalence_unpaired"):
            found: Equivalence = getattr(self, key)
            plain[key]["shown"] = None if isnan(found.p) else found.shown  # None: no test was possible
        plain["published_t_test"]["rejected"] = self.published_t_test.rejected
        plain["published_t_test"]["passes_as_printed"] = self.published_t_test.passes_as_printed
        return plain


def compare_curves(
    time: npt.ArrayLike,
    force: npt.ArrayLike,
    reference: npt.ArrayLike,
    model: npt.ArrayLike,
    *,
    margin: float,
    alpha: float = 0.05,
    unit: str = "m",
) -> CurveComparison:
    """Compare two curves sampled at the same times.

    Args:
        time: of the samples [s], ascending, shape (n,), n at least 3.
        force: applied then [N], shape (n,).
        reference: curve to judge by, such as a largest deflection, shape (n,).
        model: curve to judge, in the same unit, shape (n,).
        margin: largest mean difference that would not matter, fixed before looking, in that unit.
        alpha: significance level of every test.
        unit: of the curves, recorded.

    Raises:
        InputError: shapes differ, values are not finite, time does not ascend, the reference is constant, the
            margin is not above 0 or alpha not between 0 and 0.5.
    """
    times = samples("time", time)
    one, two = pairs("reference", reference, "model", model)
    if one.size != times.size:
        raise InputError("reference", f"as many samples as time ({times.size})", one.size)
    peak = peak_shift(times, force, one, two)
    width = curve_range(one)
    worst, at = largest_error(one, two)
    effective = effective_sample_size(two - one)
    return CurveComparison(
        n=one.size,
        unit=unit,
        margin=margin,
        reference_range=width,
        nrmse=nrmse(one, two),
        largest_error=worst,
        largest_error_time=float(times[at]),
        largest_relative_error=abs(worst) / width,
        peak=peak,
        published_t_test=t_test(two, one, alpha),
        published_normal_reference=normal_study(one),
        published_normal_model=normal_study(two),
        effective_n=effective,
        equivalence=paired_equivalence(one, two, margin=margin, alpha=alpha, effective=effective),
        equivalence_if_independent=paired_equivalence(one, two, margin=margin, alpha=alpha),
        equivalence_unpaired=unpaired_equivalence(one, two, margin=margin, alpha=alpha),
        limits=limits_of_agreement(one, two),
        concordance=concordance(one, two),
    )


def _plain(value: object) -> object:
    if isinstance(value, dict):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if isinstance(value, float):
        return value if isfinite(value) else None
    return value
