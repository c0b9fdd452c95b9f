"""Scripted hands: the tips follow a script, the handles follow the tips by the lever, and they tremble.

Tremor and noise are added where they arise, at the handle, and reach the tip by the lever like any motion of the hand.
"""

from __future__ import annotations

from typing import Final

from trocar.contact.instrument import NAMES, Instrument, default_instruments
from trocar.devices.device import Forces, HandlePose, Poses
from trocar.devices.motion import Path
from trocar.devices.scripts import SCRIPTS, USUAL_DEPTH
from trocar.devices.unsteadiness import USUAL_NOISE, USUAL_TREMOR, SensorNoise, Tremor
from trocar.errors import InputError

USUAL_SIZE = (0.06, 0.06)  # [m]
USUAL_SCRIPT = "press-slide-lift"


class SimulatedDevice:
    """Two scripted hands.

    Args:
        script: what they do, a name from `SCRIPTS`.
        seed: of tremor and noise, 0 or above; the same seed gives the same poses, bit by bit.
        tremor: root mean square of the handle's tremor [m]; 0 for none.
        noise: standard deviation of the sensor's noise in each direction [m]; 0 for none.
        depth: of the script's deepest press [m].
        size: sides of the block along x and y [m].
        instruments: left and right; None takes the trainer's usual pair for that block.

    Raises:
        InputError: there is no such script, a value is not possible, or an instrument does not reach its places.
    """

    name: Final = "simulated"
    description: Final = "scripted hands with tremor and sensor noise"
    steered_by_page: Final = False
    every_tick: Final = True

    def __init__(
        self,
        script: str = USUAL_SCRIPT,
        *,
        seed: int = 0,
        tremor: float = USUAL_TREMOR,
        noise: float = USUAL_NOISE,
        depth: float = USUAL_DEPTH,
        size: tuple[float, float] = USUAL_SIZE,
        instruments: tuple[Instrument, Instrument] | None = None,
    ) -> None:
        if script not in SCRIPTS:
            raise InputError("simulated device: script", f"one of {', '.join(SCRIPTS)}", script)
        if seed < 0:
            raise InputError("simulated device: seed", "a whole number, 0 or above", seed)
        self.instruments = default_instruments(size) if instruments is None else instruments
        paths = SCRIPTS[script].paths(self.instruments, size, depth)
        self.duration = max(path.duration for path in paths)
        """Time the script takes [s]."""
        left, right = (
            _Hold(instrument, path, Tremor(f"{seed} {hand}", tremor), SensorNoise(f"{seed} {hand}", noise))
            for hand, instrument, path in zip(NAMES, self.instruments, paths, strict=True)
        )
        self._hands = left, right

    def open(self) -> None:
        """Nothing to get ready: poses follow from the time alone."""

    def poses(self, time: float, /) -> Poses:
        """Return both poses at a time [s] since the script's start; it ends as it began."""
        left, right = self._hands
        return left.pose(time), right.pose(time)

    def feel(self, forces: Forces, /) -> None:
        """Feel nothing: the script goes on whatever the tissue does."""

    def finished(self, time: float, /) -> bool:
        """Return whether the script is over at a time [s]."""
        return time >= self.duration

    def close(self) -> None:
        """Nothing to let go of."""


class _Hold:
    """One hand on one handle."""

    def __init__(self, instrument: Instrument, path: Path, tremor: Tremor, noise: SensorNoise) -> None:
        self._instrument, self._path, self._tremor, self._noise = instrument, path, tremor, noise

    def pose(self, time: float) -> HandlePose:
        tip, roll, jaw = self._path.at(time)
        meant = self._instrument.handle_for(tip)
        x, y, z = (
            h + t + n for h, t, n in zip(meant, self._tremor.at(time), self._noise.at(time), strict=True)
        )
        return HandlePose(present=True, handle=(x, y, z), roll=roll, jaw=jaw)
