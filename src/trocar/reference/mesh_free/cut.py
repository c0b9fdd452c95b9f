"""A cut: a straight stroke on the top face, carried down to a depth; shape functions do not see through it.

A node counts at a place only where the straight line between them meets no cut: the visibility rule of T. Belytschko,
Y. Y. Lu and L. Gu 1994, Int. J. Numer. Methods Eng. 37:229, sec. 4. A node on the cut itself is doubled, and its copies
are seen from one side each. The faces of a cut are free of traction; they do not meet again under load.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, hypot, isfinite, pi, sin

import numpy as np
from numba import njit

from trocar.errors import InputError
from trocar.model import FloatArray

CORNER, ALONG, DOWN, NORMAL = 0, 1, 2, 3
"""Rows of a cut as `Cut.frame` writes it."""

_ON_THE_EDGE = 1e-6  # of the block's size: nearer to a side or the base than this, a cut goes through
_STEEPEST = 80 * pi / 180  # a flatter cut would run along the face


@dataclass(frozen=True, kw_only=True)
class Cut:
    """A parallelogram through the top face.

    Args:
        start, end: of the stroke on the top face [m], (x, y); on a side of the block or beyond, it cuts the side too.
        depth: of the cut's lower edge below the top face [m]; at the block's thickness or beyond, it cuts through.
        lean: of the blade from the vertical [rad], to the left of the stroke where positive.

    Raises:
        InputError: a number is not possible.
    """

    start: tuple[float, float]
    end: tuple[float, float]
    depth: float
    lean: float = 0.0

    def __post_init__(self) -> None:
        if not all(isfinite(value) for value in (*self.start, *self.end)):
            raise InputError("cut: start and end", "finite places [m]", (self.start, self.end))
        if self.length == 0:
            raise InputError("cut: end", "a place apart from the start", self.end)
        if not (isfinite(self.depth) and self.depth > 0):
            raise InputError("cut: depth", "a finite depth above 0 [m]", self.depth)
        if not abs(self.lean) <= _STEEPEST:
            raise InputError("cut: lean", f"an angle between -{_STEEPEST:.3g} and {_STEEPEST:.3g}", self.lean)

    @property
    def length(self) -> float:
        """Of the stroke [m]."""
        return hypot(self.end[0] - self.start[0], self.end[1] - self.start[1])

    def frame(self, size: tuple[float, float], thickness: float) -> FloatArray:
        """Return corner, edges along and down [m], and unit normal, shape (4, 3).

        The parallelogram starts above the top face and is carried past every face of the block that it reaches, so that
        nothing sees around it there.

        Args:
            size: sides of the block [m].
            thickness: of the block [m].
        """
        near = _ON_THE_EDGE * max(*size, thickness)
        past = 0.5 * max(*size, thickness)
        first, last = np.array([*self.start, 0.0]), np.array([*self.end, 0.0])
        along = (last - first) / self.length
        leftward = np.array([-along[1], along[0], 0.0])
        down = np.array([0.0, 0.0, -cos(self.lean)]) + sin(self.lean) * leftward
        if _outside(self.start, size, near):
            first = first - past * along
        if _outside(self.end, size, near):
            last = last + past * along
        reach = self.depth / cos(self.lean)
        if self.depth >= thickness - near:
            reach += past
        normal = np.cross(along, down)
        return np.stack([first - past * down, last - first, (reach + past) * down, normal])


def _outside(place: tuple[float, float], size: tuple[float, float], near: float) -> bool:
    return any(not near < where < side - near for where, side in zip(place, size, strict=True))


def on_the_cut(frame: FloatArray, places: FloatArray, near: float) -> np.ndarray:
    """Return which places, shape (n, 3), lie in the cut and not on its edge, within `near` [m]; shape (n,)."""
    offset = places - frame[CORNER]
    result = np.abs(offset @ frame[NORMAL]) < near
    for edge in (frame[ALONG], frame[DOWN]):
        length = np.linalg.norm(edge)
        run = offset @ (edge / length)
        result &= (run > near) & (run < length - near)
    return np.asarray(result)


@njit(cache=True, nogil=True)
def hidden(cuts: FloatArray, seen_from: FloatArray, place: FloatArray) -> bool:  # pragma: no cover - compiled
    """Return whether a cut lies between two places.

    Args:
        cuts: frames, shape (n, 4, 3).
        seen_from: the one place [m], shape (3,).
        place: the other [m], shape (3,).
    """
    for cut in range(cuts.shape[0]):
        frame = cuts[cut]
        before, after = 0.0, 0.0
        for k in range(3):
            before += (seen_from[k] - frame[0, k]) * frame[3, k]
            after += (place[k] - frame[0, k]) * frame[3, k]
        if before * after >= 0.0:
            continue
        share = before / (before - after)
        inside = True
        for edge in (1, 2):  # along and down
            run, square = 0.0, 0.0
            for k in range(3):
                where = seen_from[k] + share * (place[k] - seen_from[k]) - frame[0, k]
                run += where * frame[edge, k]
                square += frame[edge, k] ** 2
            inside = inside and 0.0 < run < square
        if inside:
            return True
    return False
