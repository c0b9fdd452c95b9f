"""What an instrument is apart from its motion: a straight shaft of fixed length through a fixed port, and its tip.

The geometry is that of `trocar.contact.port`: with the handle at h, the port at p and a shaft of length L,

    d = (p - h)/|p - h|,   tip = h + L d,

and from the other end h = tip - L (tip - p)/|tip - p|.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from math import dist, isfinite

import numpy as np

from trocar.contact.port import LEAST_OUTSIDE, reach
from trocar.errors import InputError
from trocar.model import FloatArray

Vector = tuple[float, float, float]

NAMES = ("left", "right")
"""The two hands, in the order in which arrays hold them."""

LONGEST = 1.0  # [m]; laparoscopic shafts measure 0.2 to 0.45 m
WIDEST = 0.01  # [m] of radius; laparoscopic shafts have 2.5 to 5 mm

SMALLEST_BLOCK, LARGEST_BLOCK = 0.02, 0.2  # [m]; the sides that the default pair works over
THICKEST_BLOCK = 0.05  # [m]

# The default pair, from the middle of the block: two ports 100 mm above the tissue, whose shafts meet there under 73
# degrees. Hanna, Shimi and Cuschieri (1997, Surgical Endoscopy 11:397-401) recommend 45 to 75 degrees, with equal
# azimuths.
_ASIDE, _TOWARDS_USER, _ABOVE = 0.08, 0.04, 0.1  # [m]
_LENGTH, _SHAFT_RADIUS = 0.31, 2.5e-3  # [m]; the shaft of a 5 mm instrument
_CLEARANCE = 8e-3  # [m] of a tip above the block at the start
_SHARE = 0.3  # of the block's width, from its side to the tip at the start


class TipKind(StrEnum):
    """What an instrument ends in."""

    PROBE = "probe"
    GRASPER = "grasper"
    NEEDLE_HOLDER = "needle-holder"
    HOOK = "hook"
    SCISSORS = "scissors"

    @property
    def has_jaw(self) -> bool:
        """Whether it opens, closes and holds."""
        return self in (TipKind.GRASPER, TipKind.NEEDLE_HOLDER)


@dataclass(frozen=True, kw_only=True, slots=True)
class Reach:
    """Where a shaft lies.

    Args:
        tip: position of the tip [m].
        direction: unit vector along the shaft, from handle to tip.
        outside: length of shaft between handle and port [m].
    """

    tip: Vector
    direction: Vector
    outside: float


@dataclass(frozen=True, kw_only=True, slots=True)
class Instrument:
    """Describe an instrument.

    Args:
        name: whose hand it is in, "left" or "right".
        port: the fixed point the shaft turns about and slides through [m].
        length: of the shaft, from handle to tip [m].
        shaft_radius: [m].
        tip: what it ends in; a string is taken for the kind it names.
        handle: where the handle is at the start [m].

    Raises:
        InputError: a value is not finite or not possible, or the handle lies where the shaft cannot.
    """

    name: str
    port: Vector
    length: float
    shaft_radius: float
    tip: TipKind
    handle: Vector

    def __post_init__(self) -> None:
        if self.name not in NAMES:
            raise InputError("instrument: name", " or ".join(NAMES), self.name)
        _check_point(f"{self.name} instrument: port", self.port)
        for key, most in (("length", LONGEST), ("shaft_radius", WIDEST)):
            value = getattr(self, key)
            if not (isfinite(value) and 0 < value <= most):
                raise InputError(
                    f"{self.name} instrument: {key}", f"a length above 0 and at most {most:g} m", value
                )
        if self.tip not in list(TipKind):
            raise InputError(f"{self.name} instrument: tip", f"one of {', '.join(TipKind)}", self.tip)
        object.__setattr__(self, "tip", TipKind(self.tip))
        self.reach_of(self.handle)

    def reach_of(self, handle: Sequence[float]) -> Reach:
        """Return where the shaft lies with the handle at a point.

        Args:
            handle: (x, y, z) [m].

        Raises:
            InputError: the port is not between handle and tip, or a coordinate is not finite.
        """
        where = f"{self.name} instrument: handle"
        _check_point(where, handle)
        tip, direction = np.empty(3), np.empty(3)
        if not reach(np.array(handle, dtype=float), np.array(self.port), self.length, tip, direction):
            raise InputError(
                where,
                f"a point {LEAST_OUTSIDE:g} to {self.length:g} m from the port {_shown(self.port)}",
                _shown(handle),
                f"it is {dist(handle, self.port):.4g} m away, and the tip must lie beyond the port",
            )
        return Reach(tip=_vector(tip), direction=_vector(direction), outside=dist(handle, self.port))

    def handle_for(self, tip: Sequence[float]) -> Vector:
        """Return where the handle is when the tip is at a point.

        Args:
            tip: (x, y, z) [m].

        Raises:
            InputError: the shaft is too short for the point, the point is the port itself, or a coordinate is not
                finite.
        """
        where = f"{self.name} instrument: tip"
        _check_point(where, tip)
        inside = dist(tip, self.port)
        most = self.length - LEAST_OUTSIDE
        if not 0 < inside <= most:
            raise InputError(
                where,
                f"a point within {most:g} m of the port {_shown(self.port)}, and not the port itself",
                _shown(tip),
                f"it is {inside:.4g} m away",
            )
        x, y, z = (t - self.length * (t - p) / inside for t, p in zip(tip, self.port, strict=True))
        return x, y, z


def default_instruments(
    size: tuple[float, float], thickness: float = THICKEST_BLOCK
) -> tuple[Instrument, Instrument]:
    """Return the trainer's usual pair, a grasper in the left hand and a probe in the right.

    The ports lie beside the middle of the block and towards the user, whatever its size, so that both tips reach every
    corner of it, top and base.

    Args:
        size: sides of the block along x and y [m].
        thickness: of all layers together [m].

    Raises:
        InputError: the pair does not reach all over such a block.
    """
    if not all(isfinite(side) and SMALLEST_BLOCK <= side <= LARGEST_BLOCK for side in size):
        raise InputError(
            "default instruments: size",
            f"sides from {SMALLEST_BLOCK:g} to {LARGEST_BLOCK:g} m",
            size,
            "give instruments with ports of your own",
        )
    if not (isfinite(thickness) and 0 < thickness <= THICKEST_BLOCK):
        raise InputError(
            "default instruments: thickness",
            f"a length above 0 and at most {THICKEST_BLOCK:g} m",
            thickness,
            "give instruments with ports of your own",
        )
    left, right = (
        _default(name, tip, side, size)
        for name, tip, side in (("left", TipKind.GRASPER, -1), ("right", TipKind.PROBE, 1))
    )
    return left, right


def _default(name: str, tip: TipKind, side: int, size: tuple[float, float]) -> Instrument:
    middle_x, middle_y = size[0] / 2, size[1] / 2
    port = (middle_x + side * _ASIDE, middle_y - _TOWARDS_USER, _ABOVE)
    start = (middle_x + side * (0.5 - _SHARE) * size[0], middle_y, _CLEARANCE)
    inside = dist(start, port)
    x, y, z = (s - _LENGTH * (s - p) / inside for s, p in zip(start, port, strict=True))
    return Instrument(
        name=name, port=port, length=_LENGTH, shaft_radius=_SHAFT_RADIUS, tip=tip, handle=(x, y, z)
    )


def _check_point(where: str, point: Sequence[float]) -> None:
    if len(point) != 3 or not all(isfinite(coordinate) for coordinate in point):
        raise InputError(where, "three finite coordinates [m]", point)


def _vector(array: FloatArray) -> Vector:
    x, y, z = array.tolist()
    return x, y, z


def _shown(point: Sequence[float]) -> str:
    return "(" + ", ".join(f"{coordinate:.6g}" for coordinate in point) + ")"
