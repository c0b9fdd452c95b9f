"""Histograms of ticks against NumPy's percentiles, and rates against what was put in."""

import numpy as np
import pytest

from trocar.realtime.clock import SECOND
from trocar.realtime.percentiles import (
    BINS,
    DURATION,
    LATENESS,
    bin_of,
    count_tick,
    last_second,
    quantile,
    unpaced,
)

PERIOD = SECOND // 1000


def run(pace, ticks, *, begin=100 * SECOND, took=20_000, late=30_000, every=1):
    """Count ticks, of which only each `every`-th due time is met; return the next due time [ns]."""
    for tick in range(ticks):
        due = begin + tick * every * PERIOD
        count_tick(pace, due, due + late, due + late + took, every - 1)
    return begin + ticks * every * PERIOD


@pytest.mark.parametrize("share", [0.5, 0.99, 0.999])
def test_a_percentile_is_right_within_a_bin(share):
    times = np.random.default_rng(1).lognormal(np.log(20e3), 0.7, 20_000)
    counts = np.zeros((2, BINS), np.int64)
    for k, time in enumerate(times):
        counts[k % 2, bin_of(time)] += 1
    # Half a bin is 2^(1/32) = 2.2 %; the sample's own gap at 0.999 adds to it.
    assert quantile(counts, share) == pytest.approx(1e-9 * np.quantile(times, share), rel=0.03)


def test_no_time_falls_outside_the_bins():
    assert [bin_of(time) for time in (-1.0, 0.0, np.nan, 100.0)] == [0, 0, 0, 0]
    assert bin_of(1e15) == BINS - 1


def test_nothing_counted_is_no_time():
    assert quantile(np.zeros((2, BINS), np.int64), 0.5) == 0.0


def test_a_full_rate_is_seen_after_a_whole_second():
    pace, out = unpaced(), np.zeros(2)
    begin = run(pace, 1000)
    assert not last_second(pace, out)
    run(pace, 300, begin=begin)
    assert last_second(pace, out)
    assert out.tolist() == [1000, 0]


def test_half_the_ticks_missed_are_half_the_rate():
    pace, out = unpaced(), np.zeros(2)
    run(pace, 1300, every=2)
    assert last_second(pace, out)
    assert out == pytest.approx([500, 500], abs=1)


def test_a_second_asleep_is_a_second_without_ticks():
    pace, out = unpaced(), np.zeros(2)
    begin = run(pace, 1500)
    run(pace, 1, begin=begin + 5 * SECOND)
    assert last_second(pace, out)
    assert out[0] == 0


def test_the_window_forgets_and_the_totals_do_not():
    pace = unpaced()
    begin = run(pace, 2000, took=400_000)
    run(pace, 3000, begin=begin, took=20_000)
    assert quantile(pace.windows[:, DURATION], 0.999) == pytest.approx(20e-6, rel=0.03)
    assert quantile(pace.windows[:, LATENESS], 0.5) == pytest.approx(30e-6, rel=0.03)
    assert pace.totals[DURATION].sum() == 5000
    assert quantile(pace.totals[DURATION : DURATION + 1], 0.9) == pytest.approx(400e-6, rel=0.03)
