"""What the web asks of whatever moves the tissue: the newest snapshot out, poses in, a beat to stay alive.

Tip and handle obey the port (a remote centre of motion): with the handle at h, the port at p and a shaft of
length L,

    d = (p - h) / |p - h|,    tip = h + L d

so the hand goes left and the tip right. A pose is that of the handle; client and servo compute the same tip.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntFlag
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from trocar.web.messages import Guiding, Hello, Notice

LEFT, RIGHT = 0, 1
Vector = tuple[float, float, float]


class Status(IntFlag):
    """How the servo fares, as bits of a frame's header."""

    ALIVE = 1
    DEGRADED = 2  # it does not hold the requested rate
    BEYOND_LINEAR = 4  # a force lies beyond the linear range
    FORCES_CUT = 8


class Touch(IntFlag):
    """What an instrument does, as bits of its record."""

    PRESENT = 1
    TOUCHING = 2
    HOLDING = 4


class Held(IntFlag):
    """How an instrument is held, as bits of a pose."""

    PRESENT = 1
    TRACKED = 2  # by a headset's controller


@dataclass(frozen=True, kw_only=True, slots=True)
class Pose:
    """Where a client holds an instrument.

    Args:
        instrument: `LEFT` or `RIGHT`.
        sequence: the client's number of this pose; it rises with each, and begins anew with each client.
        present: whether the instrument is in the hand at all.
        handle: position of the handle [m].
        roll: angle about the shaft [rad].
        jaw: opening, 0 closed to 1 open.
        tracked: whether a headset's controller is the handle.
    """

    instrument: int
    sequence: int
    present: bool
    handle: Vector
    roll: float
    jaw: float
    tracked: bool = False


@dataclass(frozen=True, kw_only=True, slots=True)
class InstrumentState:
    """What the servo knows of an instrument.

    Args:
        tip: position of the tip [m].
        direction: unit vector along the shaft, from handle to tip.
        roll: angle about the shaft [rad].
        jaw: opening, 0 closed to 1 open.
        force: of the tissue on the tip [N].
        handle_force: what the hand feels [N].
        touch: present, touching, holding.
        depth: how deep the tip lies in the rest tissue [m].
    """

    tip: Vector
    direction: Vector
    roll: float
    jaw: float
    force: Vector
    handle_force: Vector
    touch: Touch
    depth: float


@dataclass(frozen=True, kw_only=True, slots=True)
class Snapshot:
    """One state of the tissue and of both instruments, complete in itself.

    Args:
        tick: ticks since the servo's start.
        time: the tissue's time [s].
        pose_sequence: the pose last consumed, left and right.
        rate: ticks achieved in the last second [Hz].
        missed_ticks: since the start.
        tick_p50: median duration of a tick [s].
        tick_p99: 99th percentile of it [s].
        status: how the servo fares.
        instruments: left, then right.
        heights: u_z of each layer's upper face [m], float32, shape (layers, ny, nx), top layer first.
        in_plane: u_x and u_y of the top face [m], float32, shape (2, ny, nx); None where the model has none.
        cut: of a sheet: the links from each node to that ahead along x, along y, and along both, uint8, shape
            (3, ny, nx): 0 of one that holds, else how far along it the cut went, in 255ths. None of what cannot be cut.
    """

    tick: int
    time: float
    pose_sequence: tuple[int, int]
    rate: float
    missed_ticks: int
    tick_p50: float
    tick_p99: float
    status: Status
    instruments: tuple[InstrumentState, InstrumentState]
    heights: NDArray[np.float32]
    in_plane: NDArray[np.float32] | None = None
    cut: NDArray[np.uint8] | None = None


class LiveSource(Protocol):
    """Moves the tissue; every method returns at once, for all are called from the server's one thread."""

    def hello(self) -> Hello:
        """Return tissue, grid, instruments, camera: the same object until the source shows something else."""

    def latest(self) -> Snapshot:
        """Return the newest state, whole; it is never changed afterwards."""

    def pose(self, instrument: int, pose: Pose, /) -> None:
        """Take the newest pose of an instrument, finite and within reach.

        Poses of several clients may follow each other, each with sequence numbers of its own.
        """

    def reset(self) -> None:
        """Put the tissue back to rest."""

    def guiding(self) -> Guiding | None:
        """Return what to do now, if an attempt is under way; the same object until there is something new."""

    def notices(self) -> Sequence[Notice]:
        """Return what the user should read and has not been given yet; each notice is returned once."""

    def beat(self) -> None:
        """Learn that the server lives; without a beat for 50 ms a source lets its forces fall."""
