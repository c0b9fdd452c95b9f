"""What the finite elements remember: the quarter's nodes, by parity: where, how fast, and the branches' stretch."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from trocar.model import FloatArray
from trocar.reference.parity import Parity


@dataclass(frozen=True, kw_only=True, eq=False)
class FEAState:
    """A moment of the block.

    Args:
        time: since the start [s].
        displacement: of the quarter's nodes [m], shape (3, nodes), for every parity that is not zero.
        velocity: the same [m/s]; empty for an equilibrium.
        memory: what the Maxwell branches of each relaxation time are stretched by [m], shape (D, 3, nodes), likewise;
            empty where they are relaxed.
    """

    time: float
    displacement: Mapping[Parity, FloatArray]
    velocity: Mapping[Parity, FloatArray]
    memory: Mapping[Parity, FloatArray] = field(default_factory=dict)
