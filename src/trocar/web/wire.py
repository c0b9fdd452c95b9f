"""The binary half of the live stream: frames to the client, poses from it, little-endian throughout.

A frame is a header of 64 bytes, one record of 64 bytes for the left and one for the right instrument, then
planes of float16 with the displacement in millimetres, x fastest: u_z of each layer's upper face, top layer
first, and u_x and u_y of the top face where the header says so. Of a sheet three planes of bytes may follow, with
what is cut (`source.Snapshot`). float16 has 11 significant bits, so a displacement of 1 mm is told to 0.5 um; beyond
65.5 m it would be infinite.

A pose is one record of 48 bytes. Everything in it is checked here: what comes out is safe to compute with.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from trocar.errors import InputError
from trocar.units import MILLIMETRE
from trocar.web.messages import TissueSize
from trocar.web.source import Held, InstrumentState, Pose, Snapshot, Status, Touch, Vector

FRAME_MAGIC = 0x314F5254  # "TRO1"
POSE_MAGIC = 0x45534F50  # "POSE"
LINKS = 3  # of a sheet's node, of which it is told where they are cut
REACH = 1.0  # farthest a handle may be from the block [m]
MOST_ROLL = 2000 * math.pi  # a thousand turns: beyond, float32 resolves the angle worse than 0.5 mrad [rad]

HEADER = np.dtype(
    [
        ("magic", "<u4"),
        ("sequence", "<u4"),
        ("tick", "<u8"),
        ("time_s", "<f8"),
        ("pose_sequence", "<u4", 2),
        ("rate_hz", "<f4"),
        ("missed_ticks", "<u4"),
        ("tick_p50_us", "<f4"),
        ("tick_p99_us", "<f4"),
        ("status", "<u4"),
        ("layers", "<u2"),
        ("nx", "<u2"),
        ("ny", "<u2"),
        ("in_plane", "<u2"),
        ("cut", "<u4"),
    ]
)
INSTRUMENT = np.dtype(
    [
        ("tip_m", "<f4", 3),
        ("direction", "<f4", 3),
        ("roll_rad", "<f4"),
        ("jaw", "<f4"),
        ("force_n", "<f4", 3),
        ("handle_force_n", "<f4", 3),
        ("flags", "<u4"),
        ("depth_m", "<f4"),
    ]
)
POSE = np.dtype(
    [
        ("magic", "<u4"),
        ("sequence", "<u4"),
        ("instrument", "<u4"),
        ("flags", "<u4"),
        ("handle_m", "<f8", 3),
        ("roll_rad", "<f4"),
        ("jaw", "<f4"),
    ]
)
_MICROSECOND = 1e-6  # [s]
_PLANE = np.dtype("<f2")
_LARGEST = 2**32 - 1
_HELD = int(Held.PRESENT | Held.TRACKED)  # every bit there is


class RangeError(InputError):
    """A message of the right form holds a number that is not finite or too far off."""


@dataclass(frozen=True, kw_only=True)
class Block:
    """The space the tissue fills at rest: 0 <= x <= a, 0 <= y <= b, -thickness <= z <= 0.

    Args:
        size: a and b [m].
        thickness: of all layers together [m].
    """

    size: tuple[float, float]
    thickness: float

    @classmethod
    def of(cls, tissue: TissueSize) -> Block:
        """Return the block of a tissue as `Hello` describes it."""
        return cls(size=tissue.size_m, thickness=tissue.thickness)

    def distance(self, point: Vector) -> float:
        """Return how far a point [m] is from the block [m]; zero inside."""
        spans = ((0.0, self.size[0]), (0.0, self.size[1]), (-self.thickness, 0.0))
        return math.hypot(*(max(low - x, 0.0, x - high) for x, (low, high) in zip(point, spans, strict=True)))


def encode(snapshot: Snapshot, sequence: int) -> bytes:
    """Return a snapshot as one frame.

    A count too large for its field stays at the largest; a number too large for its float becomes infinite.

    Args:
        snapshot: what the frame holds.
        sequence: the frame's number for the client it goes to, from 1.
    """
    layers, ny, nx = snapshot.heights.shape
    planes = [snapshot.heights]
    if snapshot.in_plane is not None:
        planes.append(snapshot.in_plane)
    with np.errstate(over="ignore"):
        header = np.array(
            (
                FRAME_MAGIC,
                sequence,
                snapshot.tick,
                snapshot.time,
                snapshot.pose_sequence,
                snapshot.rate,
                min(snapshot.missed_ticks, _LARGEST),
                snapshot.tick_p50 / _MICROSECOND,
                snapshot.tick_p99 / _MICROSECOND,
                int(snapshot.status),
                layers,
                nx,
                ny,
                snapshot.in_plane is not None,
                snapshot.cut is not None,
            ),
            HEADER,
        )
        records = np.array([_record(state) for state in snapshot.instruments], INSTRUMENT)
        bodies = [(plane * np.float32(1 / MILLIMETRE)).astype(_PLANE) for plane in planes]
    ends = [] if snapshot.cut is None else [snapshot.cut.tobytes()]
    return b"".join([header.tobytes(), records.tobytes(), *(body.tobytes() for body in bodies), *ends])


def decode_frame(frame: bytes) -> tuple[int, Snapshot]:
    """Return a frame's sequence number and the snapshot it holds, as far as the wire kept it.

    Args:
        frame: what `encode` made.

    Raises:
        InputError: it is no such frame.
    """
    if len(frame) < HEADER.itemsize or int.from_bytes(frame[:4], "little") != FRAME_MAGIC:
        raise InputError("frame", "a header that begins with TRO1", frame[:4])
    header = np.frombuffer(frame, HEADER, 1)[0]
    start = HEADER.itemsize + 2 * INSTRUMENT.itemsize
    shape = (int(header["layers"]), int(header["ny"]), int(header["nx"]))
    count = shape[0] + 2 * int(header["in_plane"])
    nodes = shape[1] * shape[2]
    end = start + count * nodes * _PLANE.itemsize
    if len(frame) != end + LINKS * nodes * bool(header["cut"]):
        raise InputError("frame", f"{count} planes of {shape[2]} x {shape[1]}", f"{len(frame)} bytes")
    records = np.frombuffer(frame, INSTRUMENT, 2, HEADER.itemsize)
    planes = np.frombuffer(frame, _PLANE, count * nodes, start).astype(np.float32) * np.float32(MILLIMETRE)
    planes = planes.reshape(count, *shape[1:])
    left, right = (_state(record) for record in records)
    return int(header["sequence"]), Snapshot(
        tick=int(header["tick"]),
        time=float(header["time_s"]),
        pose_sequence=(int(header["pose_sequence"][0]), int(header["pose_sequence"][1])),
        rate=float(header["rate_hz"]),
        missed_ticks=int(header["missed_ticks"]),
        tick_p50=float(header["tick_p50_us"]) * _MICROSECOND,
        tick_p99=float(header["tick_p99_us"]) * _MICROSECOND,
        status=Status(int(header["status"])),
        instruments=(left, right),
        heights=planes[: shape[0]],
        in_plane=planes[shape[0] :] if header["in_plane"] else None,
        cut=np.frombuffer(frame, np.uint8, offset=end).reshape(LINKS, *shape[1:]) if header["cut"] else None,
    )


def encode_pose(pose: Pose) -> bytes:
    """Return a pose as a client sends it."""
    flags = Held.PRESENT * pose.present | Held.TRACKED * pose.tracked
    record = (POSE_MAGIC, pose.sequence, pose.instrument, flags, pose.handle, pose.roll, pose.jaw)
    return np.array(record, POSE).tobytes()


def decode_pose(message: bytes, block: Block) -> Pose:
    """Return the pose a client sent.

    Args:
        message: the binary message.
        block: where the tissue is; a handle farther than `REACH` from it is refused.

    Raises:
        RangeError: a number is not finite or too far off.
        InputError: length, magic, instrument or flags are wrong.
    """
    if len(message) != POSE.itemsize:
        raise InputError("pose", f"{POSE.itemsize} bytes", len(message))
    record = np.frombuffer(message, POSE, 1)[0]
    if record["magic"] != POSE_MAGIC:
        raise InputError("pose", "magic POSE", message[:4])
    instrument, flags = int(record["instrument"]), int(record["flags"])
    if instrument > 1:
        raise InputError("pose: instrument", "0 (left) or 1 (right)", instrument)
    if flags > _HELD:
        raise InputError("pose: flags", "1 (present) and 2 (tracked), or neither", flags)
    x, y, z = (float(value) for value in record["handle_m"])
    roll, jaw = float(record["roll_rad"]), float(record["jaw"])
    if not all(map(math.isfinite, (x, y, z))) or block.distance((x, y, z)) > REACH:
        raise RangeError("pose: handle", f"finite and within {REACH:g} m of the block", (x, y, z))
    if not abs(roll) <= MOST_ROLL:  # so written that NaN fails it, as below
        raise RangeError("pose: roll", "finite and within a thousand turns", roll)
    if not 0.0 <= jaw <= 1.0:
        raise RangeError("pose: jaw", "0 to 1", jaw)
    return Pose(
        instrument=instrument,
        sequence=int(record["sequence"]),
        present=bool(flags & Held.PRESENT),
        handle=(x, y, z),
        roll=roll,
        jaw=jaw,
        tracked=bool(flags & Held.TRACKED),
    )


def _record(state: InstrumentState) -> tuple[object, ...]:
    moving = (state.tip, state.direction, state.roll, state.jaw)
    return (*moving, state.force, state.handle_force, int(state.touch), state.depth)


def _state(record: np.void) -> InstrumentState:
    return InstrumentState(
        tip=_vector(record["tip_m"]),
        direction=_vector(record["direction"]),
        roll=float(record["roll_rad"]),
        jaw=float(record["jaw"]),
        force=_vector(record["force_n"]),
        handle_force=_vector(record["handle_force_n"]),
        touch=Touch(int(record["flags"])),
        depth=float(record["depth_m"]),
    )


def _vector(values: NDArray[np.float32]) -> Vector:
    x, y, z = (float(value) for value in values)
    return x, y, z
