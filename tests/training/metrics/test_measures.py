"""Metrics of attempts whose answers are known in closed form."""

from math import isnan, pi
from pathlib import Path

import numpy as np
import pytest

from trocar.errors import InputError
from trocar.simulation import (
    DIRECTION,
    FORCE,
    OUTSIDE,
    RECORD,
    RECORD_ROLL,
    TIP,
    TOUCH,
    TOUCH_PRESENT,
    TOUCH_TOUCHING,
)
from trocar.training.metrics.attempt import Attempt
from trocar.training.metrics.measures import MEASURES, measured
from trocar.training.metrics.motion import smooth_path, time_above

SECONDS, TURN, RADIUS = 20.0, 1.0, 0.015  # a tip goes round twenty times; a jerk of 3.7 m/s^3, as hands have
NOISE = 20e-6  # [m]


def circling(rate=1000, hands=(0, 1), seed=None):
    """Both tips go round in opposite senses, the shafts turn with them, and the left presses half of the time."""
    times = np.arange(0.0, SECONDS, 1 / rate)
    angle = 2 * pi * times / TURN + 0.5 * np.sin(2 * pi * times / 2.5)  # faster and slower
    records = np.zeros((len(times), 2, RECORD))
    for hand in hands:
        sense = (-1) ** hand
        place = np.stack([RADIUS * np.cos(angle), sense * RADIUS * np.sin(angle), 0 * angle], axis=1)
        records[:, hand, TIP : TIP + 3] = place
        records[:, hand, DIRECTION] = np.sin(0.1 * np.cos(angle))
        records[:, hand, DIRECTION + 2] = -np.cos(0.1 * np.cos(angle))
        records[:, hand, RECORD_ROLL] = 0.05 * angle
        records[:, hand, OUTSIDE] = 0.2 + 0.01 * np.sin(angle)
        records[:, hand, TOUCH] = TOUCH_PRESENT
    pressing = times < SECONDS / 2
    records[pressing, 0, FORCE + 2] = 0.5
    records[pressing, 0, TOUCH] = TOUCH_PRESENT + TOUCH_TOUCHING
    if seed is not None:
        noise = np.random.default_rng(seed).normal(0.0, NOISE, (len(times), 2, 3))
        records[:, :, TIP : TIP + 3] += noise
    return times, records


def attempt(**options):
    times, records = circling(**options)
    return Attempt(
        times=times,
        records=records,
        force_limit=0.4,
        ideal_length=0.4,
        errors=3,
        strength=1e5,
        sections=np.array([1e-5, 2e-5]),
    )


def test_what_is_known_in_closed_form():
    found = measured(attempt())
    turns = SECONDS / TURN
    around = (
        2 * pi * RADIUS * turns
    )  # of one tip; polygons of 100 sides a turn lose 2e-4, the filter's ends some 1e-3
    assert found["time"] == pytest.approx(SECONDS, rel=1e-4)
    assert found["path_length"] == pytest.approx(2 * around, rel=2e-3)
    assert found["economy_of_motion"] == pytest.approx(0.4 / (2 * around), rel=2e-3)
    assert found["angular_path"] == pytest.approx(2 * turns * (4 * 0.1 + 0.05 * 2 * pi), rel=5e-3)
    assert found["depth_perception"] == pytest.approx(2 * turns * 4 * 0.01, rel=5e-3)
    assert found["idle_time"] == 0.0
    assert found["both_moving"] == 1.0
    assert found["peak_force"] == 0.5
    assert found["peak_stress_ratio"] == pytest.approx(0.5)
    assert found["errors"] == 3
    assert found["rms_force"] == pytest.approx(0.5)
    assert found["impulse"] == pytest.approx(0.5 * SECONDS / 2, rel=1e-3)
    assert found["time_over_limit"] == pytest.approx(SECONDS / 2, rel=1e-3)


@pytest.mark.parametrize("rate", [250, 500, 1000])
def test_rate_and_noise_change_no_metric_by_more_than_two_per_cent(rate):
    clean, noisy = measured(attempt()), measured(attempt(rate=rate, seed=rate))
    # The force does not follow the noise here, as tissue would: noise works, and only the scene's own forces do right.
    del clean["work_on_tissue"]
    for name, value in clean.items():
        assert noisy[name] == pytest.approx(value, rel=0.02, abs=1e-9, nan_ok=True), name


