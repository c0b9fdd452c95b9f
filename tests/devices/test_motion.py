"""Minimum-jerk paths: their ends, their speed, their jerk."""

from math import inf

import numpy as np
import pytest

from trocar.devices.motion import Path, Waypoint, between
from trocar.errors import InputError

PATH = Path(
    (
        Waypoint(after=7.0, tip=(0.0, 0.0, 0.0), jaw=1.0),
        Waypoint(after=2.0, tip=(0.3, -0.4, 0.0), roll=1.0, jaw=0.0),
        Waypoint(after=1.0, tip=(0.3, -0.4, 0.0), jaw=0.3),
    )
)


def test_it_begins_at_once_and_holds_at_its_ends():
    assert PATH.duration == 3.0
    assert PATH.at(-1.0) == PATH.at(0.0) == ((0.0, 0.0, 0.0), 0.0, 1.0)
    assert PATH.at(2.0) == ((0.3, -0.4, 0.0), 1.0, 0.0)
    assert PATH.at(3.0) == PATH.at(1e6) == ((0.3, -0.4, 0.0), 0.0, 0.3)


def test_halfway_in_time_is_halfway_in_space():
    tip, roll, jaw = PATH.at(1.0)
    assert tip == pytest.approx((0.15, -0.2, 0.0))
    assert (roll, jaw) == pytest.approx((0.5, 0.5))


def test_peak_speed_is_fifteen_eighths_of_the_mean():
    times = np.linspace(0.0, 2.0, 2001)
    tips = np.array([PATH.at(time)[0] for time in times])
    speed = np.linalg.norm(np.diff(tips, axis=0), axis=1) / np.diff(times)
    assert speed.max() == pytest.approx(15 / 8 * 0.25, rel=1e-5)  # second differences of 1 ms
    assert speed[[0, -1]] == pytest.approx(0.0, abs=1e-5)


def test_its_jerk_is_the_least():
    # The integral of squared jerk from rest to rest is 720 distance^2/duration^5 at least (Flash and Hogan 1985).
    times = np.linspace(0.0, 2.0, 4001)
    along = np.array([np.hypot(*PATH.at(time)[0][:2]) for time in times])
    step = times[1]
    jerk = np.diff(along, n=3) / step**3
    assert (jerk**2).sum() * step == pytest.approx(
        720 * 0.5**2 / 2**5, rel=5e-3
    )  # the ends are cut off by differences


@pytest.mark.parametrize("after", [0.0, -1.0, inf])
def test_a_segment_takes_time(after):
    with pytest.raises(InputError, match="waypoint 1: after"):
        Path((PATH.waypoints[0], Waypoint(after=after, tip=(0.0, 0.0, 0.0))))


def test_a_path_goes_somewhere():
    with pytest.raises(InputError, match="at least one waypoint"):
        Path(())


def test_rounding_never_leads_beyond_the_ends():
    rng = np.random.default_rng(1)
    for start, end in rng.uniform(0.0, 1.0, (1000, 2)):
        for share in (1.0, 1.0 + 1e-15, np.nextafter(1.0, 0.0)):
            assert min(start, end) <= between(start, end, share) <= max(start, end)
