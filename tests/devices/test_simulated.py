"""The simulated hands: the contract for every script, and that each does what its name says."""

from math import nan

import numpy as np
import pytest

from contracts.device import INSTRUMENTS, SIZE, DeviceContract
from trocar.contact.instrument import LARGEST_BLOCK, SMALLEST_BLOCK, Instrument
from trocar.devices.examination import examine
from trocar.devices.scripts import LIFT, SCRIPTS
from trocar.devices.simulated import SimulatedDevice
from trocar.errors import InputError


class TestSimulatedDevice(DeviceContract):
    @pytest.fixture(scope="class", params=list(SCRIPTS))
    @classmethod
    def make(cls, request):
        return lambda: SimulatedDevice(request.param, seed=5)


def traced(device, step=0.02):
    """Return times, tips of both hands and jaws of both hands."""
    times = np.arange(0, device.duration + step, step)
    poses = [device.poses(time) for time in times]
    tips = np.array(
        [[i.reach_of(p.handle).tip for i, p in zip(device.instruments, both, strict=True)] for both in poses]
    )
    return times, tips, np.array([[pose.jaw for pose in both] for both in poses])


def still(script, **options):
    return SimulatedDevice(script, tremor=0.0, noise=0.0, **options)


@pytest.mark.parametrize("script", SCRIPTS)
def test_a_script_begins_and_ends_at_the_instruments_start(script):
    device = still(script)
    for time in (0.0, device.duration):
        for pose, instrument in zip(device.poses(time), INSTRUMENTS, strict=True):
            assert pose.handle == pytest.approx(instrument.handle, abs=1e-14)  # rounding of 0.3 m
            assert pose.present


@pytest.mark.parametrize("script", SCRIPTS)
def test_tips_stay_over_the_block_and_apart(script):
    _, tips, _ = traced(still(script))
    assert (tips[..., :2] > 0.01).all()
    assert (tips[..., :2] < 0.05).all()
    assert np.linalg.norm(tips[:, 0] - tips[:, 1], axis=1).min() > 5e-3  # a tip is up to 5 mm wide
    assert tips[..., 2].min() >= -1.5e-3 - 1e-12


def test_press_goes_straight_in_and_deeper_each_time():
    _, tips, _ = traced(still("press", depth=1.2e-3))
    right = tips[:, 1]
    deep = right[right[:, 2] < -1e-6]
    assert np.ptp(deep[:, :2], axis=0) == pytest.approx(np.zeros(2), abs=1e-12)
    depths, times = np.unique(deep[:, 2].round(9), return_counts=True)
    assert depths[times > 30] == pytest.approx([-1.2e-3, -0.8e-3, -0.4e-3])  # held for a second each


def test_slide_moves_sideways_at_constant_depth():
    _, tips, _ = traced(still("slide"))
    for hand, depth in ((0, -0.5e-3), (1, -1e-3)):
        level = tips[np.abs(tips[:, hand, 2] - depth) < 1e-12, hand]
        assert np.ptp(level[:, 0]) == pytest.approx(0.012, rel=1e-6)
        assert np.ptp(level[:, 1]) == pytest.approx(0.0, abs=1e-12)


def test_lift_grips_under_light_pressure_raises_and_lets_go():
    times, tips, jaws = traced(still("lift"))
    closed = jaws[:, 0] == 0.0
    height, when = tips[closed, 0, 2], times[closed]
    assert height[0] == pytest.approx(-0.5e-3, abs=1e-9)
    first = height[when < when[0] + 3.0]
    assert first.max() - first[0] == pytest.approx(LIFT, abs=1e-9)
    opening = np.flatnonzero(closed)[-1] + 1
    assert tips[opening, 0, 2] == pytest.approx(-0.5e-3 + LIFT, abs=1e-9)  # it lets go up there
    assert jaws[-1, 0] == 1.0


def test_the_whole_exercise_takes_25_s_and_uses_both_hands():
    device = still("press-slide-lift")
    assert device.duration == pytest.approx(25.0)
    _, tips, jaws = traced(device)
    assert (tips[..., 2] < 0).mean(axis=0).min() > 0.3
    assert jaws.min(axis=0) == pytest.approx([0.0, 1.0])


def test_tremor_and_noise_come_on_top_of_the_script():
    quiet, usual = still("press"), SimulatedDevice("press")
    apart = np.array(
        [np.subtract(usual.poses(t)[0].handle, quiet.poses(t)[0].handle) for t in np.arange(0, 10, 0.01)]
    )
    assert np.sqrt((apart**2).sum(axis=1).mean()) == pytest.approx(1e-4, rel=0.2)  # as in test_unsteadiness
    assert SimulatedDevice("press", seed=1).poses(1.0) != usual.poses(1.0)


@pytest.mark.parametrize("size", [(SMALLEST_BLOCK, LARGEST_BLOCK), (LARGEST_BLOCK, LARGEST_BLOCK)])
@pytest.mark.parametrize("script", SCRIPTS)
def test_a_script_fits_other_blocks(script, size):
    times, tips, _ = traced(still(script, size=size))
    assert (tips[..., :2] > 0.1 * np.array(size)).all()
    assert (tips[..., :2] < 0.9 * np.array(size)).all()
    speed = np.linalg.norm(np.diff(tips, axis=0), axis=2) / np.diff(times)[:, None]
    assert speed.max() < 0.2  # without tremor 20 ms resolve a path whose segments take 400 ms and more


def test_no_pose_of_the_whole_exercise_is_one_the_trainer_could_not_use():
    device = SimulatedDevice()
    found = examine(device, INSTRUMENTS, SIZE, seconds=device.duration)
    assert [each.complaints for each in found] == [[], []]
    assert max(each.fastest_tip for each in found) < 0.1


def test_the_roughest_hands_are_no_faster_than_1_m_s():
    found = examine(SimulatedDevice(tremor=1e-3, noise=1e-4), INSTRUMENTS, SIZE, seconds=5.0)
    assert max(each.fastest_tip for each in found) < 1.0


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"script": "cut"}, "one of press, slide, lift, press-slide-lift"),
        ({"seed": -1}, "seed"),
        ({"tremor": 0.1}, "tremor"),
        ({"noise": nan}, "noise"),
        ({"depth": 0.02}, "depth"),
        ({"depth": 0.0}, "depth"),
        ({"size": (0.5, 0.5)}, "size"),
        ({"size": (nan, 0.06), "instruments": INSTRUMENTS}, "size"),
    ],
)
def test_what_cannot_be_is_refused(options, said):
    with pytest.raises(InputError, match=said):
        SimulatedDevice(**options)


def test_an_instrument_that_is_too_short_is_refused():
    short = Instrument(
        name="left",
        port=(-0.05, -0.01, 0.1),
        length=0.11,
        shaft_radius=2.5e-3,
        tip="probe",
        handle=(-0.1, -0.05, 0.15),
    )
    with pytest.raises(InputError, match="left instrument: tip"):
        SimulatedDevice(instruments=(short, INSTRUMENTS[1]))
