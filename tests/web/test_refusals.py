"""A client that breaks a rule is shown out with a code and a reason, and nobody else notices."""

import json
import socket
import struct
import threading
import time
from contextlib import suppress
from dataclasses import replace

import pytest
from websockets.exceptions import ConnectionClosed
from websockets.frames import Frame, Opcode

from trocar.web.closing import Closing
from trocar.web.conversation import StreamLimits
from trocar.web.wire import decode_frame, encode_pose
from web.scripted_source import ScriptedSource, rest_pose
from web.visitor import Visitor, farewell, served, until

GOOD = encode_pose(rest_pose(0, 1))


def spoiled(**changes):
    return encode_pose(replace(rest_pose(0, 1), **changes))


MALFORMED = {
    "no JSON": "press",
    "empty text": "",
    "JSON of another shape": "[1, 2]",
    "unknown type": '{"type": "shutdown"}',
    "no sequence": '{"type": "ack"}',
    "a key too many": '{"type": "reset", "hard": true}',
    "sequence as text": '{"type": "ack", "sequence": "1"}',
    "negative sequence": '{"type": "ack", "sequence": -1}',
    "half a sequence": '{"type": "ack", "sequence": 0.5}',
    "NaN as sequence": '{"type": "ack", "sequence": NaN}',
    "a frame not sent yet": '{"type": "ack", "sequence": 1000}',
    "a server's message": '{"type": "notice", "level": "info", "text": "hello"}',
    "deep nesting": "[" * 3000,
    "empty bytes": b"",
    "half a pose": GOOD[:24],
    "two poses": GOOD + GOOD,
    "another magic": b"TRO1" + GOOD[4:],
    "a third instrument": GOOD[:8] + struct.pack("<I", 2) + GOOD[12:],
    "unknown flags": GOOD[:12] + struct.pack("<I", 4) + GOOD[16:],
}
OUT_OF_RANGE = {
    "NaN": spoiled(handle=(float("nan"), 0.0, 0.1)),
    "infinite": spoiled(handle=(0.0, float("inf"), 0.1)),
    "far off": spoiled(handle=(0.03, 0.03, 1.01)),
    "very far off": spoiled(handle=(0.03, 0.03, -1e300)),
    "NaN roll": spoiled(roll=float("nan")),
    "NaN jaw": spoiled(jaw=float("nan")),
    "jaw beyond open": spoiled(jaw=1.5),
}


@pytest.fixture(scope="module")
def host():
    """Serve a source to many rude clients, one after the other."""
    source = ScriptedSource()
    with served(source) as made:
        yield Visitor(made), source


@pytest.mark.parametrize("message", MALFORMED.values(), ids=MALFORMED)
def test_malformed(host, message):
    visitor, source = host
    before = list(source.poses)
    with visitor.live() as (stream, _):
        stream.send(message)
        code, reason = farewell(stream)
    assert code == Closing.MALFORMED
    assert "expected" in reason or "message" in reason or "acknowledged" in reason
    assert source.poses == before


@pytest.mark.parametrize("message", OUT_OF_RANGE.values(), ids=OUT_OF_RANGE)
def test_out_of_range(host, message):
    visitor, source = host
    before = list(source.poses)
    with visitor.live() as (stream, _):
        stream.send(message)
        code, reason = farewell(stream)
    assert code == Closing.OUT_OF_RANGE
    assert reason.startswith("pose: ")
    assert source.poses == before


def test_poses_must_come_in_order(host):
    with host[0].live() as (stream, _):
        for sequence in (1, 2, 2):
            stream.send(encode_pose(rest_pose(0, sequence)))
        assert farewell(stream) == (Closing.MALFORMED, "pose: expected a sequence number above the last one")


def test_each_instrument_and_each_client_counts_for_itself(guest, source):
    for roll in (0.5, 1.0):
        with guest.live() as (stream, _):
            stream.send(encode_pose(rest_pose(0, 9)))
            stream.send(encode_pose(rest_pose(1, 1, roll=roll)))
            until(lambda roll=roll: source.poses[1].roll == roll)


@pytest.mark.parametrize("message", ["x" * 4097, b"x" * 4097])
def test_a_message_above_the_limit(host, message):
    with host[0].live() as (stream, _):
        with suppress(ConnectionClosed):  # it may be thrown out while it still speaks
            stream.send(message)
        assert farewell(stream)[0] == 1009


def test_a_message_far_above_the_limit(host):
    with host[0].live() as (stream, _):
        with suppress(ConnectionClosed):
            stream.send(b"x" * 2**24)
        # The server reads on for a second; should that not do, the farewell is lost with what nobody read.
        assert farewell(stream)[0] in {1009, None}


def test_a_message_above_the_limit_in_pieces(host):
    with host[0].live() as (stream, _):
        with suppress(ConnectionClosed):
            stream.send([b"x" * 1000] * 10)
        assert farewell(stream)[0] == 1009


