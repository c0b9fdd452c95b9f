"""What turns a grid into equations: finite elements or springs. The rest of a block's model is the same for both."""

from __future__ import annotations

from typing import Protocol, TypeVar

import scipy.sparse as sp

from trocar.model import FloatArray
from trocar.reference.grid import Grid, IntArray
from trocar.tissues import Layer

GridT_contra = TypeVar("GridT_contra", bound=Grid, contravariant=True)


class Deformed(Protocol):
    """A grid that deforms much: forces and their derivatives about a displacement [m], shape (3, nodes)."""

    def forces(self, field: FloatArray) -> FloatArray:
        """Return the nodal forces [N] that hold a displacement, shape (3, nodes).

        Raises:
            InversionError: no tissue can be displaced so.
        """
        ...

    def stiffness(self, field: FloatArray) -> sp.csr_array:
        """Return the derivative of the free forces by the free unknowns [N/m].

        Raises:
            InversionError: no tissue can be displaced so.
        """
        ...

    def convex(self, field: FloatArray) -> sp.csr_array | None:
        """Return a stand-in for the stiffness that is positive definite, or None where there is none."""
        ...

    def damping(self, field: FloatArray) -> sp.csr_array:
        """Return the Kelvin-Voigt damping [N s/m] between the free unknowns."""
        ...

    def viscous_forces(self, field: FloatArray, velocity: FloatArray) -> FloatArray:
        """Return the nodal forces [N] of that damping at a velocity [m/s], both of shape (3, nodes)."""
        ...

    def smallest_stretch(self, field: FloatArray) -> FloatArray:
        """Return the smallest principal stretch in each element [1], shape (elements,)."""
        ...


class Discretisation(Protocol[GridT_contra]):
    """Matrices of the layers on a grid, between all unknowns, at small strain; and the grid that deforms much."""

    def stiffness(self, grid: GridT_contra, layers: tuple[Layer, ...]) -> sp.csr_array:
        """Return K [N/m], prestress included."""
        ...

    def damping(self, grid: GridT_contra, layers: tuple[Layer, ...]) -> sp.csr_array:
        """Return C [N s/m]: each layer's elastic stiffness times its retardation time."""
        ...

    def branch(self, grid: GridT_contra, layers: tuple[Layer, ...], time: float) -> sp.csr_array:
        """Return each layer's elastic stiffness [N/m] times its weight of a relaxation time [s]."""
        ...

    def mass(self, grid: GridT_contra, layers: tuple[Layer, ...]) -> sp.csr_array:
        """Return M [kg]."""
        ...

    def deformed(self, grid: GridT_contra, layers: tuple[Layer, ...], free: IntArray) -> Deformed:
        """Return the grid that deforms much, `free` its unknowns in the order of their elimination."""
        ...
