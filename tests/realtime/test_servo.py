"""A servo that runs: poses in, snapshots out, every failure a state and a sentence. Nothing is timed."""

import math

import numpy as np
import pytest

from realtime.conftest import beaten
from realtime.toy_scene import TOY, advance, at_rest, broken_advance, toy_scene, until
from trocar.errors import InputError, ServoError
from trocar.realtime.guard import GuardLimits
from trocar.realtime.physics import Physics
from trocar.realtime.servo import Servo, ServoFlag
from trocar.simulation import FORCE, HANDLE_FORCE, TIP

OPEN = GuardLimits(damping=1e3, still_growth=1e6, reserve=1e3, credit=1e3, slew=1e9, clamp=100.0)


def follows(servo, sequence, hand=0):
    return until(lambda: servo.latest().sequences[hand] == sequence)


def place(servo, x=0.0, z=0.1, *, sequence, hand=0, **more):
    servo.command(hand, present=True, handle=(x, 0.0, z), sequence=sequence, **more)
    assert follows(servo, sequence, hand)


def test_it_ticks_and_its_time_is_the_tissues(running):
    first = running.latest()
    assert until(lambda: running.latest().tick > first.tick + 50)
    state = running.latest()
    assert state.alive
    assert state.time == pytest.approx(1e-3 * state.tick)
    assert state.amplitudes.shape == (2, 3, 2)
    assert running.exit_reason == ""


def test_a_pose_comes_back_as_a_force(running):
    place(running, z=-5e-3, sequence=10)
    assert until(lambda: running.latest().records[0, TIP + 2] == -5e-3)
    state = running.latest()
    assert state.records[0, FORCE + 2] == pytest.approx(0.5)
    assert state.records[1, FORCE + 2] == 0.0
    assert until(lambda: running.latest().amplitudes[0, 0, 0] <= -5e-3)
    state = running.latest()
    assert state.amplitudes[1, 0, 0] == pytest.approx(0.5 * state.amplitudes[0, 0, 0])


def test_what_was_read_does_not_change(running):
    state = running.latest()
    with pytest.raises(ValueError, match="read-only"):
        state.records[0, 0] = 1.0
    tick = state.tick
    assert until(lambda: running.latest().tick > tick + 20)
    assert state.tick == tick


def test_both_hands_are_apart(running):
    place(running, x=0.1, sequence=20, hand=0)
    place(running, x=0.2, sequence=21, hand=1)
    assert until(lambda: running.latest().records[:, TIP].tolist() == [0.1, 0.2])
    assert running.latest().sequences == (20, 21)


@pytest.mark.parametrize("wrong", [math.nan, math.inf, 1e9])
def test_an_impossible_pose_is_counted_and_not_followed(running, wrong):
    place(running, x=0.1, sequence=30)
    assert until(lambda: running.latest().records[0, TIP] == 0.1)
    refused = running.latest().refused
    running.command(0, present=True, handle=(wrong, 0.0, 0.1), sequence=31)
    assert until(lambda: running.latest().refused == refused + 1)
    state = running.latest()
    assert ServoFlag.POSE_REFUSED in state.flags
    assert state.sequences[0] == 30
    assert state.records[0, TIP] == 0.1


def test_there_is_no_third_hand(running):
    with pytest.raises(InputError, match="instrument: expected 0"):
        running.command(2, present=True, handle=(0.0, 0.0, 0.0))


def test_it_cannot_be_started_twice(running):
    with pytest.raises(ServoError, match="close it first"):
        running.start()


@pytest.mark.parametrize("roll", [7.0, 8.0], ids=["a force that is no number", "physics that give up"])
def test_a_fault_is_zero_force_until_a_reset(make_servo, roll):
    servo = make_servo(smoothing=0.0, limits=OPEN)
    servo.start()
    with beaten(servo):
        place(servo, z=-1e-2, sequence=1)
        assert until(lambda: servo.latest().hand_forces[0, 2] == pytest.approx(1.0))
        place(servo, z=-1e-2, sequence=2, roll=roll)
        assert until(lambda: ServoFlag.FAULT in servo.latest().flags)
        place(servo, z=-1e-2, sequence=3)
        state = servo.latest()
        assert ServoFlag.FAULT in state.flags
        assert not state.hand_forces.any()
        assert not state.records.any()
        servo.reset()
        assert until(lambda: servo.latest().resets == 1)
        assert until(lambda: servo.latest().hand_forces[0, 2] == pytest.approx(1.0))
        assert ServoFlag.FAULT not in servo.latest().flags


