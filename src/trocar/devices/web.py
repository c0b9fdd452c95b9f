"""The hands in the browser: mouse, keyboard, gamepad and headset all end as poses that the page sends.

The page moves the handles at its display's rate and over a network, so poses come as they come: the newest counts, and
the servo smooths what lies between.
"""

from __future__ import annotations

from math import inf
from typing import Final

from trocar.contact.instrument import NAMES, Instrument, default_instruments
from trocar.devices.device import LEFT, RIGHT, Forces, HandlePose, Poses
from trocar.errors import InputError


class WebDevice:
    """Keeps the newest pose of each instrument; absent, at its start, until one has come.

    `take` may be called from another thread than `poses`: a pose is replaced whole, never changed.

    Args:
        instruments: left and right; None takes the trainer's usual pair.
    """

    name: Final = "web"
    description: Final = "the hands of the trainer's page: mouse, keyboard, gamepad, headset"
    steered_by_page: Final = True
    every_tick: Final = False
    duration: Final = inf

    def __init__(self, *, instruments: tuple[Instrument, Instrument] | None = None) -> None:
        pair = default_instruments((0.06, 0.06)) if instruments is None else instruments
        self._absent = [
            HandlePose(present=False, handle=instrument.handle, roll=0.0, jaw=1.0) for instrument in pair
        ]
        self._newest = list(self._absent)

    def open(self) -> None:
        """Forget earlier hands."""
        self._newest[:] = self._absent

    def take(self, instrument: int, pose: HandlePose, /) -> None:
        """Keep a pose until a newer one comes.

        Args:
            instrument: `LEFT` or `RIGHT`.
            pose: as it came, checked for finiteness and range.

        Raises:
            InputError: there is no such instrument.
        """
        if instrument not in (LEFT, RIGHT):
            names = " or ".join(f"{number} ({name})" for number, name in enumerate(NAMES))
            raise InputError("web device: instrument", names, instrument)
        self._newest[instrument] = pose

    def poses(self, time: float, /) -> Poses:
        """Return the newest poses, whatever the time."""
        return self._newest[LEFT], self._newest[RIGHT]

    def feel(self, forces: Forces, /) -> None:
        """Let them pass: the page reads the forces off the frames, and its bars and pulses tell the hands."""

    def finished(self, time: float, /) -> bool:
        """Return False: hands are never finished."""
        return False

    def close(self) -> None:
        """Nothing to let go of."""
