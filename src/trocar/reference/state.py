"""What the finite elements remember: displacement and velocity of the quarter's nodes, by parity."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from trocar.model import FloatArray
from trocar.reference.parity import Parity


@dataclass(frozen=True, kw_only=True, eq=False)
class FEAState:
    """A moment of the block.

    Args:
        time: since the start [s].
        displacement: of the quarter's nodes [m], shape (3, nodes), for every parity that is not zero.
        velocity: the same [m/s]; empty for an equilibrium.
    """

    time: float
    displacement: Mapping[Parity, FloatArray]
    velocity: Mapping[Parity, FloatArray]