def test_a_reset_puts_the_tissue_to_rest(make_servo):
    servo = make_servo(smoothing=0.0)
    servo.start()
    with beaten(servo):
        place(servo, z=-1e-2, sequence=1)
        assert until(lambda: np.any(servo.latest().amplitudes))
        place(servo, z=0.1, sequence=2)
        assert until(lambda: servo.latest().records[0, TIP + 2] == 0.1)
        servo.reset()
        assert until(lambda: servo.latest().resets == 1 and not servo.latest().amplitudes.any())


def test_without_a_beat_the_force_is_gone_and_comes_back_with_one(make_servo):
    servo = make_servo(smoothing=0.0, limits=OPEN)
    servo.start()
    with beaten(servo):
        place(servo, z=-1e-2, sequence=1)
        assert until(lambda: servo.latest().hand_forces[0, 2] == pytest.approx(1.0))
    assert until(lambda: ServoFlag.UNHEARD in servo.latest().flags and not servo.latest().hand_forces.any())
    assert servo.alive
    with beaten(servo):
        assert until(lambda: servo.latest().hand_forces[0, 2] == pytest.approx(1.0))
        assert ServoFlag.UNHEARD not in servo.latest().flags


def test_it_ends_when_it_is_forgotten(make_servo):
    servo = make_servo()
    servo.start()
    assert until(lambda: not servo.alive)
    assert servo.exit_reason == "ended because it had no beat for two seconds"
    assert not servo.latest().hand_forces.any()


def test_a_loop_that_hangs_is_no_force_and_can_be_ended(make_servo):
    servo = make_servo(smoothing=0.0, scheduled=False)  # it would keep a core from everybody else
    servo.start()
    with beaten(servo):
        place(servo, z=-1e-2, sequence=1)
        assert until(lambda: servo.latest().records[0, FORCE + 2] > 0)
        servo.command(0, present=True, handle=(0.0, 0.0, -1e-2), roll=9.0, sequence=2)
        assert until(lambda: servo.latest().age > 0.1)
        state = servo.latest()
    assert state.alive
    assert not state.records[:, FORCE : FORCE + 3].any()
    assert not state.records[:, HANDLE_FORCE : HANDLE_FORCE + 3].any()
    servo.close()
    assert servo.exit_reason == "was killed by SIGTERM"


def test_closing_ends_it_in_good_order(make_servo):
    servo = make_servo()
    assert servo.exit_reason == "was not started"
    servo.close()
    servo.start()
    servo.close()
    servo.close()
    assert servo.exit_reason == "was stopped"
    assert not servo.alive


def test_a_tick_too_slow_for_its_rate_is_seen(make_servo):
    servo = make_servo(scheduled=False)
    servo.start()
    with beaten(servo):
        place(servo, roll=10.0, sequence=1)
        assert until(lambda: ServoFlag.DEGRADED in servo.latest().flags)
        state = servo.latest()
        assert state.missed > 100
        assert state.rate < 990
        assert state.tick_p50 > 1e-3


def test_trouble_at_the_start_is_a_sentence(make_servo):
    servo = make_servo(
        physics=Physics(advance=broken_advance, amplitudes=TOY.amplitudes, come_to_rest=TOY.come_to_rest)
    )
    with pytest.raises(ServoError, match="the servo could not start: TypingError"):
        servo.start()
    assert not servo.alive
    assert servo.exit_reason == "could not start"


def test_a_start_that_takes_too_long_leaves_nothing(make_servo):
    servo = make_servo()
    with pytest.raises(ServoError, match="expected a first tick within 0 s"):
        servo.start(within=0.0)
    assert not servo.alive


@pytest.mark.parametrize(
    ("wrong", "named"),
    [
        ({"smoothing": -1.0}, "smoothing"),
        ({"smoothing": math.nan}, "smoothing"),
        ({"speed": 0.0}, "speed"),
        ({"limits": GuardLimits(clamp=math.inf)}, "limits.clamp"),
        ({"limits": GuardLimits(damping=-1.0)}, "limits.damping"),
    ],
    ids=str,
)
def test_impossible_settings_are_refused(wrong, named):
    with pytest.raises(InputError, match=named):
        Servo(toy_scene(), at_rest(), physics=TOY, **wrong)


def test_before_the_start_there_is_nothing_to_see():
    state = Servo(toy_scene(), at_rest(), physics=TOY).latest()
    assert not state.alive
    assert state.tick == 0
    assert state.age == math.inf
    assert not np.any(state.records)


def test_physics_travel_by_name():
    kind, names = TOY.__reduce__()
    assert names[0] == "realtime.toy_scene:advance"
    assert kind(*names).advance is advance