def test_a_tip_that_rests_goes_nowhere_however_noisy_its_sensor():
    times, records = circling(hands=(0,), seed=3)
    still = times >= SECONDS / 2
    noise = np.random.default_rng(4).normal(0.0, NOISE, (still.sum(), 3))
    records[still, 0, TIP : TIP + 3] = noise + np.array([RADIUS, 0.0, 0.0])
    moved = measured(attempt(hands=(0,)))["path_length"] / 2
    assert measured(Attempt(times=times, records=records))["path_length"] == pytest.approx(moved, rel=0.02)


def test_the_jerk_of_noise_alone_is_taken_off():
    rng, times = np.random.default_rng(5), np.arange(0.0, 60.0, 1 / 250)
    noise = rng.normal(0.0, NOISE, (len(times), 3))
    slow = np.stack([0.01 * np.sin(0.5 * times), 0.0 * times, 0.0 * times], axis=1)
    clean, noisy = smooth_path(times, slow), smooth_path(times, slow + noise)
    there = noisy.jerk() + noisy.noise_jerk  # as it was before
    assert there > 50 * clean.jerk()
    assert noisy.jerk() < 0.15 * there


def test_an_instrument_that_is_not_there_does_not_count():
    one, both = measured(attempt(hands=(0,))), measured(attempt())
    assert one["path_length"] == pytest.approx(both["path_length"] / 2, rel=1e-9)
    assert isnan(one["both_moving"])
    assert isnan(one["bimanual_dexterity"])


def test_hands_that_speed_up_together_and_in_turns():
    times = np.arange(0.0, 20.0, 1e-3)
    beat = 1 + 0.8 * np.sin(2 * pi * 0.5 * times)
    for other, sign in ((beat, 1.0), (2 - beat, -1.0)):
        records = np.zeros((len(times), 2, RECORD))
        records[:, :, TOUCH] = TOUCH_PRESENT
        records[:, 0, TIP] = 0.01 * np.cumsum(beat) * 1e-3
        records[:, 1, TIP] = 0.01 * np.cumsum(other) * 1e-3
        found = measured(Attempt(times=times, records=records))
        assert found["bimanual_dexterity"] == pytest.approx(sign, abs=0.01)


def test_standing_still_is_idle():
    times, records = circling(hands=(0,))
    half = len(times) // 2
    records[half:, 0, TIP : TIP + 3] = records[half - 1, 0, TIP : TIP + 3]
    assert measured(Attempt(times=times, records=records))["idle_time"] == pytest.approx(SECONDS / 2, abs=0.3)


def test_an_attempt_without_instruments_or_of_another_shape_is_refused():
    times, records = circling()
    with pytest.raises(InputError, match="instrument in a hand"):
        Attempt(times=times, records=np.zeros_like(records))
    with pytest.raises(InputError, match="shape"):
        Attempt(times=times, records=records[:-1])


def test_each_measure_says_what_it_is():
    names = [measure.name for measure in MEASURES]
    assert len(set(names)) == len(names)
    for measure in MEASURES:
        assert all((measure.unit, measure.formula, measure.source, measure.cannot_tell))


def test_the_page_on_scores_has_a_line_for_each_measure_with_its_unit_and_no_other():
    page = (Path(__file__).parents[3] / "docs/explanation/scores.md").read_text(encoding="utf-8")
    table = page.split("| metric |", 1)[1].split("\n\n", 1)[0]
    found = [line.split("|")[1].strip() for line in table.splitlines()[2:]]
    assert found == [f"{measure.name.replace('_', ' ')} [{measure.unit}]" for measure in MEASURES]


def test_time_above_a_limit_is_that_of_straight_lines():
    times, values = np.array([0.0, 1.0, 2.0, 4.0, 5.0]), np.array([0.0, 2.0, 2.0, 0.0, 0.0])
    assert time_above(times, values, 1.0) == pytest.approx(0.5 + 1.0 + 1.0)
    assert time_above(times, values, 2.0) == 0.0
    assert time_above(times, values, -1.0) == 5.0
    assert time_above(times, values, np.inf) == 0.0
