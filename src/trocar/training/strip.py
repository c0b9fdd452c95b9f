"""How a recording is kept: pieces of a strip, each whole by itself, from which every tick comes back bit by bit.

What a servo consumed is told by the few poses that came, 60 to 90 a second, and by how it followed them; a device that
brings a pose every tick is told tick by tick. A piece says at which of its ticks a hand's pose was another than before
(the first ones always), before which ticks the tissue began from rest, and where due times were skipped. Reals are
written as the difference of their bits to those before, byte plane by byte plane, and deflated.

Pieces are told apart by their first four bytes, and zlib's checksum guards them.
"""

from __future__ import annotations

import zlib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from trocar.errors import InputError
from trocar.model import FloatArray
from trocar.realtime.tracking import Following, absent, follow_again
from trocar.simulation import POSE
from trocar.training.session import Recording

KEEP_EVERY = 0.5  # [s] so much at most of an attempt is lost with the process
_MAGIC = b"TRS1"
_COUNTS = np.dtype("<u4")
_REALS = np.dtype("<f8")
Counts = npt.NDArray[np.int64]
Bools = npt.NDArray[np.bool_]


@dataclass(frozen=True, kw_only=True)
class Piece:
    """Ticks one after the other.

    Attributes:
        targets: newest poses in each tick, shape (n, 2, POSE).
        began: whether a tick began from rest, shape (n,).
        skipped: due times that passed unused before each tick, shape (n,).
    """

    targets: FloatArray
    began: Bools
    skipped: Counts

    def __len__(self) -> int:
        return len(self.targets)


def header(dt: float, following: Following | None) -> dict[str, float | None]:
    """Return what a strip's reader must know, as JSON takes it.

    Args:
        dt: length of a tick [s].
        following: how poses were followed; None where they were where they were told to be.
    """
    if following is None:
        return {"dt_s": dt, "smoothing_s": None, "speed_m_s": None}
    return {"dt_s": dt, "smoothing_s": following.smoothing, "speed_m_s": following.speed}


def write_piece(piece: Piece) -> bytes:
    """Return a piece as bytes."""
    changed = [_changes(piece.targets[:, hand]) for hand in range(2)]
    begins, skips = np.flatnonzero(piece.began), np.flatnonzero(piece.skipped)
    counts = [len(piece), len(changed[0]), len(changed[1]), len(begins), len(skips)]
    whole = [*changed, begins, skips, piece.skipped[skips]]
    body = np.concatenate([np.array(counts), *whole]).astype(_COUNTS).tobytes()
    reals = [_planes(piece.targets[changed[hand], hand, k]) for hand in range(2) for k in range(POSE)]
    return _MAGIC + zlib.compress(body + b"".join(reals), 6)


def read_piece(data: bytes) -> Piece:
    """Read a piece.

    Raises:
        InputError: the bytes are none.
    """
    if data[:4] != _MAGIC:
        raise InputError("recording", f"a piece that begins with {_MAGIC!r}", data[:4])
    try:
        body = zlib.decompress(data[4:])
        count, *numbers = np.frombuffer(body, _COUNTS, 5).astype(np.int64).tolist()
        *changed, begins, skips, times = _parts(body, 5, [*numbers, numbers[-1]])
        place = _COUNTS.itemsize * (5 + sum(numbers) + numbers[-1])
        targets = np.zeros((count, 2, POSE))
        for hand in range(2):
            for k in range(POSE):
                values, place = _of_planes(body, place, len(changed[hand]))
                targets[:, hand, k] = values[np.searchsorted(changed[hand], np.arange(count), "right") - 1]
        began, skipped = np.zeros(count, bool), np.zeros(count, np.int64)
        began[begins], skipped[skips] = True, times
    except (zlib.error, ValueError, IndexError) as error:
        raise InputError("recording", "a whole piece", f"one that cannot be read ({error})") from error
    return Piece(targets=targets, began=began, skipped=skipped)


def told_tick_by_tick(poses: FloatArray) -> Piece:
    """Return poses that were where they were told to be as a piece, none of its ticks skipped.

    Args:
        poses: of both handles, shape (n, 2, POSE).
    """
    return Piece(targets=poses, began=np.zeros(len(poses), bool), skipped=np.zeros(len(poses), np.int64))


def joined(pieces: Iterable[Piece]) -> Piece:
    """Return pieces as one."""
    every = list(pieces)
    if not every:
        return Piece(targets=np.zeros((0, 2, POSE)), began=np.zeros(0, bool), skipped=np.zeros(0, np.int64))
    return Piece(
        targets=np.concatenate([piece.targets for piece in every]),
        began=np.concatenate([piece.began for piece in every]),
        skipped=np.concatenate([piece.skipped for piece in every]),
    )


def poses_of(piece: Piece, told: Mapping[str, float | None]) -> FloatArray:
    """Return where both handles were in every tick, shape (n, 2, POSE).

    Args:
        piece: all of a recording; its first tick began from rest.
        told: the strip's header.
    """
    dt, smoothing, speed = told["dt_s"], told["smoothing_s"], told["speed_m_s"]
    if smoothing is None or speed is None:
        return piece.targets.copy()
    assert dt is not None
    poses = np.zeros_like(piece.targets)
    following = Following(smoothing=smoothing, speed=speed)
    follow_again(following, absent(), piece.targets, piece.began, dt, poses)
    return poses


def _changes(poses: FloatArray) -> Counts:
    """Return the numbers of the ticks with another pose than before, bit by bit; the first is one of them."""
    bits = np.ascontiguousarray(poses).view(np.uint64)
    other = np.ones(len(poses), bool)
    other[1:] = (bits[1:] != bits[:-1]).any(axis=1)
    return np.flatnonzero(other)


def _planes(values: FloatArray) -> bytes:
    bits = np.ascontiguousarray(values, _REALS).view("<u8")
    against = bits.copy()
    against[1:] ^= bits[:-1]
    return against.view(np.uint8).reshape(-1, 8).T.tobytes()


def _of_planes(body: bytes, place: int, count: int) -> tuple[FloatArray, int]:
    planes = np.frombuffer(body, np.uint8, 8 * count, place).reshape(8, count)
    against = np.ascontiguousarray(planes.T).view("<u8").ravel()
    bits = np.bitwise_xor.accumulate(against) if count else against
    return bits.view(_REALS).astype(np.float64), place + 8 * count


def _parts(body: bytes, first: int, lengths: list[int]) -> list[Counts]:
    whole = np.frombuffer(body, _COUNTS, first + sum(lengths))[first:].astype(np.int64)
    return np.split(whole, np.cumsum(lengths)[:-1])


def recorded(told: Mapping[str, object], data: Sequence[bytes]) -> Recording:
    """Return a recording that was kept.

    Args:
        told: the strip's header.
        data: its pieces, in order.

    Raises:
        InputError: a piece cannot be read, or the header is none.
    """
    numbers: dict[str, float | None] = {}
    for name in ("dt_s", "smoothing_s", "speed_m_s"):
        number = told.get(name)
        if not isinstance(number, float | None):
            raise InputError(f"recording: header: {name}", "a number, or nothing", number)
        numbers[name] = number
    dt = numbers["dt_s"]
    if dt is None:
        raise InputError("recording: header: dt_s", "a number", dt)
    whole = joined([read_piece(piece) for piece in data])
    return Recording(
        poses=poses_of(whole, numbers),
        dt=dt,
        resets=tuple(np.flatnonzero(whole.began)[1:].tolist()),
        skipped=int(whole.skipped[1:].sum()),
    )
