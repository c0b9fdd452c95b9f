"""Histories of poses: where the handles are while the tips go along given paths, and a scene played through them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numba import njit

from trocar.contact.instrument import Instrument
from trocar.errors import InputError
from trocar.model import FloatArray
from trocar.simulation.scene import Scene, SceneState, at_rest
from trocar.simulation.step import HANDLE, JAW, POSE, PRESENT, RECORD, ROLL, advance


def poses_along(
    instruments: tuple[Instrument, Instrument],
    tips: tuple[FloatArray | None, FloatArray | None],
    *,
    jaws: tuple[FloatArray | float, FloatArray | float] = (1.0, 1.0),
    rolls: tuple[FloatArray | float, FloatArray | float] = (0.0, 0.0),
) -> FloatArray:
    """Return the poses of both handles while the tips go along paths.

    Args:
        instruments: left, right.
        tips: of each, a place for every tick [m], shape (ticks, 3); None for an instrument that is not there.
        jaws: 0 closed to 1 open, for all ticks or for each, shape (ticks,).
        rolls: about the shafts [rad], likewise.

    Returns:
        Shape (ticks, 2, POSE).

    Raises:
        InputError: no path is given, their lengths differ, or a tip is out of a shaft's reach.
    """
    lengths = {len(path) for path in tips if path is not None}
    if len(lengths) != 1:
        raise InputError("poses: tips", "paths of the same length, one at least", sorted(lengths))
    poses = np.zeros((lengths.pop(), 2, POSE))
    for t, (instrument, path) in enumerate(zip(instruments, tips, strict=True)):
        if path is None:
            continue
        from_port = path - np.array(instrument.port)
        inside = np.linalg.norm(from_port, axis=1)
        if not ((inside > 0) & (inside < instrument.length)).all():
            raise InputError(
                f"poses: tips of the {instrument.name} instrument",
                f"places within {instrument.length:g} m of its port",
                float(inside.max()),
            )
        poses[:, t, PRESENT] = 1.0
        poses[:, t, HANDLE : HANDLE + 3] = path - (instrument.length / inside)[:, None] * from_port
        poses[:, t, ROLL], poses[:, t, JAW] = rolls[t], jaws[t]
    return poses


def played(scene: Scene, poses: FloatArray, state: SceneState | None = None) -> FloatArray:
    """Return the records of both instruments in every tick of a history, shape (ticks, 2, RECORD).

    Args:
        scene: parameters.
        poses: of both handles, shape (ticks, 2, POSE).
        state: where the scene stands, changed in place; at rest by default.
    """
    records = np.zeros((len(poses), 2, RECORD))
    play(scene, at_rest(scene) if state is None else state, poses, records)
    return records


@njit(cache=True, nogil=True)
def play(
    scene: Scene, state: SceneState, poses: FloatArray, records: FloatArray
) -> bool:  # pragma: no cover - compiled
    """Advance through a history of poses, shape (ticks, 2, POSE); writes records, shape (ticks, 2, RECORD).

    Returns:
        Whether all ticks went well.
    """
    well = True
    for k in range(len(poses)):
        well = advance(scene, state, poses[k], records[k]) and well
    return well


def line(start: Sequence[float], end: Sequence[float], ticks: int) -> FloatArray:
    """Return a straight way from one place to another, evenly, its end included, shape (ticks, 3) [m]."""
    share = np.arange(1, ticks + 1)[:, None] / ticks
    result: FloatArray = np.array(start) + share * (np.array(end) - np.array(start))
    return result
