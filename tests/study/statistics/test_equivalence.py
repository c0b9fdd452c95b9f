"""Two one-sided tests against hand formulas, the confidence interval, SciPy and their own error rate."""

from math import isnan, sqrt

import numpy as np
import pytest
from scipy import stats

from trocar.errors import InputError
from trocar.study.statistics.equivalence import paired_equivalence, unpaired_equivalence

RNG = np.random.default_rng(1987)
REFERENCE = RNG.normal(0, 1, 40)
MODEL = REFERENCE + RNG.normal(0.1, 0.3, 40)


def test_paired_by_hand():
    # differences 1, 2, 3: mean 2, sd 1, error 1/sqrt(3); margin 4: t = 6 sqrt(3) and -2 sqrt(3), 2 degrees
    result = paired_equivalence([0, 0, 0], [1, 2, 3], margin=4)
    assert result.difference == 2
    assert result.p == pytest.approx(stats.t.cdf(-2 * sqrt(3), 2), rel=1e-14)
    assert (result.low, result.high) == pytest.approx(
        (2 - 2.91999 / sqrt(3), 2 + 2.91999 / sqrt(3)), abs=1e-5
    )
    assert result.shown


@pytest.mark.parametrize("margin", [0.05, 0.15, 0.2, 0.25, 0.5])
def test_paired_is_two_of_scipys_one_sided_tests(margin):
    difference = MODEL - REFERENCE
    above = stats.ttest_1samp(difference, -margin, alternative="greater").pvalue
    below = stats.ttest_1samp(difference, margin, alternative="less").pvalue
    assert paired_equivalence(REFERENCE, MODEL, margin=margin).p == pytest.approx(
        max(above, below), rel=1e-10
    )


@pytest.mark.parametrize("margin", [0.1, 0.5, 1.0])
def test_unpaired_is_two_of_scipys_one_sided_tests(margin):
    above = stats.ttest_ind(MODEL + margin, REFERENCE, alternative="greater").pvalue
    below = stats.ttest_ind(MODEL - margin, REFERENCE, alternative="less").pvalue
    assert unpaired_equivalence(REFERENCE, MODEL, margin=margin).p == pytest.approx(
        max(above, below), rel=1e-10
    )


@pytest.mark.parametrize("test", [paired_equivalence, unpaired_equivalence])
@pytest.mark.parametrize("margin", np.linspace(0.05, 0.9, 18))
def test_shown_means_the_interval_lies_within_the_margin(test, margin):
    result = test(REFERENCE, MODEL, margin=margin)
    assert result.shown == (-margin < result.low and result.high < margin)


def test_false_claims_at_the_margin_are_as_rare_as_alpha():
    claims = sum(
        paired_equivalence(np.zeros(20), RNG.normal(1.0, 0.5, 20), margin=1.0).shown for _ in range(2000)
    )
    assert abs(claims / 2000 - 0.05) < 4 * sqrt(0.05 * 0.95 / 2000)  # four standard errors of a proportion


def test_fewer_effective_samples_widen_the_interval():
    all_of_them = paired_equivalence(REFERENCE, MODEL, margin=0.25)
    few = paired_equivalence(REFERENCE, MODEL, margin=0.25, effective=4.0)
    assert few.high - few.low > 3 * (all_of_them.high - all_of_them.low)
    assert few.df == 3
    assert few.p > all_of_them.p


def test_too_few_effective_samples_show_nothing():
    result = paired_equivalence(REFERENCE, REFERENCE, margin=1, effective=1.5)
    assert isnan(result.p)
    assert not result.shown


@pytest.mark.parametrize(("shift", "shown"), [(0, True), (0.5, True), (1, False), (-1, False), (2, False)])
@pytest.mark.parametrize("test", [paired_equivalence, unpaired_equivalence])
def test_differences_without_spread(test, shift, shown):
    assert test([1.0, 1.0, 1.0], [1.0 + shift] * 3, margin=1).shown is shown


@pytest.mark.parametrize(
    "changes", [{"margin": 0}, {"margin": -1}, {"margin": np.nan}, {"alpha": 0.5}], ids=str
)
@pytest.mark.parametrize("test", [paired_equivalence, unpaired_equivalence])
def test_impossible_settings_are_refused(test, changes):
    with pytest.raises(InputError, match=next(iter(changes))):
        test([1, 2, 3], [1, 2, 3], **({"margin": 1} | changes))


def test_impossible_samples_are_refused():
    with pytest.raises(InputError, match="as many samples"):
        paired_equivalence([1, 2, 3], [1, 2, 3, 4], margin=1)
    with pytest.raises(InputError, match="effective"):
        paired_equivalence([1, 2, 3], [1, 2, 3], margin=1, effective=4)
    with pytest.raises(InputError, match="finite"):
        unpaired_equivalence([1, 2, np.nan], [1, 2, 3], margin=1)
