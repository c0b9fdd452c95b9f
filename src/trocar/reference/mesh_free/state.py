"""What the mesh-free model remembers: where its nodes are and how fast they move."""

from __future__ import annotations

from dataclasses import dataclass

from trocar.model import FloatArray


@dataclass(frozen=True, kw_only=True, eq=False)
class MeshFreeState:
    """A moment of the block, in the parameters of its nodes: moving least squares fit them and do not pass through.

    Args:
        time: since the start [s].
        displacement: [m], shape (nodes, 3).
        velocity: [m/s], shape (nodes, 3).
    """

    time: float
    displacement: FloatArray
    velocity: FloatArray
