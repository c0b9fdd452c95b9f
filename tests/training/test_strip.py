"""A recording's pieces: whatever they are told, the same bits come back."""

import zlib

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from trocar.errors import InputError
from trocar.realtime.tracking import Following, absent, follow_again
from trocar.simulation import HANDLE, POSE, PRESENT
from trocar.training.strip import Piece, header, joined, poses_of, read_piece, write_piece


def same(one, other):
    assert one.targets.tobytes() == other.targets.tobytes()
    assert one.began.tolist() == other.began.tolist()
    assert one.skipped.tolist() == other.skipped.tolist()


@st.composite
def pieces(draw):
    count = draw(st.integers(1, 40))
    reals = draw(arrays(np.float64, (count, 2, POSE), elements=st.floats(allow_nan=False, width=64)))
    kept = draw(arrays(np.bool_, (count, 2)))
    for tick in range(1, count):  # hands that hold still
        reals[tick, kept[tick]] = reals[tick - 1, kept[tick]]
    return Piece(
        targets=reals,
        began=draw(arrays(np.bool_, count)),
        skipped=draw(arrays(np.int64, count, elements=st.integers(0, 5000))),
    )


@given(pieces())
def test_every_tick_comes_back_bit_by_bit(piece):
    same(read_piece(write_piece(piece)), piece)


@given(pieces(), pieces())
def test_pieces_one_after_the_other_are_the_whole(one, other):
    both = joined([one, other])
    assert len(both) == len(one) + len(other)
    same(joined([read_piece(write_piece(part)) for part in (one, other)]), both)


def hands(ticks, every, rng):
    """Return poses that change every so many ticks."""
    poses = np.zeros((ticks, 2, POSE))
    poses[..., PRESENT] = 1.0
    steps = -(-ticks // every)
    way = np.cumsum(rng.normal(0.0, 2e-4, (steps, 2, 3)), axis=0)
    poses[..., HANDLE : HANDLE + 3] = np.repeat(way, every, axis=0)[:ticks]
    return poses


def test_hands_of_a_page_take_little():
    """Ten seconds of two hands that move 90 times a second: far below the 7.1 bytes a tick that 2 GiB allow."""
    targets = hands(10_000, 11, np.random.default_rng(5))
    data = write_piece(Piece(targets=targets, began=np.zeros(10_000, bool), skipped=np.zeros(10_000, int)))
    assert len(data) / 10_000 < 5.5


def test_following_again_gives_the_poses_of_the_servo():
    targets = hands(500, 16, np.random.default_rng(6))
    began = np.zeros(500, bool)
    began[[0, 300]] = True
    following = Following(smoothing=8e-3, speed=1.0)
    poses = np.zeros_like(targets)
    follow_again(following, absent(), targets, began, 1e-3, poses)
    piece = Piece(targets=targets, began=began, skipped=np.zeros(500, int))
    np.testing.assert_array_equal(poses_of(read_piece(write_piece(piece)), header(1e-3, following)), poses)
    assert np.abs(poses - targets).max() > 1e-4
    np.testing.assert_array_equal(poses_of(piece, header(1e-3, None)), targets)


def test_no_piece_is_an_empty_recording():
    assert len(joined([])) == 0


WHOLE = write_piece(Piece(targets=np.ones((3, 2, POSE)), began=np.ones(3, bool), skipped=np.ones(3, int)))


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"nonsense",
        WHOLE[:-3],
        WHOLE[:20] + b"x" + WHOLE[21:],
        b"TRS1" + zlib.compress(b"\x09\x00\x00\x00"),
        b"TRS1" + zlib.compress(np.array([3, 1, 1, 1, 0, 0, 0, 9], "<u4").tobytes() + bytes(96)),
    ],
)
def test_what_is_no_piece_is_refused_in_a_sentence(data):
    with pytest.raises(InputError, match="recording: expected a"):
        read_piece(data)
