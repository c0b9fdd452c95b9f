"""A block cut along its middle plane x = a/2, by finite elements: what cuttable models are judged by.

Under a load that is its own mirror image the two faces of the cut are too, and the cut is the mirror plane of the
quarter (`parity`) with the nodes on it let go: their displacement across the plane is free and so is their traction.
The faces may pass through each other, where a load closes the cut.
"""

from __future__ import annotations

import numpy as np

from trocar.errors import InputError
from trocar.model import FloatArray, Load, Support
from trocar.reference.assembly import stiffness
from trocar.reference.block import MeshSize, held_by_support, quarter_mesh
from trocar.reference.forces import NodalForces
from trocar.reference.mesh import Bricks
from trocar.reference.ordering import dissection_order
from trocar.reference.parity import Parity, held_on_mirrors
from trocar.reference.solver import Factorisation, choose_solver
from trocar.tissues import Tissue

_EVEN = Parity(1, 1)


class OpenedBlock:
    """The equilibrium of a linear block with a cut at x = a/2 from side to side.

    Args:
        tissue: the layers.
        size: sides a, b of the block [m].
        support: how it is held.
        load: presses that are together their own mirror image in x = a/2 and in y = b/2.
        depth: of the cut [m]; it ends at the nodes nearest to that.
        mesh: how finely.

    Raises:
        InputError: the load is not its own mirror image.
        SolverError: the equations could not be solved accurately.
    """

    def __init__(
        self,
        tissue: Tissue,
        *,
        size: tuple[float, float],
        support: Support,
        load: Load,
        depth: float,
        mesh: MeshSize | None = None,
    ) -> None:
        self._bricks: Bricks = quarter_mesh(tissue, size, support, load, mesh or MeshSize())
        forces = NodalForces(self._bricks, size).of(load)
        if set(forces) != {_EVEN}:
            raise InputError("load", f"presses that mirror each other in x = {size[0] / 2:g} m", load)
        bricks = self._bricks
        x, _, z = bricks.nodes
        lines = bricks.z
        self.depth = -float(lines[np.argmin(np.abs(lines + depth))])
        released = (np.abs(x - bricks.x[-1]) < 1e-9 * size[0]) & (z > -self.depth + 1e-9 * tissue.thickness)
        if self.depth >= tissue.thickness:
            released |= np.abs(x - bricks.x[-1]) < 1e-9 * size[0]
        mirrors = held_on_mirrors(bricks, _EVEN)
        mirrors[0] &= ~released
        held = held_by_support(bricks, support) | mirrors
        nodes = dissection_order(bricks)
        order = (nodes[:, None] + len(nodes) * np.arange(3)).ravel()
        free = order[~held.ravel()[order]]
        matrix = stiffness(bricks, tissue.layers)[free][:, free]
        field = np.zeros(held.size)
        field[free] = Factorisation(matrix, choose_solver("auto")).solve(forces[_EVEN].ravel()[free])
        self._field = field.reshape(held.shape)

    def displacement(self, points: FloatArray) -> FloatArray:
        """Return the displacement [m], shape (n, 3), of points of the top face with x <= a/2, y <= b/2, (n, 2)."""
        nodes, weights = self._bricks.interpolation(points, len(self._bricks.z) - 1)
        return np.asarray(np.einsum("can,an->nc", self._field[:, nodes], weights))
