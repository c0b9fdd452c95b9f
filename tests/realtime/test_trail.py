"""The trail: every tick with the poses it consumed, from which they can be followed once more, bit by bit."""

import numpy as np
import pytest

from realtime.conftest import beaten
from realtime.toy_scene import until
from trocar.realtime.shared import TRAIL, TRAIL_TICKS, Trail
from trocar.realtime.tracking import Following, absent, follow_again
from trocar.realtime.trail import leave, read_trail
from trocar.simulation import HANDLE, POSE, PRESENT, RECORD


def written(count):
    """Return a trail after so many ticks; handle x, and the first real of the record, are the tick's number."""
    trail = Trail(written=np.zeros(1, np.int64), rows=np.zeros((TRAIL_TICKS, TRAIL)))
    track, records = absent(), np.zeros((2, RECORD))
    for tick in range(count):
        track.target[:, HANDLE] = tick
        track.pose[:, HANDLE] = tick + 0.5
        records[:, 0] = tick
        leave(trail, tick % 10 == 0, 3 * tick, track, records)
    return trail


def test_every_tick_is_there_once_and_in_order():
    ticks = read_trail(written(25), 0)
    assert (len(ticks), ticks.first, ticks.lost) == (25, 0, 0)
    assert ticks.targets[:, 1, HANDLE].tolist() == list(range(25))
    assert ticks.poses[:, 0, HANDLE].tolist() == [tick + 0.5 for tick in range(25)]
    assert ticks.records[:, 1, 0].tolist() == list(range(25))
    assert ticks.missed.tolist() == [3 * tick for tick in range(25)]
    assert np.flatnonzero(ticks.began).tolist() == [0, 10, 20]


def test_reading_goes_on_where_it_stopped():
    trail = written(25)
    assert read_trail(trail, 20).records[:, 0, 0].tolist() == [20, 21, 22, 23, 24]
    assert len(read_trail(trail, 25)) == 0
    assert len(read_trail(trail, 99)) == 0


def test_who_comes_too_late_is_told_how_many_ticks_are_gone():
    count = TRAIL_TICKS + 500
    ticks = read_trail(written(count), 100)
    assert ticks.lost > 400
    assert ticks.first == 100 + ticks.lost
    assert ticks.records[:, 0, 0].tolist() == list(range(ticks.first, count))


def test_a_servo_leaves_what_it_followed_and_it_can_be_followed_again(make_servo):
    with make_servo() as servo, beaten(servo):
        for sequence, x in enumerate(np.linspace(0.0, 0.05, 20), 100):
            servo.command(0, present=True, handle=(x, 0.0, 0.1), roll=x, sequence=sequence)
            assert until(lambda number=sequence: servo.latest().sequences[0] == number)
        servo.reset()
        assert until(lambda: servo.latest().resets == 1)
        for hand, x in ((1, 0.1), (0, 0.0)):
            servo.command(hand, present=True, handle=(x, 0.0, 0.1), sequence=200)
        assert until(lambda: servo.latest().sequences == (200, 200))
        tick = servo.latest().tick
        assert until(lambda: servo.latest().tick > tick + 100)
        ticks = read_trail(servo.trail, 0)
        following = servo.following
    assert (ticks.first, ticks.lost) == (0, 0)
    begins = np.flatnonzero(ticks.began)
    assert (len(begins), begins[0]) == (2, 0)
    targets, began, wanted = (each[begins[1] :] for each in (ticks.targets, ticks.began, ticks.poses))
    poses = np.zeros((len(targets), 2, POSE))
    follow_again(following, absent(), targets, began, 1e-3, poses)
    np.testing.assert_array_equal(poses, wanted)
    assert np.ptp(poses[:, 0, HANDLE]) > 0.04
    assert poses[-1, 1, PRESENT] == 1.0


@pytest.mark.parametrize("hand", [0, 1])
def test_a_start_from_rest_owes_nothing_to_what_was(hand):
    """Two states that differ in all but the newest pose go on alike."""
    targets = np.zeros((5, 2, POSE))
    targets[:, hand, PRESENT] = 1.0
    targets[:, hand, HANDLE] = np.linspace(0.0, 0.01, 5)
    began = np.array([True, False, False, False, False])
    ways = []
    for speed in (0.0, 3.0):
        state = absent()
        state.pose[:] = speed
        state.velocity[:] = speed
        poses = np.zeros((5, 2, POSE))
        follow_again(Following(), state, targets, began, 1e-3, poses)
        ways.append(poses)
    np.testing.assert_array_equal(*ways)
