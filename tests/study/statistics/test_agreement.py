"""Agreement of curves: values worked by hand, the coverage of intervals, curves that do not vary."""

from math import atanh, isnan, sqrt, tanh

import numpy as np
import pytest

from trocar.errors import InputError
from trocar.study.statistics.agreement import (
    concordance,
    largest_error,
    limits_of_agreement,
    nrmse,
    peak_shift,
)

TIME = np.arange(9.0)
FORCE = np.minimum(TIME, 8 - TIME)


def test_nrmse_by_hand():
    assert nrmse([0, 2, 4], [1, 2, 4]) == pytest.approx(sqrt(1 / 3) / 4, rel=1e-15)
    assert nrmse([5, 2, 4], [5, 2, 4]) == 0


def test_nrmse_needs_a_range():
    with pytest.raises(InputError, match="varies"):
        nrmse([1, 1, 1], [1, 2, 3])


def test_largest_error_keeps_its_sign():
    assert largest_error([0, 2, 4], [1, -1, 4]) == (-3, 1)


def test_peak_shift_by_hand():
    model = np.roll(FORCE, 2) * 1.5
    shift = peak_shift(TIME, FORCE, FORCE, model)
    assert (shift.time, shift.force, shift.height, shift.resolution) == (2, -2, 2, 1)


def test_a_plateau_peaks_where_it_begins():
    held = np.array([0, 1, 2, 2 - 4e-16, 2, 1, 0.5, 0.2, 0])  # the plateau rounds up and down
    later = np.array([0, 1, 1.5, 2, 2 + 4e-16, 2, 0.5, 0.2, 0])
    assert peak_shift(TIME, FORCE, held, later).time == 1


def test_equal_curves_have_no_shift():
    shift = peak_shift(TIME, FORCE, FORCE, FORCE)
    assert (shift.time, shift.force, shift.height) == (0, 0, 0)


def test_time_must_ascend():
    with pytest.raises(InputError, match="ascending"):
        peak_shift([0, 0, 1], [0, 1, 2], [0, 1, 2], [0, 1, 2])


def test_limits_by_hand():
    # differences 1, 2, 3: bias 2, sd 1; t of 2 degrees is 4.30265
    limits = limits_of_agreement([0, 0, 0], [1, 2, 3])
    assert (limits.bias, limits.sd) == (2, 1)
    assert (limits.lower, limits.upper) == pytest.approx((2 - 1.959964, 2 + 1.959964), abs=1e-6)
    assert limits.bias_interval[1] == pytest.approx(2 + 4.30265 / sqrt(3), abs=1e-5)
    half = 4.30265 * sqrt(1 / 3 + 1.959964**2 / 4)
    assert limits.upper_interval == pytest.approx((limits.upper - half, limits.upper + half), abs=1e-4)


def test_limits_hold_95_percent():
    rng = np.random.default_rng(1999)
    differences = rng.normal(0.3, 2.0, 20000)
    limits = limits_of_agreement(np.zeros(20000), differences)
    inside = np.mean((differences > limits.lower) & (differences < limits.upper))
    assert abs(inside - 0.95) < 4 * sqrt(0.95 * 0.05 / 20000)  # four standard errors of a proportion


def test_limits_of_a_constant_difference():
    limits = limits_of_agreement([0.1, 0.2, 0.3], [0.2, 0.3, 0.4])
    assert limits.sd == 0
    assert limits.lower == limits.upper == limits.bias


def test_concordance_by_hand():
    # means 2 and 3, variances over n 2/3 each, covariance 2/3: 4/3 / (4/3 + 1)
    result = concordance([1, 2, 3], [2, 3, 4])
    assert result.value == pytest.approx(4 / 7, rel=1e-14)
    assert result.correlation == pytest.approx(1, rel=1e-14)


def test_concordance_interval_by_lins_formula():
    one, two = np.array([1.0, 2, 3, 4, 5]), np.array([1.5, 1.8, 3.5, 4.4, 4.6])
    result = concordance(one, two)
    r, c = np.corrcoef(one, two)[0, 1], result.value
    u = (one.mean() - two.mean()) / sqrt(one.std() * two.std())
    squared = (1 - r**2) * c**2 / ((1 - c**2) * r**2)
    squared += 2 * c**3 * (1 - c) * u**2 / (r * (1 - c**2) ** 2) - c**4 * u**4 / (2 * r**2 * (1 - c**2) ** 2)
    half = 1.959964 * sqrt(squared / 3)
    assert (result.low, result.high) == pytest.approx(
        (tanh(atanh(c) - half), tanh(atanh(c) + half)), rel=1e-6
    )


def test_concordance_interval_covers_the_truth():
    rng = np.random.default_rng(1989)
    truth, hits, runs = 2 * 0.9 / (1 + 1 + 0.3**2), 0, 1000
    for _ in range(runs):
        one = rng.normal(size=80)
        two = 0.9 * one + sqrt(1 - 0.81) * rng.normal(size=80) + 0.3
        result = concordance(one, two)
        hits += result.low <= truth <= result.high
    assert (
        abs(hits / runs - 0.95) < 0.03
    )  # four standard errors, 0.0276, of a proportion; Lin's z is asymptotic


@pytest.mark.parametrize("curve", [FORCE, -FORCE + 3, FORCE * 1e-9], ids=str)
def test_a_curve_agrees_with_itself(curve):
    result = concordance(curve, curve)
    assert result.value == pytest.approx(1, rel=1e-14)
    assert result.low == result.value == result.high


def test_concordance_is_the_smaller_the_further_off():
    values = [concordance(FORCE, FORCE * (1 + gain)).value for gain in (0, 0.01, 0.1, 0.5, 2)]
    assert values == sorted(values, reverse=True)


def test_concordance_of_curves_that_do_not_vary():
    assert concordance([0.1] * 3, [0.1] * 3).value == 1
    assert concordance([0.1] * 3, [0.2] * 3).value == 0
    flat = concordance([0.1] * 9, FORCE)
    assert flat.value == 0
    assert isnan(flat.low)
    assert isnan(concordance([-1, 0, 1, 0], [0, -1, 0, 1]).low)  # no correlation at all


@pytest.mark.parametrize("measure", [nrmse, largest_error, limits_of_agreement, concordance])
@pytest.mark.parametrize("curve", [[1, 2], [1, np.nan, 2], [1, 2, 3, 4]], ids=str)
def test_impossible_curves_are_refused(measure, curve):
    with pytest.raises(InputError):
        measure([1, 2, 3], curve)
