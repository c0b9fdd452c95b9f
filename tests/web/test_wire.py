"""Frames and poses: golden bytes written out by hand from the contract, a round trip, and every refusal."""

import math
import struct
from dataclasses import replace

import numpy as np
import pytest

from trocar.errors import InputError
from trocar.web import wire
from trocar.web.source import InstrumentState, Pose, Snapshot, Status, Touch
from trocar.web.wire import Block, RangeError, decode_frame, decode_pose, encode, encode_pose

BLOCK = Block(size=(0.06, 0.04), thickness=0.01)
POSE = Pose(instrument=1, sequence=7, present=True, handle=(0.5, -0.25, 0.125), roll=1.5, jaw=0.75)

# All values are sums of a few powers of two, so that every field is exact and the bytes can be read off.
STATE = InstrumentState(
    tip=(0.5, -0.25, 0.125),
    direction=(0.0, 0.0, -1.0),
    roll=1.5,
    jaw=0.75,
    force=(0.0, 0.5, 2.0),
    handle_force=(0.0, -0.5, -2.0),
    touch=Touch.PRESENT | Touch.HOLDING,
    depth=0.25,
)
GOLDEN_HEADER = (
    "54524f31 02000000 0500000000000000 0000000000000440 03000000 04000000 00007a44 06000000"
    "0000c841 00004842 09000000 0100 0200 0300 0000 00000000"
)
GOLDEN_STATE = (
    "0000003f 000080be 0000003e 00000000 00000000 000080bf 0000c03f 0000403f"
    "00000000 0000003f 00000040 00000000 000000bf 000000c0 05000000 0000803e"
)
GOLDEN_HEIGHTS = "0000 00bc 00c0 003c 0038 00b8"  # 0, -1, -2, 1, 0.5, -0.5 mm
GOLDEN_POSE = (
    "504f5345 07000000 01000000 01000000 000000000000e03f 000000000000d0bf 000000000000c03f 0000c03f 0000403f"
)


def snapshot(**changes):
    heights = 1e-3 * np.array([[[0, -1], [-2, 1], [0.5, -0.5]]])
    content = {
        "tick": 5,
        "time": 2.5,
        "pose_sequence": (3, 4),
        "rate": 1000.0,
        "missed_ticks": 6,
        "tick_p50": 25e-6,
        "tick_p99": 50e-6,
        "status": Status.ALIVE | Status.FORCES_CUT,
        "instruments": (STATE, STATE),
        "heights": heights.astype(np.float32),
    }
    return Snapshot(**(content | changes))


def test_what_is_cut_comes_after_the_planes():
    cut = np.arange(0, 252, 14, dtype=np.uint8).reshape(3, 3, 2)
    plain, frame = (encode(snapshot(cut=one), 2) for one in (None, cut))
    assert frame[60:64] == bytes([1, 0, 0, 0])
    assert frame[:60] + plain[60:64] + frame[64:-18] == plain
    assert frame[-18:] == cut.tobytes()
    assert np.array_equal(decode_frame(frame)[1].cut, cut)
    assert decode_frame(plain)[1].cut is None
    with pytest.raises(InputError, match="planes"):
        decode_frame(frame[:-1])


def test_a_frame_has_the_bytes_of_the_contract():
    golden = bytes.fromhex(GOLDEN_HEADER + 2 * GOLDEN_STATE + GOLDEN_HEIGHTS)
    assert encode(snapshot(), 2) == golden


def test_the_records_have_the_lengths_of_the_contract():
    assert (wire.HEADER.itemsize, wire.INSTRUMENT.itemsize, wire.POSE.itemsize) == (64, 64, 48)


def test_in_plane_planes_follow_and_are_announced():
    plane = np.full((2, 3, 2), 1e-3, np.float32)
    frame = encode(snapshot(in_plane=plane), 2)
    assert frame[58:60] == b"\x01\x00"
    assert frame[-24:] == bytes.fromhex("003c" * 12)


