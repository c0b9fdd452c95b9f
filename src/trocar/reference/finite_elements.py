"""Finite elements as a discretisation: the bricks of `assembly` and, under large deformation, of `deformed`."""

from __future__ import annotations

import scipy.sparse as sp

from trocar.reference import assembly
from trocar.reference.deformed import DeformedBricks
from trocar.reference.grid import IntArray
from trocar.reference.mesh import Bricks
from trocar.tissues import Layer


class FiniteElements:
    """20-node bricks; a `Discretisation`."""

    def stiffness(self, grid: Bricks, layers: tuple[Layer, ...]) -> sp.csr_array:
        """Return K [N/m], prestress included."""
        return assembly.stiffness(grid, layers)

    def damping(self, grid: Bricks, layers: tuple[Layer, ...]) -> sp.csr_array:
        """Return C [N s/m]."""
        return assembly.damping(grid, layers)

    def branch(self, grid: Bricks, layers: tuple[Layer, ...], time: float) -> sp.csr_array:
        """Return the stiffness of a relaxation time [N/m]."""
        return assembly.branch(grid, layers, time)

    def mass(self, grid: Bricks, layers: tuple[Layer, ...]) -> sp.csr_array:
        """Return M [kg], consistent."""
        return assembly.mass(grid, layers)

    def deformed(self, grid: Bricks, layers: tuple[Layer, ...], free: IntArray) -> DeformedBricks:
        """Return the bricks under large deformation."""
        return DeformedBricks(grid, layers, free)
