"""Whether a device keeps its word: read at the servo's rate, in its own time, every pose checked.

What is checked is what the trainer relies on: finite numbers, the jaw between 0 and 1, handles near the block and where
a shaft can be, two equal answers for one time, and no tip faster than a hand can move it.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import dist, floor, hypot, isfinite

from trocar.contact.instrument import NAMES, Instrument, Vector
from trocar.devices.device import FARTHEST, FASTEST_TIP, Device, HandlePose
from trocar.errors import InputError

RATE = 1000.0  # [Hz] of the servo
LONGEST = 600.0  # [s]
_NEWS = 3  # complaints of a kind that are told, each with its time


@dataclass(kw_only=True, slots=True)
class Findings:
    """What one instrument of a device did.

    Args:
        instrument: "left" or "right".
        present: share of the time it was in the hand.
        changes: how often its pose changed in a second [Hz].
        fastest_tip: largest speed of the tip between two readings [m/s].
        fastest_handle: largest speed of the handle [m/s].
        lowest_tip: z of the deepest point the tip reached [m]; None while absent.
        jaw: least and largest opening; None while absent.
        complaints: sentences about what no trainer could use, the first few of each kind.
    """

    instrument: str
    present: float = 0.0
    changes: float = 0.0
    fastest_tip: float = 0.0
    fastest_handle: float = 0.0
    lowest_tip: float | None = None
    jaw: tuple[float, float] | None = None
    complaints: list[str] = field(default_factory=list)

    def as_dict(self) -> dict[str, object]:
        """Return the findings with units in their names, for JSON."""
        return {
            "instrument": self.instrument,
            "present": self.present,
            "changes_hz": self.changes,
            "fastest_tip_m_s": self.fastest_tip,
            "fastest_handle_m_s": self.fastest_handle,
            "lowest_tip_m": self.lowest_tip,
            "jaw": self.jaw,
            "complaints": self.complaints,
        }


def examine(
    device: Device, instruments: tuple[Instrument, Instrument], size: tuple[float, float], seconds: float
) -> tuple[Findings, Findings]:
    """Open a device, read it at 1 kHz of its own time without waiting, close it, and say what it did.

    Args:
        device: one whose poses follow from the time, or that is not held by anyone.
        instruments: left and right, whose handles it moves.
        size: sides of the block along x and y [m].
        seconds: how long.

    Raises:
        InputError: the time is not possible.
        TrocarError: the device cannot be opened.
    """
    if not (isfinite(seconds) and 1 / RATE <= seconds <= LONGEST):
        raise InputError("seconds", f"a time from {1 / RATE:g} to {LONGEST:g} s", seconds)
    left, right = (
        _Reader(name, instrument, size) for name, instrument in zip(NAMES, instruments, strict=True)
    )
    readings = floor(seconds * RATE + 1e-9)  # a whole number may come out a rounding short
    device.open()
    try:
        for number in range(readings + 1):
            time = number / RATE
            poses, again = device.poses(time), device.poses(time)
            for reader, pose, same in zip((left, right), poses, again, strict=True):
                reader.read(time, pose, same)
            device.feel(((0.0, 0.0, 0.0), (0.0, 0.0, 0.0)))
    finally:
        device.close()
    return left.findings(readings), right.findings(readings)


class _Reader:
    """Looks at one instrument's poses one after the other."""

    def __init__(self, name: str, instrument: Instrument, size: tuple[float, float]) -> None:
        self._instrument, self._size = instrument, size
        self._found = Findings(instrument=name)
        self._told: dict[str, int] = {}
        self._last: HandlePose | None = None
        self._last_tip: Vector | None = None
        self._present = self._changes = 0

    def findings(self, readings: int) -> Findings:
        self._found.present = self._present / (readings + 1)
        self._found.changes = self._changes * RATE / readings
        return self._found

    def read(self, time: float, pose: HandlePose, again: HandlePose) -> None:
        if pose != again:
            self._complain(time, "two answers for one time", f"{pose} and {again}")
        last, self._last = self._last, pose
        last_tip, self._last_tip = self._last_tip, None
        self._changes += last is not None and pose != last
        if not all(map(isfinite, (*pose.handle, pose.roll, pose.jaw))):
            self._complain(time, "a number that is not finite", str(pose))
            return
        if not 0.0 <= pose.jaw <= 1.0:
            self._complain(time, "a jaw outside 0 to 1", f"{pose.jaw!r}")
        if _from_block(pose.handle, self._size) > FARTHEST:
            self._complain(time, f"a handle farther than {FARTHEST:g} m from the block", f"{pose.handle}")
        if pose.present:
            self._present += 1
            self._follow(time, pose, last, last_tip)

    def _follow(
        self, time: float, pose: HandlePose, last: HandlePose | None, last_tip: Vector | None
    ) -> None:
        found = self._found
        try:
            tip = self._instrument.reach_of(pose.handle).tip
        except InputError as error:
            self._complain(time, "a handle where the shaft cannot be", str(error))
            return
        self._last_tip = tip
        found.lowest_tip = tip[2] if found.lowest_tip is None else min(found.lowest_tip, tip[2])
        least, most = found.jaw or (pose.jaw, pose.jaw)
        found.jaw = (min(least, pose.jaw), max(most, pose.jaw))
        if last is None or last_tip is None:
            return
        found.fastest_handle = max(found.fastest_handle, RATE * dist(pose.handle, last.handle))
        speed = RATE * dist(tip, last_tip)
        found.fastest_tip = max(found.fastest_tip, speed)
        if speed > FASTEST_TIP:
            self._complain(time, f"a tip faster than {FASTEST_TIP:g} m/s", f"{speed:.3g} m/s")

    def _complain(self, time: float, kind: str, what: str) -> None:
        self._told[kind] = self._told.get(kind, 0) + 1
        if self._told[kind] <= _NEWS:
            self._found.complaints.append(f"{self._found.instrument} at {time:.3f} s: {kind}: {what}")


def _from_block(point: Vector, size: tuple[float, float]) -> float:
    """Distance of a point from the block's top face [m]."""
    x, y = (max(-c, c - side, 0.0) for c, side in zip(point[:2], size, strict=True))
    return hypot(x, y, point[2])