def test_a_frame_comes_back_as_it_went():
    rng = np.random.default_rng(5)
    heights = rng.normal(scale=2e-3, size=(3, 5, 4)).astype(np.float32)
    in_plane = rng.normal(scale=2e-3, size=(2, 5, 4)).astype(np.float32)
    sent = snapshot(heights=heights, in_plane=in_plane, status=Status.ALIVE | Status.DEGRADED)
    sequence, got = decode_frame(encode(sent, 4_000_000_000))
    assert sequence == 4_000_000_000
    # float16 keeps 11 significant bits, so half a unit is 2^-11 of the value; 1e-6 more for the change of unit.
    np.testing.assert_allclose(got.heights, heights, rtol=2**-11 + 1e-6, atol=1e-10)
    np.testing.assert_allclose(got.in_plane, in_plane, rtol=2**-11 + 1e-6, atol=1e-10)
    assert got.tick_p50 == pytest.approx(25e-6, rel=1e-12)
    assert got.tick_p99 == pytest.approx(50e-6, rel=1e-12)
    compared = {"heights": None, "in_plane": None, "tick_p50": 0.0, "tick_p99": 0.0}
    assert replace(got, **compared) == replace(sent, **compared)


def test_a_number_too_large_for_its_field_does_not_stop_the_stream():
    _, got = decode_frame(encode(snapshot(missed_ticks=2**40, rate=1e300), 1))
    assert got.missed_ticks == 2**32 - 1
    assert got.rate == math.inf
    deep = np.full((1, 3, 2), -100.0, np.float32)
    assert np.all(np.isneginf(decode_frame(encode(snapshot(heights=deep), 1))[1].heights))


@pytest.mark.parametrize("spoil", [lambda f: f[:-1], lambda f: f[:20], lambda f: b"X" + f[1:], lambda f: b""])
def test_what_is_no_frame_is_refused(spoil):
    with pytest.raises(InputError, match="frame"):
        decode_frame(spoil(encode(snapshot(), 1)))


def test_a_pose_has_the_bytes_of_the_contract():
    golden = bytes.fromhex(GOLDEN_POSE)
    assert encode_pose(POSE) == golden
    assert decode_pose(golden, BLOCK) == POSE


@pytest.mark.parametrize(("present", "tracked"), [(False, False), (True, False), (False, True), (True, True)])
def test_a_pose_says_whether_a_headset_holds_it(present, tracked):
    pose = replace(POSE, present=present, tracked=tracked)
    message = encode_pose(pose)
    assert struct.unpack_from("<I", message, 12) == (present + 2 * tracked,)
    assert decode_pose(message, BLOCK) == pose


@pytest.mark.parametrize(
    ("place", "form", "value", "word"),
    [
        (0, "<I", 1, "magic"),
        (8, "<I", 2, "instrument"),
        (8, "<I", 2**32 - 1, "instrument"),
        (12, "<I", 4, "flags"),
    ],
)
def test_a_malformed_pose_is_refused(place, form, value, word):
    message = bytearray(encode_pose(POSE))
    struct.pack_into(form, message, place, value)
    with pytest.raises(InputError, match=word) as caught:
        decode_pose(bytes(message), BLOCK)
    assert not isinstance(caught.value, RangeError)


@pytest.mark.parametrize("length", [0, 1, 47, 49, 96])
def test_a_pose_of_another_length_is_refused(length):
    with pytest.raises(InputError, match="48 bytes"):
        decode_pose((2 * encode_pose(POSE))[:length], BLOCK)


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, 1.8, -1.8, 1e300])
@pytest.mark.parametrize("axis", [0, 1, 2])
def test_a_handle_that_is_not_finite_or_far_off_is_refused(axis, value):
    handle = [0.0, 0.0, 0.0]
    handle[axis] = value
    with pytest.raises(RangeError, match="handle"):
        decode_pose(encode_pose(replace(POSE, handle=tuple(handle))), BLOCK)


@pytest.mark.parametrize(
    "changes",
    [
        {"roll": math.nan},
        {"roll": math.inf},
        {"roll": 6.3e3},
        {"jaw": math.nan},
        {"jaw": -0.01},
        {"jaw": 1.01},
    ],
)
def test_roll_and_jaw_have_ranges(changes):
    with pytest.raises(RangeError, match=next(iter(changes))):
        decode_pose(encode_pose(replace(POSE, **changes)), BLOCK)


def test_reach_is_counted_from_the_nearest_point_of_the_block():
    assert BLOCK.distance((0.03, 0.02, -0.005)) == 0
    assert BLOCK.distance((0.06 + 0.3, 0.04 + 0.4, -0.01)) == pytest.approx(0.5, rel=1e-12)
    inside = replace(POSE, handle=(0.06 + 0.999, 0.0, 0.0))
    assert decode_pose(encode_pose(inside), BLOCK) == inside
    with pytest.raises(RangeError):
        decode_pose(encode_pose(replace(POSE, handle=(0.06 + 0.8, 0.04 + 0.8, 0.0))), BLOCK)
