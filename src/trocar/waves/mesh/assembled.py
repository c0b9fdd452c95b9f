"""The matrices of a mesh, its stiffness factored, and its lowest modes; each is made when it is first asked for."""

from __future__ import annotations

from functools import cached_property

import numpy as np
import scipy.sparse as sp

from trocar.model import FloatArray
from trocar.waves.mesh.dissection import dissected
from trocar.waves.mesh.elements import Elements
from trocar.waves.mesh.lowest_modes import lowest_modes
from trocar.waves.mesh.solid_mesh import IntArray
from trocar.waves.mesh.sparse import Factored


class Assembled:
    """Hold what the finite elements of a mesh say, with their unknowns in the elements' order.

    Args:
        elements: of the mesh.
    """

    def __init__(self, elements: Elements) -> None:
        self.elements = elements
        self.free = np.flatnonzero(~elements.held.ravel())

    @cached_property
    def stiffness(self) -> sp.csr_array:
        """K, with prestress [N/m], shape (unknowns, unknowns)."""
        return self.elements.stiffness()

    @cached_property
    def mass(self) -> sp.csr_array:
        """M [kg]."""
        return self.elements.mass()

    @cached_property
    def damping(self) -> sp.csr_array:
        """C [N s/m]."""
        materials = self.elements.mesh.materials
        times = {material.retardation_time for material in materials}
        if len(times) == 1 and not any(
            material.prestress_x or material.prestress_y for material in materials
        ):
            return sp.csr_array(times.pop() * self.stiffness)  # the elastic stiffness is all of it
        return self.elements.damping()

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
        """The stiffness of what is free, in the order of its elimination."""
        unknowns, below = self._parts
        return Factored(self._ordered(self.stiffness), [len(own) for own in unknowns], below)

    def _ordered(self, matrix: sp.csr_array) -> sp.csr_array:
        return sp.csr_array(matrix[self._order][:, self._order])

    def answer(self, forces: FloatArray) -> FloatArray:
        """Return the static displacement K^-1 f [m] of nodal forces [N], both of shape (unknowns,)."""
        field = np.zeros_like(forces)
        field[self._order] = self.factored.solve(forces[self._order])
        return field

    def modes(self, count: int) -> tuple[FloatArray, FloatArray]:
        """Return squared angular frequencies [1/s^2], ascending, and modes of unit mass [kg^-1/2].

        Returns:
            Shapes (count,) and (unknowns, count).
        """
        squares, shapes = lowest_modes(self.factored.solve, self._ordered(self.mass), count)
        modes = np.zeros((self.elements.held.size, count))
        modes[self._order] = shapes
        return squares, modes
