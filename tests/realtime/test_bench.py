"""The servo beside an empty loop: counts that add up. How long anything took is not tested."""

import json

import pytest

from realtime.toy_scene import TOY, at_rest, toy_scene
from trocar.contact.instrument import default_instruments
from trocar.devices.device import HandlePose
from trocar.errors import InputError
from trocar.realtime.bench import alternate
from trocar.realtime.sliding import DEPTH, circling
from trocar.simulation.live import LIVE_SIZE

PRESSING = HandlePose(present=True, handle=(0.0, 0.0, -5e-3), roll=0.0, jaw=1.0)


@pytest.fixture(scope="module")
def found():
    return alternate(
        toy_scene(), at_rest(), lambda time: (PRESSING, PRESSING), seconds=1.0, rounds=1, physics=TOY
    )


def test_loops_take_turns(found):
    assert [one.loop for one in found.rounds] == ["empty", "servo", "empty"]
    assert found.empty.ticks == found.rounds[0].ticks + found.rounds[2].ticks


def test_every_due_time_is_a_tick_or_missed(found):
    for one in (found.rounds[0], found.rounds[2]):
        # What a last tick skips may lie beyond the end: a stopped machine may add any number there.
        assert one.ticks + one.missed >= 1000
        assert one.missed_percent == pytest.approx(100 * one.missed / (one.ticks + one.missed))


def test_percentiles_are_in_order_and_the_tips_touched(found):
    servo = found.servo
    assert 0 < servo.tick_p50_us <= servo.tick_p99_us <= servo.tick_p999_us
    assert 0 < servo.late_p50_us <= servo.late_p99_us <= servo.late_p999_us
    assert servo.touching == 1.0
    assert json.loads(json.dumps(found.as_dict()))["servo"]["ticks"] == servo.ticks


@pytest.mark.parametrize(("seconds", "rounds"), [(0.5, 1), (1e9, 1), (2.0, 0), (float("nan"), 1)])
def test_no_measurement_without_time(seconds, rounds):
    with pytest.raises(InputError):
        alternate(toy_scene(), at_rest(), lambda time: (PRESSING, PRESSING), seconds=seconds, rounds=rounds)


def test_the_tips_come_down_and_stay_in_the_tissue():
    instruments = default_instruments(LIVE_SIZE)
    motion = circling(instruments, LIVE_SIZE, DEPTH)
    for time, height in ((0.0, 5e-3), (0.5, -DEPTH), (3.3, -DEPTH)):
        for instrument, pose in zip(instruments, motion(time), strict=True):
            tip = instrument.reach_of(pose.handle).tip
            assert tip[2] == pytest.approx(height, abs=1e-9)
            assert 0 < tip[0] < LIVE_SIZE[0]
