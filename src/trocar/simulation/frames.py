"""Frames on a surface, compiled: from the room into one and out of it; rows are origin, two tangents, the normal."""

from __future__ import annotations

from numba import njit

from trocar.model import FloatArray


@njit(cache=True)
def part_along(axis: FloatArray, x: float, y: float, z: float) -> float:  # pragma: no cover - compiled
    """Return the part of a vector along an axis."""
    part: float = axis[0] * x + axis[1] * y + axis[2] * z
    return part


@njit(cache=True)
def turn_out(frame: FloatArray, vector: FloatArray) -> None:  # pragma: no cover - compiled
    """Turn a vector from a frame into the room, in place; shape (3,)."""
    x, y, z = vector[0], vector[1], vector[2]
    for i in range(3):
        vector[i] = x * frame[1, i] + y * frame[2, i] + z * frame[3, i]


@njit(cache=True)
def turn_in(
    frame: FloatArray, centre: FloatArray, low: FloatArray, spread: FloatArray, middle: FloatArray
) -> None:  # pragma: no cover - compiled
    """Turn an ellipsoid from the room into a frame.

    Args:
        frame: shape (4, 3).
        centre: of the ellipsoid [m], shape (3,).
        low: its lowest point [m], shape (3,).
        spread: S of `contact.tips` [m^2], turned in place, shape (3, 3).
        middle: overwritten with the centre as seen from the lowest point [m], shape (3,).
    """
    x, y, z = centre[0] - low[0], centre[1] - low[1], centre[2] - low[2]
    for i in range(3):
        middle[i] = part_along(frame[1 + i], x, y, z)
    for i in range(3):
        x, y, z = spread[i, 0], spread[i, 1], spread[i, 2]
        for k in range(3):
            spread[i, k] = part_along(frame[1 + k], x, y, z)
    for k in range(3):
        x, y, z = spread[0, k], spread[1, k], spread[2, k]
        for i in range(3):
            spread[i, k] = part_along(frame[1 + i], x, y, z)
