"""An attempt at a servo that runs: guided as it goes, kept to the tick, and the same when it is played again."""

import threading

import numpy as np
import pytest

from scripted_hands import Hands, first_step
from trocar.errors import TrocarError
from trocar.realtime.servo import Servo
from trocar.realtime.trail import read_trail
from trocar.simulation import at_rest
from trocar.training.live import Ending, LiveAttempt
from trocar.training.session import assess, scene_of
from trocar.training.strip import header, joined, poses_of, read_piece


@pytest.fixture(scope="module")
def servo():
    scene = scene_of(first_step())
    with Servo(scene, at_rest(scene)) as servo:
        over = threading.Event()

        def beat():
            while not over.wait(0.01):
                servo.beat()

        thread = threading.Thread(target=beat)
        thread.start()
        yield servo
        over.set()
        thread.join()


def kept_in(kept):
    return lambda data, ticks: kept.append((data, ticks))


def test_an_attempt_is_guided_to_its_end_and_its_strip_gives_the_same_card(servo):
    kept = []
    attempted = first_step()
    hands, live = Hands(servo, attempted), LiveAttempt(attempted, servo, kept_in(kept))
    said, seen = set(), []
    while True:
        hands.move()
        seen.append(live.look())
        said.add(seen[-1].hint)
        if seen[-1].ending or seen[-1].time > 30.0:
            break
    assert seen[-1].ending is Ending.DONE
    assert {"A little harder.", "Hold it so."} <= said
    assert [each.number for each in seen] == sorted(each.number for each in seen)
    assert {each.number for each in seen} == {0, 1}
    times = [each.time for each in seen]
    assert times == sorted(times)

    recording = live.recording
    whole = joined([read_piece(data) for data, _ in kept])
    assert [ticks for _, ticks in kept] == [len(read_piece(data)) for data, _ in kept]
    assert len(whole) == len(recording.poses) == round(1e3 * seen[-1].time)
    again = poses_of(whole, header(1e-3, servo.following))
    np.testing.assert_array_equal(again, recording.poses)
    card = assess(attempted, recording)
    assert card.completed
    assert card.duration == pytest.approx(seen[-1].time - 1e-3)
    assert len(card.mistakes) == seen[-1].mistakes


def test_tissue_put_to_rest_meanwhile_is_part_of_the_recording(servo):
    attempted = first_step()
    hands, live = Hands(servo, attempted), LiveAttempt(attempted, servo, kept_in([]))
    while live.look().time < 0.5:
        hands.move()
    resets = servo.latest().resets
    servo.reset()
    while servo.latest().resets == resets or live.look().time < 1.0:
        hands.move()
    live.give_up()
    guidance = live.look()
    assert guidance.ending is Ending.GIVEN_UP
    recording = live.recording
    assert len(recording.resets) == 1
    assert 500 <= recording.resets[0] < len(recording.poses)
    card = assess(attempted, recording)
    assert not card.completed
    assert card.score == 0.0


def test_the_records_that_the_task_saw_come_out_of_the_recording_bit_by_bit(servo):
    attempted = first_step()
    hands, live = Hands(servo, attempted), LiveAttempt(attempted, servo, kept_in([]))

    while live.look().time < 3.0:
        hands.move()
    live.give_up()
    recording = live.recording
    ticks = read_trail(servo.trail, 0)
    begin = int(np.flatnonzero(ticks.began)[-1])
    wanted = ticks.records[begin : begin + len(recording.poses)]
    found = recording.played(scene_of(attempted))
    assert wanted[: len(found)].tobytes() == found.tobytes()
    assert found[:, :, 0].any()


def test_what_cannot_be_kept_is_told_and_brought_again(servo):
    attempted, kept, full = first_step(), [], [True]

    def keep(data, ticks):
        if full[0]:
            raise TrocarError("the records: the disk is full")
        kept.append(ticks)

    hands, live = Hands(servo, attempted), LiveAttempt(attempted, servo, keep)
    while not live.look().trouble:
        hands.move()
    assert live.look().trouble == "the records: the disk is full"
    assert live.look().ending is Ending.NOT_YET
    full[0] = False
    while live.look().trouble:
        hands.move()
    live.give_up()
    assert sum(kept) == len(live.recording.poses) > 500


def test_nothing_is_taken_after_the_end(servo):
    attempted = first_step()
    hands, live = Hands(servo, attempted), LiveAttempt(attempted, servo, kept_in([]))
    while live.look().time < 0.1:
        hands.move()
    live.give_up()
    count = len(live.recording.poses)
    hands.move()
    assert live.look().time == pytest.approx(1e-3 * count)
    assert len(live.recording.poses) == count


def test_a_servo_that_dies_ends_the_attempt_and_what_it_left_is_kept(servo):
    """Last of this module: the servo is gone after it."""
    attempted, kept = first_step(), []
    hands, live = Hands(servo, attempted), LiveAttempt(attempted, servo, kept_in(kept))
    while live.look().time < 0.7:
        hands.move()
    servo.close()
    assert live.look().ending is Ending.NO_SERVO
    assert sum(ticks for _, ticks in kept) == len(live.recording.poses) >= 700
