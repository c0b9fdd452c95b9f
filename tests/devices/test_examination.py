"""The check at run time finds each way of breaking the contract, and always closes the device."""

from dataclasses import replace
from itertools import count
from math import nan

import pytest

from contracts.device import INSTRUMENTS, SIZE
from trocar.devices.device import HandlePose
from trocar.devices.examination import examine
from trocar.devices.web import WebDevice
from trocar.errors import InputError

LEFT = HandlePose(present=True, handle=INSTRUMENTS[0].handle, roll=0.0, jaw=1.0)
RIGHT = HandlePose(present=True, handle=INSTRUMENTS[1].handle, roll=0.0, jaw=0.5)


class Hands(WebDevice):
    """Holds both instruments still, and counts."""

    def __init__(self, left=LEFT):
        super().__init__(instruments=INSTRUMENTS)
        self.left = left
        self.opened = self.closed = 0

    def open(self):
        self.opened += 1

    def close(self):
        self.closed += 1

    def poses(self, _time):
        return self.left, RIGHT


def complaints(device):
    left, right = examine(device, INSTRUMENTS, SIZE, seconds=0.1)
    assert right.complaints == []
    assert (device.opened, device.closed) == (1, 1)
    return left.complaints


def test_still_hands_pass():
    left, right = examine(Hands(), INSTRUMENTS, SIZE, seconds=0.1)
    assert (left.present, left.changes, left.fastest_tip, left.complaints) == (1.0, 0.0, 0.0, [])
    assert right.jaw == (0.5, 0.5)
    assert right.lowest_tip == pytest.approx(8e-3)
    assert right.as_dict()["fastest_tip_m_s"] == 0.0


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"roll": nan}, "a number that is not finite"),
        ({"handle": (0.0, nan, 0.2), "present": False}, "a number that is not finite"),
        ({"jaw": 1.2}, "a jaw outside 0 to 1: 1.2"),
        ({"handle": (0.0, 0.0, 1.4), "present": False}, "a handle farther than 1 m from the block"),
        ({"handle": INSTRUMENTS[0].port}, "a handle where the shaft cannot be: left instrument: handle"),
    ],
)
def test_what_the_trainer_could_not_use_is_found_and_told_a_few_times(changes, said):
    told = complaints(Hands(replace(LEFT, **changes)))
    assert len(told) == 3
    assert told[0].startswith(f"left at 0.000 s: {said}")


def test_a_tip_that_jumps_is_found():
    class Jumping(Hands):
        def poses(self, time):
            x, y, z = LEFT.handle
            return replace(LEFT, handle=(x, y, z - 0.01 * (time >= 0.05))), RIGHT

    (told,) = complaints(Jumping())
    assert told.startswith("left at 0.050 s: a tip faster than 1 m/s")


def test_an_instrument_that_goes_and_comes_back_elsewhere_has_not_jumped():
    class Coming(Hands):
        def poses(self, time):
            x, y, z = LEFT.handle
            return replace(
                LEFT, handle=(x, y, z - 0.01 * (time >= 0.05)), present=not 0.03 <= time < 0.08
            ), RIGHT

    device = Coming()
    assert complaints(device) == []
    left, _ = examine(device, INSTRUMENTS, SIZE, seconds=0.1)
    assert left.present == pytest.approx(0.5, abs=0.02)
    assert left.changes == pytest.approx(30.0)  # gone, moved and back in 0.1 s


def test_a_device_that_answers_differently_is_found():
    class Wavering(Hands):
        asked = count()

        def poses(self, _time):
            return replace(LEFT, roll=1e-6 * next(self.asked)), RIGHT

    assert complaints(Wavering())[0].startswith("left at 0.000 s: two answers for one time")


def test_a_device_that_breaks_down_is_closed():
    class Broken(Hands):
        def poses(self, _time):
            raise ZeroDivisionError

    device = Broken()
    with pytest.raises(ZeroDivisionError):
        examine(device, INSTRUMENTS, SIZE, seconds=0.1)
    assert (device.opened, device.closed) == (1, 1)


@pytest.mark.parametrize("seconds", [0.0, -1.0, nan, 601.0])
def test_an_impossible_time_is_refused_before_anything_is_opened(seconds):
    device = Hands()
    with pytest.raises(InputError, match="seconds"):
        examine(device, INSTRUMENTS, SIZE, seconds)
    assert device.opened == 0
