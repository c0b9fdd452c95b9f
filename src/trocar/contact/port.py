"""A straight instrument through a port: where its tip is, and what the hand feels of a force on it.

The port is a remote centre of motion: the shaft turns about it and slides through it, so it passes a force along the
shaft and bears any across. With the handle at h, the port at p and a shaft of length L,

    d = (p - h)/|p - h|,   tip = h + L d,   tip velocity across d = -(r_in/r_out) times the handle's,

r_out = |p - h|, r_in = L - r_out: the hand goes left, the tip right, scaled by the lever. The force on the tip comes to
the hand by the same lever, so that the power is the same at both ends.
"""

from __future__ import annotations

from math import sqrt

from numba import njit

from trocar.model import FloatArray

LEAST_OUTSIDE = 1e-3  # [m] of shaft between handle and port: nearer, the shaft has no direction


@njit(cache=True)
def reach(
    handle: FloatArray, port: FloatArray, length: float, tip: FloatArray, direction: FloatArray
) -> bool:  # pragma: no cover - compiled
    """Place the tip.

    Args:
        handle: position of the handle [m], shape (3,).
        port: position of the port [m], shape (3,).
        length: of the shaft from handle to tip [m].
        tip: overwritten with the tip's position [m], shape (3,).
        direction: overwritten with the unit vector along the shaft towards the tip, shape (3,).

    Returns:
        Whether the pose is possible: the handle outside, the tip beyond the port. Else nothing is written.
    """
    outside = sqrt((port[0] - handle[0]) ** 2 + (port[1] - handle[1]) ** 2 + (port[2] - handle[2]) ** 2)
    if not LEAST_OUTSIDE <= outside <= length:
        return False
    for i in range(3):
        direction[i] = (port[i] - handle[i]) / outside
        tip[i] = handle[i] + length * direction[i]
    return True


@njit(cache=True)
def felt(
    force: FloatArray, direction: FloatArray, outside: float, length: float, hand: FloatArray
) -> None:  # pragma: no cover - compiled
    """Bring a force on the tip to the hand.

    Args:
        force: on the tip [N], shape (3,).
        direction: unit vector along the shaft towards the tip, shape (3,).
        outside: length of shaft between handle and port [m].
        length: of the whole shaft [m].
        hand: overwritten with the force of the instrument on the hand [N], shape (3,).
    """
    along = force[0] * direction[0] + force[1] * direction[1] + force[2] * direction[2]
    lever = (length - outside) / outside
    for i in range(3):
        hand[i] = along * direction[i] - lever * (force[i] - along * direction[i])