def test_who_is_thrown_out_while_speaking_can_still_hear_why(host):
    with host[0].upgraded() as plain:
        for piece in range(8):
            opcode = Opcode.CONT if piece else Opcode.BINARY
            plain.sendall(Frame(opcode, b"x" * 1000, fin=False).serialize(mask=True))
            time.sleep(0.02)  # the last ones come when the farewell is long out
        received = b""
        while chunk := plain.recv(65536):
            received += chunk
    assert b"\x03\xf1" in received[-125:]  # 1009


def test_a_message_at_the_limit_is_read(host):
    with host[0].live() as (stream, _):
        stream.send(b"x" * 4096)
        assert farewell(stream)[0] == Closing.MALFORMED


def test_text_that_is_no_utf8(host):
    with host[0].live() as (stream, _):
        stream.socket.sendall(Frame(Opcode.TEXT, b"\xff\xfe").serialize(mask=True))
        assert farewell(stream)[0] == 1007


def test_a_frame_without_its_mask(host):
    with host[0].live() as (stream, _):
        stream.socket.sendall(Frame(Opcode.BINARY, GOOD).serialize(mask=False))
        assert farewell(stream)[0] == 1002


def test_a_flood(guest, source):
    with guest.live() as (stream, _), guest.live() as (other, _):
        with suppress(ConnectionClosed):
            for sequence in range(1, 50_000):
                stream.send(encode_pose(rest_pose(0, sequence)))
        code, reason = farewell(stream)
        assert (code, reason) == (Closing.TOO_MANY_MESSAGES, "more than 400 messages a second came")
        sequence, _ = decode_frame(other.recv(timeout=5))
        assert sequence == 1
        until(lambda: not source.poses[0].present)  # it let go
        assert source.poses[0].sequence < 50_000


def test_an_idle_page(impatient):
    with impatient.live() as (stream, _):
        assert farewell(stream) == (Closing.IDLE, "no message came for 0.5 s")


def test_half_a_message_and_then_silence(impatient):
    with impatient.upgraded() as plain:
        plain.sendall(Frame(Opcode.BINARY, GOOD).serialize(mask=True)[:20])
        received = b""
        while b"no message came for 0.5 s" not in received:
            received += plain.recv(65536)


def test_a_fifth_page_is_told_so_and_comes_in_when_another_leaves(guest):
    first, *others = [guest.live() for _ in range(4)]
    streams = [visit.__enter__()[0] for visit in (first, *others)]
    with guest.enter() as fifth:
        assert farewell(fifth) == (Closing.FULL, "4 clients are connected; close another window first")
    first.__exit__(None, None, None)
    with guest.live() as (stream, hello):
        assert hello["type"] == "hello"
        assert decode_frame(stream.recv(timeout=5))[0] == 1
    assert all(decode_frame(stream.recv(timeout=5))[0] == 1 for stream in streams[1:])
    for visit in others:
        visit.__exit__(None, None, None)


@pytest.mark.parametrize(
    ("send", "stuck"), [(0.5, 60.0), (60.0, 1.0)], ids=["by the server", "by the kernel"]
)
def test_a_slow_reader_is_given_up_and_its_place_is_free(source, monkeypatch, send, stuck):
    """It acknowledges what it has not read, so that frames pile up until the kernel takes no more."""
    monkeypatch.setattr("trocar.web.address._STUCK_TIME", stuck)
    with served(source, limits=StreamLimits(clients=1, send=send, frame_rate=1000.0)) as made:
        visitor = Visitor(made)
        plain = visitor.upgraded(receive_buffer=4096)
        done = threading.Event()

        def lie():
            with suppress(OSError):  # in the end it is cut off
                while not done.is_set():
                    # No more than was sent: the source counts the snapshots that were taken from it.
                    text = json.dumps({"type": "ack", "sequence": source.ticks}).encode()
                    plain.sendall(Frame(Opcode.TEXT, text).serialize(mask=True))
                    time.sleep(0.004)

        liar = threading.Thread(target=lie)
        liar.start()
        with visitor.enter() as second:
            assert farewell(second)[0] == Closing.FULL
        until(lambda: greeted(visitor), timeout=15)
        if stuck < send:
            liar.join(15)
            assert not liar.is_alive()  # its connection is gone, not only its place
        done.set()
        liar.join(15)
        plain.close()


def greeted(visitor):
    """Knock, and return whether there was a place."""
    with visitor.enter() as stream, suppress(ConnectionClosed):
        return isinstance(stream.recv(timeout=5), str)


def test_a_page_that_vanishes_frees_its_place(host):
    for _ in range(6):
        plain = host[0].upgraded()
        plain.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        plain.close()  # a reset, no farewell
    with host[0].live() as (stream, _):
        assert decode_frame(stream.recv(timeout=5))[0] == 1
