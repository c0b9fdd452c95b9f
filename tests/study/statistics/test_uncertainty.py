"""Effective samples against an autoregressive series, extrapolation of power laws, validation errors."""

from math import isnan, sqrt

import numpy as np
import pytest

from trocar.errors import InputError
from trocar.study.statistics.uncertainty import (
    Convergence,
    effective_sample_size,
    lag_one_autocorrelation,
    refinement,
    validation,
)


def autoregressive(rng, r, n, runs):
    noise = rng.normal(size=(runs, n))
    series = np.empty((runs, n))
    series[:, 0] = noise[:, 0] / sqrt(1 - r**2)
    for i in range(1, n):
        series[:, i] = r * series[:, i - 1] + noise[:, i]
    return series


def test_effective_size_predicts_the_spread_of_means():
    n, r = 400, 0.8
    series = autoregressive(np.random.default_rng(7), r, n, 1500)
    worth = series.var() / series.mean(axis=1).var()
    estimates = [effective_sample_size(one) for one in series[:200]]
    assert worth == pytest.approx(
        n * (1 - r) / (1 + r), rel=0.15
    )  # four standard errors of a variance of 1500
    assert np.median(estimates) == pytest.approx(worth, rel=0.2)  # and the bias of an estimated r, about 3/n


def test_points_along_a_curve_are_few_samples():
    ramp = np.minimum(np.arange(81.0), 80 - np.arange(81.0))
    assert effective_sample_size(ramp) < 3


def test_effective_size_stays_between_one_and_all():
    assert effective_sample_size([1.0, -1.0] * 20) == 40
    assert 1 <= effective_sample_size(np.arange(10000.0)) < 2
    assert effective_sample_size([0.1] * 12) == 12


def test_autocorrelation_by_hand():
    assert lag_one_autocorrelation([1, 2, 3, 4]) == pytest.approx(0.25, rel=1e-15)  # (.75 - .25 + .75) / 5
    assert lag_one_autocorrelation([0.1] * 5) == 0


@pytest.mark.parametrize("order", [0.5, 1, 1.7, 2, 3.5])
@pytest.mark.parametrize("sizes", [(4, 2, 1), (0.9, 0.5, 0.3), (3, 2, 1)], ids=str)
def test_power_law_is_extrapolated_exactly(order, sizes):
    results = [3 - 0.4 * h**order for h in sizes]
    found = refinement(results, sizes, formal_order=4)
    assert found.kind is Convergence.MONOTONE
    assert found.observed_order == pytest.approx(
        order, rel=1e-9
    )  # differences lose about 6 digits at order 3.5
    assert found.extrapolated == pytest.approx(3, rel=1e-9)
    assert found.index == pytest.approx(1.25 * abs(results[2] - 3), rel=1e-8)
    assert found.standard_uncertainty == pytest.approx(found.index / 1.15, rel=1e-15)


def test_order_above_the_formal_one_is_not_trusted():
    sizes = (4, 2, 1)
    found = refinement([1 + h**5 for h in sizes], sizes)
    assert found.observed_order == pytest.approx(5, rel=1e-9)
    assert found.order == 2
    assert found.index > 1.25 * 1  # the true error is 1: the bound holds and is wider


@pytest.mark.parametrize(
    ("results", "kind", "index"),
    [
        ((1.0, 2.0, 2.0), Convergence.CONVERGED, 0.0),
        ((1.0, 2.0, 1.6), Convergence.OSCILLATORY, 1.25),
        ((1.0, 2.0, 3.5), Convergence.DIVERGENT, 7.5),
        ((1.0, 2.0, 0.0), Convergence.DIVERGENT, 6.0),
        ((1.0, 1.0, 2.0), Convergence.DIVERGENT, 3.0),
        ((0.0, 0.0, 0.0), Convergence.CONVERGED, 0.0),
    ],
    ids=str,
)
def test_other_behaviour_is_named_and_bounded(results, kind, index):
    found = refinement(results, (4, 2, 1))
    assert found.kind is kind
    assert found.index == index
    assert found.extrapolated == results[2]
    assert isnan(found.order)


def test_a_leap_in_the_first_step_keeps_a_finite_index():
    found = refinement((-1e9, 1.0, 1.0 + 1e-9), (4, 2, 1))
    assert found.order == 2
    assert found.index == pytest.approx(1.25e-9 / 3, rel=1e-6)


@pytest.mark.parametrize(
    ("results", "sizes", "order"),
    [
        ((1, 2), (2, 1), 2),
        ((1, 2, np.nan), (3, 2, 1), 2),
        ((1, 2, 3), (1, 2, 3), 2),
        ((1, 2, 3), (3, 2, 0), 2),
        ((1, 2, 3), (np.inf, 2, 1), 2),
        ((1, 2, 3), (np.nan, 2, 1), 2),
        ((1, 2, 3), (3, 2, 1), 0),
    ],
    ids=str,
)
def test_impossible_refinements_are_refused(results, sizes, order):
    with pytest.raises(InputError):
        refinement(results, sizes, order)


def test_validation_error_and_its_uncertainty():
    found = validation(1.1, 1.0, 0.03, 0.04)
    assert found.error == pytest.approx(0.1, rel=1e-14)
    assert found.uncertainty == pytest.approx(0.05, rel=1e-14)
    assert found.model_error == pytest.approx((0.0, 0.2), abs=1e-15)
    assert not validation(1.05, 1.0, 0.03, 0.04).resolved
    assert validation(1.2, 1.0, 0.03, 0.04).resolved
    assert validation(1.2, 1.0).resolved


@pytest.mark.parametrize("numbers", [(np.nan, 1), (1, np.inf), (1, 1, -0.1), (1, 1, np.nan)], ids=str)
def test_impossible_validations_are_refused(numbers):
    with pytest.raises(InputError):
        validation(*numbers)
