"""The page's hands: the newest pose counts."""

import pytest

from contracts.device import INSTRUMENTS, DeviceContract
from trocar.devices.device import LEFT, RIGHT, HandlePose
from trocar.devices.web import WebDevice
from trocar.errors import InputError


class TestWebDevice(DeviceContract):
    @pytest.fixture(scope="class")
    @classmethod
    def make(cls):
        return WebDevice


def test_nobody_holds_anything_at_first():
    device = WebDevice(instruments=INSTRUMENTS)
    device.open()
    for pose, instrument in zip(device.poses(0.0), INSTRUMENTS, strict=True):
        assert not pose.present
        assert pose.handle == instrument.handle


def test_the_newest_pose_of_each_hand_counts():
    device = WebDevice()
    device.open()
    for number in range(3):
        newest = HandlePose(present=True, handle=(-0.1, -0.05, 0.2 + 0.01 * number), roll=0.0, jaw=0.5)
        device.take(RIGHT, newest)
    left, right = device.poses(0.0)
    assert right is newest
    assert not left.present
    device.open()
    assert not device.poses(0.0)[RIGHT].present


def test_there_are_two_hands():
    with pytest.raises(InputError, match=r"0 \(left\) or 1 \(right\)"):
        WebDevice().take(2, WebDevice().poses(0.0)[LEFT])
