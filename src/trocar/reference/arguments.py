"""What every model of a block is asked with, checked once."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite

from trocar.errors import InputError
from trocar.model import Load, Press, Support

_DEFAULT_RADIUS = 1 / 15  # of the shorter side: 4 mm on a 60 mm block


def checked_size(size: Sequence[float]) -> tuple[float, float]:
    """Return the sides of a block [m].

    Raises:
        InputError: they are not two finite lengths above 0.
    """
    if len(size) != 2 or not all(isfinite(side) and side > 0 for side in size):
        raise InputError("size", "two finite sides above 0 [m]", size)
    return float(size[0]), float(size[1])


def checked_support(support: Support | str) -> Support:
    """Return a support, or the one of that name.

    Raises:
        InputError: there is none.
    """
    try:
        return Support(support)
    except ValueError:
        raise InputError("support", f"one of {', '.join(Support)}", support) from None


def check_step(load0: Load, load1: Load, dt: float) -> None:
    """Refuse a step of dt [s] that cannot be.

    Raises:
        InputError: dt is not above 0, or the loads hold unequally many presses.
    """
    if not (isfinite(dt) and dt > 0):
        raise InputError("dt", "a finite time above 0", dt)
    if len(load0) != len(load1):
        raise InputError(
            "load1", f"{len(load0)} presses, as in load0", len(load1), "give an idle press force 0"
        )


def central_press(size: tuple[float, float]) -> Load:
    """Return what a grid is made for where nothing is said: a tool of a 1/15 of the shorter side in the middle."""
    a, b = size
    return (Press(x=a / 2, y=b / 2, radius=_DEFAULT_RADIUS * min(a, b), force=1.0),)
