"""Playing a recording back: the contract, straight lines between moments, presence that does not move."""

from dataclasses import replace

import pytest

from contracts.device import INSTRUMENTS, SIZE, DeviceContract
from trocar.devices.device import LEFT, RIGHT, HandlePose
from trocar.devices.examination import examine
from trocar.devices.recorded import RecordedDevice
from trocar.devices.recorder import moments_of, thinned
from trocar.devices.recording import Moment, write_recording
from trocar.devices.simulated import SimulatedDevice
from trocar.errors import InputError

HANDLE = INSTRUMENTS[LEFT].handle
POSE = HandlePose(present=True, handle=HANDLE, roll=0.0, jaw=1.0)


class TestRecordedDevice(DeviceContract):
    @pytest.fixture(scope="class")
    @classmethod
    def make(cls, tmp_path_factory):
        device = SimulatedDevice("lift", seed=2)
        path = tmp_path_factory.mktemp("recordings") / "lift.csv"
        write_recording(path, thinned(moments_of(device, seconds=device.duration, rate=50.0)))
        return lambda: RecordedDevice(path)


def played(path, *moments):
    write_recording(path, [Moment(time=time, instrument=which, pose=pose) for time, which, pose in moments])
    return RecordedDevice(path)


def test_it_goes_straight_between_moments_and_holds_at_the_ends(tmp_path):
    there = replace(POSE, handle=(HANDLE[0], HANDLE[1], HANDLE[2] + 0.01), roll=2.0, jaw=0.0)
    device = played(tmp_path / "a.csv", (1.0, LEFT, POSE), (3.0, LEFT, there))
    assert device.duration == 3.0
    assert device.poses(0.0)[LEFT] == device.poses(1.0)[LEFT] == POSE
    assert device.poses(3.0)[LEFT] == device.poses(9.0)[LEFT] == there
    between = device.poses(1.5)[LEFT]
    assert between.handle == pytest.approx((HANDLE[0], HANDLE[1], HANDLE[2] + 0.0025))
    assert (between.roll, between.jaw) == pytest.approx((0.5, 0.75))


def test_an_instrument_comes_and_goes_without_travelling(tmp_path):
    away = replace(POSE, present=False, handle=(0.5, 0.5, 0.5))
    device = played(tmp_path / "a.csv", (0.0, LEFT, POSE), (1.0, LEFT, away), (2.0, LEFT, POSE))
    assert device.poses(0.999)[LEFT] == POSE
    assert device.poses(1.0)[LEFT] == device.poses(1.999)[LEFT] == away
    assert device.poses(2.0)[LEFT] == POSE


def test_an_instrument_that_was_not_recorded_is_absent(tmp_path):
    device = played(tmp_path / "a.csv", (0.0, RIGHT, replace(POSE, handle=INSTRUMENTS[RIGHT].handle)))
    assert not device.poses(0.0)[LEFT].present
    assert device.poses(0.0)[RIGHT].present


def test_a_recording_plays_what_was_recorded(tmp_path):
    device = SimulatedDevice("press", seed=3)
    write_recording(tmp_path / "a.csv", moments_of(device, seconds=4.0, rate=1000.0))
    again = RecordedDevice(tmp_path / "a.csv")
    for time in (0.0, 0.5, 1.777, 4.0):
        for one, other in zip(device.poses(time), again.poses(time), strict=True):
            assert one.handle == pytest.approx(other.handle, abs=6e-10)  # written to the nanometre
            assert (one.roll, one.jaw) == pytest.approx((other.roll, other.jaw), abs=6e-10)


def test_moments_of_a_pose_that_stays_are_left_out_without_changing_anything(tmp_path):
    device = SimulatedDevice("lift", tremor=0.0, noise=0.0)
    every = list(moments_of(device, seconds=device.duration, rate=50.0))
    fewer = list(thinned(every))
    assert len(fewer) < 0.8 * len(every)
    assert [moment.time for moment in fewer] == sorted(moment.time for moment in fewer)
    write_recording(tmp_path / "every.csv", every)
    write_recording(tmp_path / "fewer.csv", fewer)
    one, other = RecordedDevice(tmp_path / "every.csv"), RecordedDevice(tmp_path / "fewer.csv")
    assert one.duration == other.duration
    for number in range(0, 1490, 7):
        assert one.poses(number / 100) == other.poses(number / 100)


def test_a_jump_is_found(tmp_path):
    far = replace(POSE, handle=INSTRUMENTS[LEFT].handle_for((0.05, 0.05, 0.0)))
    device = played(tmp_path / "a.csv", (0.0, LEFT, POSE), (0.01, LEFT, far))
    left, right = examine(device, INSTRUMENTS, SIZE, seconds=0.1)
    assert left.complaints[0].startswith("left at 0.001 s: a tip faster than 1 m/s")
    assert len(left.complaints) == 3  # the first few
    assert right.complaints == []


@pytest.mark.parametrize(("seconds", "rate"), [(0.0, 50.0), (1.0, 0.0), (1.0, 2000.0), (float("nan"), 50.0)])
def test_an_impossible_recording_is_refused(seconds, rate):
    with pytest.raises(InputError, match="recording"):
        list(moments_of(SimulatedDevice(), seconds=seconds, rate=rate))
