"""The published statistics: identities with SciPy, values worked by hand, samples that do not vary."""

from math import inf, isnan, sqrt

import numpy as np
import pytest
from scipy import stats

from trocar.errors import InputError
from trocar.study.statistics.published import normal_study, p_two_tailed, t_critical, t_test

RNG = np.random.default_rng(20150)
FIRST, SECOND = RNG.normal(1.0, 0.5, 81), RNG.normal(1.1, 0.4, 60)


def test_t_test_is_scipys_equal_variance_test():
    ours, theirs = t_test(FIRST, SECOND), stats.ttest_ind(FIRST, SECOND, equal_var=True)
    assert ours.t == pytest.approx(theirs.statistic, rel=1e-12)  # same formula, other order of sums
    assert ours.p == pytest.approx(theirs.pvalue, rel=1e-12)
    assert ours.df == 139


def test_t_test_by_hand():
    # means 2 and 4, variances 1 and 4, pooled 2.5, error sqrt(2.5 * 2/3)
    result = t_test([1, 2, 3], [2, 4, 6])
    assert result.t == pytest.approx(-2 / sqrt(2.5 * 2 / 3), rel=1e-15)
    assert result.df == 4
    assert result.critical == pytest.approx(2.776, abs=5e-4)  # printed tables
    assert not result.rejected
    assert result.passes_as_printed


def test_printed_criterion_keeps_the_sign():
    result = t_test([1.0, 2.0, 3.0], [11.0, 12.0, 13.0])
    assert result.t < result.critical  # true of any very negative t
    assert result.rejected
    assert not result.passes_as_printed


def test_critical_value_of_many_degrees_is_normal():
    assert t_critical(1e9) == pytest.approx(1.959964, abs=1e-6)
    assert p_two_tailed(-0.912, 160) == p_two_tailed(0.912, 160)


@pytest.mark.parametrize(
    ("second", "t", "p"), [([0.1] * 4, 0.0, 1.0), ([0.2] * 5, -inf, 0.0), ([0.0] * 5, inf, 0.0)], ids=str
)
def test_samples_that_do_not_vary(second, t, p):
    result = t_test([0.1] * 4, second)
    assert (result.t, result.p) == (t, p)


@pytest.mark.parametrize(
    "values", [[], [1, 2], [1, 2, np.nan], [1, 2, np.inf], [[1, 2, 3]], ["a", "b", "c"], 3.0], ids=str
)
def test_impossible_samples_are_refused(values):
    for refuse in (
        lambda: t_test(values, [1, 2, 3]),
        lambda: t_test([1, 2, 3], values),
        lambda: normal_study(values),
    ):
        with pytest.raises(InputError):
            refuse()


@pytest.mark.parametrize("alpha", [0, 1, -0.1, np.nan])
def test_impossible_alpha_is_refused(alpha):
    with pytest.raises(InputError, match="alpha"):
        t_test([1, 2, 3], [1, 2, 3], alpha)


def test_normal_study_fits_and_checks():
    study = normal_study(FIRST)
    assert study.mean == pytest.approx(np.mean(FIRST), rel=1e-14)
    assert study.sd == pytest.approx(np.std(FIRST, ddof=1), rel=1e-14)
    assert study.shapiro_p == pytest.approx(stats.shapiro(FIRST).pvalue, rel=1e-6)  # standardising rounds
    grid = np.linspace(-9, 11, 4001)  # 20 standard deviations a side: the tails hold nothing
    assert np.trapezoid(study.density(grid), grid) == pytest.approx(1, abs=1e-9)


def test_a_ramp_up_and_down_is_not_normal():
    assert normal_study(np.minimum(np.arange(81), 80 - np.arange(81))).shapiro_p < 0.05


def test_normal_study_of_a_constant():
    study = normal_study([0.1] * 7)
    assert study.sd == 0
    assert isnan(study.shapiro_p)
    assert np.array_equal(study.density(np.array([0.0, 0.1])), [0, 0])


def test_shapiro_is_not_claimed_beyond_its_range():
    assert isnan(normal_study(np.arange(5001.0)).shapiro_w)


@pytest.mark.parametrize("scale", [1e-9, 1e-3, 1e6])
def test_unit_does_not_matter(scale):
    assert t_test(FIRST * scale, SECOND * scale).p == pytest.approx(t_test(FIRST, SECOND).p, rel=1e-10)
    assert normal_study(FIRST * scale).shapiro_w == pytest.approx(normal_study(FIRST).shapiro_w, rel=1e-10)
