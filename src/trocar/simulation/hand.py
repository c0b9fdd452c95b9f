"""What comes to a hand of force and moment on its instrument's tip."""

from __future__ import annotations

from numba import njit

from trocar.contact.port import felt
from trocar.model import FloatArray


@njit(cache=True)
def bring_to_hand(
    force: FloatArray,
    moment: FloatArray,
    direction: FloatArray,
    outside: float,
    length: float,
    hand: FloatArray,
) -> float:  # pragma: no cover - compiled
    """Bring a force and a moment on the tip to the hand.

    Args:
        force: on the tip [N], shape (3,).
        moment: on it, about its end [N m], shape (3,).
        direction: unit vector along the shaft towards the tip, shape (3,).
        outside: length of shaft between handle and port [m].
        length: of the whole shaft [m].
        hand: overwritten with the force of the instrument on the hand [N], shape (3,).

    Returns:
        The moment's part about the shaft [N m].
    """
    felt(force, direction, outside, length, hand)
    hand[0] -= (moment[1] * direction[2] - moment[2] * direction[1]) / outside
    hand[1] -= (moment[2] * direction[0] - moment[0] * direction[2]) / outside
    hand[2] -= (moment[0] * direction[1] - moment[1] * direction[0]) / outside
    twist: float = moment[0] * direction[0] + moment[1] * direction[1] + moment[2] * direction[2]
    return twist
