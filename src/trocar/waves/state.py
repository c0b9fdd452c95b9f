"""What a wave model remembers."""

from __future__ import annotations

from dataclasses import dataclass

from trocar.errors import InputError
from trocar.model import FloatArray, Load


@dataclass(frozen=True)
class WaveState:
    """Where the oscillators stand.

    Attributes:
        time: [s].
        oscillators: one array per family of modes, each of shape (J, r, 2); empty for a state that stands in
            equilibrium with its load, now and for ever before, and was not stepped yet.
        load: what acts at this instant; the part of the tissue that follows without inertia is read from it.
    """

    time: float
    oscillators: tuple[FloatArray, ...]
    load: Load = ()


def require_step(load0: Load, load1: Load, dt: float) -> None:
    """Check what every wave model's `step` is given.

    Raises:
        InputError: dt is not a finite number above 0, or the loads do not pair up.
    """
    if not 0 < dt < float("inf"):
        raise InputError("step: dt", "a finite number above 0 [s]", dt)
    if len(load0) != len(load1):
        raise InputError("step: load1", f"{len(load0)} presses, as in load0", len(load1))
