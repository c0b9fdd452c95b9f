"""The matrices of a mesh, its stiffness factored, and its lowest modes; each is made when it is first asked for.

Materials that remember (a Prony series) add branches, and a load meets K + sum over times of s_d G_d, with shares s_d
of 0 after long and 1 at once. The sudden one is factored: it is what moves. The others are between it and its part
1/(1 + largest sum of g), so conjugate gradients that the factor preconditions need few steps (Hestenes and Stiefel
1952). Where all materials have one series, all are multiples of the sudden one.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import LinearOperator, cg

from trocar.errors import SolverError
from trocar.model import FloatArray
from trocar.tissues.layer import relaxation_times
from trocar.waves.memory import alike
from trocar.waves.mesh.dissection import dissected
from trocar.waves.mesh.elements import Elements
from trocar.waves.mesh.lowest_modes import lowest_modes
from trocar.waves.mesh.solid_mesh import IntArray
from trocar.waves.mesh.sparse import Factored

_RESIDUAL = 1e-10  # relative, of conjugate gradients: of a static answer it leaves ten digits
_MOST_STEPS = 2000  # a branch a thousand times as stiff as its spring takes a few hundred


class Assembled:
    """Hold what the finite elements of a mesh say, with their unknowns in the elements' order.

    Args:
        elements: of the mesh.

    Raises:
        InputError: its materials have too many different relaxation times.
    """

    def __init__(self, elements: Elements) -> None:
        self.elements = elements
        materials = elements.mesh.materials
        self.free = np.flatnonzero(~elements.held.ravel())
        self.times = np.array(relaxation_times(materials, "mesh"))
        self.weights = np.array([[layer.relaxing(time) for layer in materials] for time in self.times])

    @cached_property
    def stiffness(self) -> sp.csr_array:
        """K after long, with prestress [N/m], shape (unknowns, unknowns)."""
        return self.elements.stiffness()

    @cached_property
    def mass(self) -> sp.csr_array:
        """M [kg]."""
        return self.elements.mass()

    @cached_property
    def damping(self) -> sp.csr_array:
        """C [N s/m]."""
        times = {material.retardation_time for material in self.elements.mesh.materials}
        if len(times) == 1 and not self._prestressed:
            return sp.csr_array(times.pop() * self.stiffness)  # the elastic stiffness is all of it
        return self.elements.damping()

    @property
    def _prestressed(self) -> bool:
        return any(layer.prestress_x or layer.prestress_y for layer in self.elements.mesh.materials)

    @property
    def changes_shape(self) -> bool:
        """Whether shapes change while materials relax: they do not where all have one series."""
        return len(self.times) > 0 and (self._prestressed or not alike(self.weights))

    @cached_property
    def branches(self) -> tuple[sp.csr_array, ...]:
        """G of each relaxation time [N/m]; asked for only where shapes change."""
        return tuple(self.elements.remembered(time) for time in self.times)

    @cached_property
    def sudden(self) -> sp.csr_array:
        """K + sum of G: what a sudden force meets [N/m]."""
        if len(self.times) == 0:
            return self.stiffness
        if self.changes_shape:
            return sp.csr_array(sum(self.branches, start=self.stiffness))
        return sp.csr_array(self.stiffening * self.stiffness)

    @property
    def stiffening(self) -> float:
        """How many times stiffer materials of one series are at once than after long."""
        return float(1 + self.weights[:, 0].sum()) if len(self.times) else 1.0

    @cached_property
    def _parts(self) -> tuple[list[IntArray], list[tuple[int, ...]]]:
        """Unknowns that are free, part by part in the order of their elimination, and which parts lie below each."""
        count = self.elements.nodes.shape[1]
        free = ~self.elements.held.ravel()
        unknowns, below = [], []
        for part in dissected(self.elements.nodes, self.stiffness[:count, :count]):
            own = (part.nodes[:, None] + count * np.arange(3)).ravel()
            unknowns.append(own[free[own]])
            below.append(part.below)
        return unknowns, below

    @cached_property
    def _order(self) -> IntArray:
        return np.concatenate(self._parts[0])

    @cached_property
    def factored(self) -> Factored:
        """The sudden stiffness of what is free, in the order of its elimination."""
        unknowns, below = self._parts
        return Factored(self._ordered(self.sudden), [len(own) for own in unknowns], below)

    def _ordered(self, matrix: sp.csr_array) -> sp.csr_array:
        return sp.csr_array(matrix[self._order][:, self._order])

    def answer(self, forces: FloatArray) -> FloatArray:
        """Return the displacement [m] that nodal forces [N] hold at once, both of shape (unknowns,)."""
        field = np.zeros_like(forces)
        field[self._order] = self.factored.solve(forces[self._order])
        return field

    def delayed_answer(self, forces: FloatArray, shares: FloatArray) -> FloatArray:
        """Return the displacement [m] that nodal forces [N] hold while branches resist in part.

        Args:
            forces: shape (unknowns,).
            shares: of each branch, 0 after long and 1 at once, shape (D,).

        Raises:
            SolverError: the iteration does not end.
        """
        parts = zip(shares, self.branches, strict=True)
        matrix = sum((share * branch for share, branch in parts), start=self.stiffness)
        free = np.zeros(len(forces))
        free[self.free] = 1.0
        size = len(forces), len(forces)
        field, left = cg(
            LinearOperator(size, matvec=lambda moved: free * (matrix @ moved), dtype=np.float64),
            free * forces,
            rtol=_RESIDUAL,
            maxiter=_MOST_STEPS,
            M=LinearOperator(size, matvec=self.answer, dtype=np.float64),
        )
        if left:
            raise SolverError(
                f"the relaxed mesh: expected a residual below {_RESIDUAL:g} after {_MOST_STEPS} steps; "
                "bring the weights g of the materials' series closer together"
            )
        return np.asarray(field, dtype=np.float64)

    def modes(
        self, count: int, *, progress: Callable[[int, int], None] | None = None
    ) -> tuple[FloatArray, FloatArray]:
        """Return squared angular frequencies [1/s^2], ascending, and modes of unit mass [kg^-1/2], as stiff as at once.

        Args:
            count: how many.
            progress: told how many of them are found, and of how many.

        Returns:
            Shapes (count,) and (unknowns, count).
        """
        squares, shapes = lowest_modes(
            self.factored.solve, self._ordered(self.mass), count, progress=progress
        )
        modes = np.zeros((self.elements.held.size, count))
        modes[self._order] = shapes
        return squares, modes
