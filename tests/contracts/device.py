"""What every device owes the trainer. A test module binds it: subclass, and give the fixture `make`."""

from math import dist, isfinite

import pytest
from hypothesis import given, seed, settings
from hypothesis import strategies as st

from trocar.contact.instrument import default_instruments
from trocar.devices.device import FARTHEST, Device
from trocar.devices.examination import examine

SIZE = (0.06, 0.06)
INSTRUMENTS = default_instruments(SIZE)
NOTHING = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
TIMES = st.floats(0.0, 60.0)  # within the longest script and well beyond its end


def few(test):
    """Try a hypothesis often enough for a slip, seldom enough for a busy machine; always the same examples."""
    return seed(4)(settings(max_examples=60, deadline=None, database=None)(test))


class DeviceContract:
    """Inherit, and give `make`: a class-scoped fixture that makes the device anew at each call, not open yet.

    Hands that are held by nobody, as in a test, obey it too: they stay.
    """

    @pytest.fixture(scope="class")
    @classmethod
    def device(cls, make):
        made = make()
        made.open()
        yield made
        made.close()

    def test_it_is_a_device_and_says_what_it_is(self, device):
        assert isinstance(device, Device)
        assert device.name
        assert device.description
        assert {type(device.steered_by_page), type(device.every_tick)} == {bool}

    @few
    @given(time=TIMES)
    def test_poses_are_finite_near_and_possible(self, device, time):
        for pose, instrument in zip(device.poses(time), INSTRUMENTS, strict=True):
            assert all(map(isfinite, (*pose.handle, pose.roll)))
            assert 0.0 <= pose.jaw <= 1.0
            nearest = [min(max(c, 0.0), side) for c, side in zip(pose.handle, (*SIZE, 0.0), strict=True)]
            assert dist(pose.handle, nearest) <= FARTHEST
            if pose.present:
                tip = instrument.reach_of(pose.handle).tip
                assert instrument.handle_for(tip) == pytest.approx(
                    pose.handle, abs=1e-14
                )  # rounding of 0.3 m

    @few
    @given(times=st.lists(TIMES, min_size=1, max_size=5))
    def test_devices_made_alike_give_the_same_bits_in_whatever_order(self, device, make, times):
        other = make()
        other.open()
        backwards = [other.poses(time) for time in reversed(times)]
        assert [device.poses(time) for time in times] == backwards[::-1]
        other.close()

    def test_no_tip_jumps(self, make):
        found = examine(make(), INSTRUMENTS, SIZE, seconds=3.0)
        assert [each.complaints for each in found] == [[], []]

    def test_forces_do_not_move_what_has_no_motors(self, device):
        before = device.poses(1.0)
        device.feel(NOTHING)
        device.feel(((0.0, 0.0, 3.0), (1.0, -2.0, 0.5)))
        assert device.poses(1.0) == before

    def test_what_is_finished_stays_finished(self, device):
        assert device.duration > 0
        assert not device.finished(0.0)
        if isfinite(device.duration):
            assert not device.finished(0.99 * device.duration)
            assert device.finished(device.duration)
            assert device.finished(2 * device.duration)
            assert device.poses(device.duration)[0].roll == device.poses(2 * device.duration)[0].roll
        else:
            assert not device.finished(1e9)

    def test_it_can_be_closed_twice_and_opened_again(self, make):
        device = make()
        device.open()
        first = device.poses(0.5)
        device.close()
        device.close()
        device.open()
        assert device.poses(0.5) == first
        device.close()
