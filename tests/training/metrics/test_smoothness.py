"""Smoothness against closed forms and published values."""

from math import isnan, sqrt

import numpy as np
import pytest

from trocar.errors import InputError
from trocar.training.metrics.motion import smooth_path
from trocar.training.metrics.smoothness import (
    integrated_jerk,
    log_dimensionless_jerk,
    movements,
    sparc,
    sparc_of_movements,
)

RATES = (100, 250, 500, 1000)


def reach(rate, seconds=2.0, length=0.1, rest=0.0):
    """A minimum-jerk reach along a slanted line, at rest before and after."""
    times = np.arange(0.0, seconds + 2 * rest + 0.5 / rate, 1.0 / rate)
    share = np.clip((times - rest) / seconds, 0.0, 1.0)
    way = length * (10 * share**3 - 15 * share**4 + 6 * share**5)
    return times, way[:, None] * np.array([0.6, 0.0, -0.8])


@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("seconds", [1.0, 2.0, 4.0])
def test_a_minimum_jerk_reach_has_the_square_root_of_360(rate, seconds):
    assert integrated_jerk(smooth_path(*reach(rate, seconds))) == pytest.approx(
        sqrt(360), rel=0.01
    )  # asked for


@pytest.mark.parametrize("rate", RATES)
def test_the_log_of_its_dimensionless_jerk(rate):
    # int j^2 = 720 L^2/T^5 and v_max = 15/8 L/T, so T^3/v_max^2 int j^2 = 204.8. The filter takes a little of v_max.
    assert log_dimensionless_jerk(smooth_path(*reach(rate))) == pytest.approx(-np.log(204.8), abs=0.01)


def test_size_changes_neither():
    small, large = (smooth_path(*reach(500, length=length)) for length in (0.003, 0.1))
    assert integrated_jerk(small) == pytest.approx(integrated_jerk(large), rel=1e-9)
    assert log_dimensionless_jerk(small) == pytest.approx(log_dimensionless_jerk(large), abs=1e-9)


def test_the_published_spectral_arc_length():
    assert sparc(np.exp(-5 * np.arange(-1, 1, 0.01) ** 2), 100.0) == pytest.approx(-1.41403, abs=5e-6)


def test_a_hesitation_makes_all_three_worse():
    _, there = reach(500, 1.0)
    _, back = reach(500, 1.0)
    both = np.concatenate([there, there[-1] + back[1:]])
    smooth, halting = smooth_path(*reach(500, 2.0, length=0.2)), smooth_path(np.arange(len(both)) / 500, both)
    assert integrated_jerk(halting) > 2 * integrated_jerk(smooth)
    assert log_dimensionless_jerk(halting) < log_dimensionless_jerk(smooth)
    assert sparc(halting.speed) < sparc(smooth.speed)


def test_movements_are_found_between_rests():
    _, one = reach(500, 1.0, rest=0.5)
    two = np.concatenate([one, one[-1] + one[1:]])
    found = movements(smooth_path(np.arange(len(two)) / 500, two))
    assert len(found) == 2
    assert sparc_of_movements(smooth_path(np.arange(len(two)) / 500, two)) == pytest.approx(-1.4, abs=0.1)


def test_what_stands_still_has_no_smoothness():
    still = smooth_path(np.arange(0, 1, 0.01), np.zeros((100, 3)))
    assert isnan(integrated_jerk(still))
    assert isnan(log_dimensionless_jerk(still))
    assert isnan(sparc_of_movements(still))


def test_a_gap_is_bridged():
    times, places = reach(1000)
    kept = np.ones(len(times), dtype=bool)
    kept[700:720] = False  # twenty ticks were missed
    whole, gapped = smooth_path(times, places), smooth_path(times[kept], places[kept])
    assert gapped.length() == pytest.approx(whole.length(), rel=1e-3)
    assert integrated_jerk(gapped) == pytest.approx(integrated_jerk(whole), rel=0.01)


@pytest.mark.parametrize(
    ("times", "places", "words"),
    [
        ([], np.zeros((0, 3)), "at least 0.1 s"),
        ([0.0, 0.05], np.zeros((2, 3)), "at least 0.1 s"),
        ([0.0, 0.2, 0.1, 0.4], np.zeros((4, 3)), "rising"),
        ([0.0, 0.2, 0.4], [0.0, np.nan, 0.0], "finite"),
    ],
)
def test_what_is_no_motion_is_refused(times, places, words):
    with pytest.raises(InputError, match=words):
        smooth_path(np.array(times), np.array(places))
