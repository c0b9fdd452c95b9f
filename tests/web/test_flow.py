"""Flow control: never more than two frames on their way, the newest state next, nobody waits for a slow page."""

import json
import time

import pytest
from websockets.exceptions import ConnectionClosed

from trocar.web.conversation import Allowance, StreamLimits
from trocar.web.messages import Guiding
from trocar.web.wire import decode_frame, encode_pose
from web.scripted_source import HANDLES, HELLO, rest_pose
from web.visitor import Visitor, served, until

# Longer than several frame periods (11 ms): what was to come without an acknowledgement would have come by then.
SILENCE = 0.15


def acknowledge(stream, sequence):
    stream.send(json.dumps({"type": "ack", "sequence": sequence}))


def frame(stream):
    message = stream.recv(timeout=5)
    assert isinstance(message, bytes)
    return decode_frame(message)


def test_the_server_speaks_first_and_says_what_there_is(guest):
    with guest.live() as (_, hello):
        assert hello == json.loads(HELLO.model_dump_json())
        assert set(hello) == {
            "type",
            "protocol",
            "tissue",
            "grid",
            "shape",
            "under_m",
            "instruments",
            "camera",
            "linear_force_n",
            "rate_hz",
            "lessons",
            "steered_by",
        }
    assert json.loads(guest.get_inside("/api/hello")["body"]) == hello


def test_a_page_that_comes_during_an_attempt_is_told_of_it_before_the_first_frame(guest, source):
    source.guidance = Guiding(
        attempt=7,
        state="running",
        step=0,
        words="Press.",
        marks=(),
        least_n=(0.0, 0.0),
        most_n=(0.0, 0.0),
        hint="Down.",
        mistakes=0,
        mistake="",
        time_s=1.0,
        left_s=2.0,
        reason="",
    )
    with guest.live() as (stream, _):
        assert json.loads(stream.recv(timeout=5))["attempt"] == 7
        assert frame(stream)[0] == 1


def test_two_frames_come_and_no_third_before_one_is_acknowledged(guest):
    with guest.live() as (stream, _):
        assert [frame(stream)[0] for _ in range(2)] == [1, 2]
        with pytest.raises(TimeoutError):
            stream.recv(timeout=SILENCE)
        acknowledge(stream, 1)
        assert frame(stream)[0] == 3
        with pytest.raises(TimeoutError):
            stream.recv(timeout=SILENCE)
        acknowledge(stream, 3)
        assert [frame(stream)[0] for _ in range(2)] == [4, 5]
        with pytest.raises(TimeoutError):
            stream.recv(timeout=SILENCE)


def test_the_next_frame_is_the_newest_state_not_the_oldest_waiting(guest, source):
    with guest.live() as (stream, _):
        first = [frame(stream)[1] for _ in range(2)]
        assert not any(state.instruments[0].touch for state in first)
        for sequence in range(1, 21):  # twenty states come and go while the page sleeps
            stream.send(encode_pose(rest_pose(0, sequence, handle=(-0.05, 0.03, 0.25 + 1e-3 * sequence))))
        with pytest.raises(TimeoutError):
            stream.recv(timeout=SILENCE)
        source.ticks += 1000
        acknowledge(stream, 2)
        sequence, state = frame(stream)
        assert sequence == 3
        assert state.tick > 1000
        assert state.pose_sequence == (20, 0)


def test_a_pose_comes_back_with_its_effect(guest):
    with guest.live() as (stream, _):
        stream.send(encode_pose(rest_pose(1, 5)))
        for _ in range(10):
            sequence, state = frame(stream)
            acknowledge(stream, sequence)
            if state.pose_sequence[1] == 5:
                break
        assert state.pose_sequence == (0, 5)
        assert state.instruments[1].touch
        assert state.heights.shape == (3, 64, 64)
        assert state.heights.min() < -1e-4


def test_a_page_that_never_acknowledges_costs_nobody_else(guest):
    with guest.live() as (silent, _), guest.live() as (eager, _):
        for expected in range(1, 41):
            sequence, _ = frame(eager)
            assert sequence == expected
            acknowledge(eager, sequence)
        assert [frame(silent)[0] for _ in range(2)] == [1, 2]
        with pytest.raises(TimeoutError):
            silent.recv(timeout=SILENCE)


def test_a_repeated_acknowledgement_gives_no_credit(guest):
    with guest.live() as (stream, _):
        for _ in range(2):
            frame(stream)
        for _ in range(5):
            acknowledge(stream, 1)
        assert frame(stream)[0] == 3
        with pytest.raises(TimeoutError):
            stream.recv(timeout=SILENCE)


def test_frames_never_come_faster_than_the_rate(source, monkeypatch):
    asked, latest = [], source.latest
    monkeypatch.setattr(source, "latest", lambda: (asked.append(time.monotonic()), latest())[1])
    with served(source, limits=StreamLimits(frame_rate=100.0)) as made, Visitor(made).live() as (stream, _):
        for expected in range(1, 22):
            assert frame(stream)[0] == expected
            acknowledge(stream, expected)
    # Frame n is due n - 1 periods of 10 ms after the first was, and the first may be late by less than one.
    assert asked[20] - asked[0] > 19 * 0.01


def test_notices_reach_every_page_and_wait_while_there_is_none(guest, source):
    source.say("info", "early")
    before = source.beats
    until(
        lambda: source.beats > before + 20
    )  # notices are passed on with every fifth beat, were anyone there
    with guest.live() as (one, _):
        texts = [message for message in (one.recv(timeout=5) for _ in range(3)) if isinstance(message, str)]
        assert [json.loads(text) for text in texts] == [{"type": "notice", "level": "info", "text": "early"}]
        with guest.live() as (two, _):
            for _ in range(2):
                frame(two)
            source.say("stopped", "The servo stopped; forces are off.")
            for stream in (one, two):
                assert json.loads(stream.recv(timeout=5))["level"] == "stopped"


def test_reset_reaches_the_source(guest, source):
    with guest.live() as (stream, _):
        stream.send('{"type": "reset"}')
        frame(stream)
        with pytest.raises(ConnectionClosed):
            leave(stream)
    assert source.resets == 1


def leave(stream):
    """Say something malformed and wait for the farewell: all that was sent before has then been taken."""
    stream.send("goodbye")
    while True:
        stream.recv(timeout=5)


def test_an_instrument_leaves_the_tissue_with_whoever_moved_it_last(guest, source):
    with guest.live() as (one, _), guest.live() as (two, _):
        one.send(encode_pose(rest_pose(0, 1)))
        one.send(encode_pose(rest_pose(1, 1)))
        until(lambda: source.poses[1].present)
        two.send(encode_pose(rest_pose(1, 1, roll=1.0)))
        until(lambda: source.poses[1].roll == 1.0)
        with pytest.raises(ConnectionClosed):
            leave(one)
        until(lambda: not source.poses[0].present)
        assert source.poses[0].handle == HANDLES[0]
        assert source.poses[1].present
        two.close()
        until(lambda: not source.poses[1].present)


def test_messages_pass_at_the_rate_and_not_for_long_above_it():
    even = Allowance(400.0, 0.0)
    assert all(even.take(count / 400.0) for count in range(4000))
    burst = Allowance(400.0, 0.0)
    assert [burst.take(0.0) for _ in range(401)] == [True] * 400 + [False]
    above = Allowance(400.0, 0.0)
    assert not all(above.take(count / 500.0) for count in range(2500))
