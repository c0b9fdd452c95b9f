"""The part of the block that is solved, with what its equations are made of."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, Generic

import numpy as np
import scipy.sparse as sp

from trocar.model import FloatArray
from trocar.reference.discretisation import Deformed, Discretisation
from trocar.reference.domain import Domain
from trocar.reference.grid import G
from trocar.reference.newton import NewtonError
from trocar.reference.solver import Factorisation, submatrix
from trocar.tissues import Tissue
from trocar.units import MILLIMETRE


@dataclass(frozen=True, eq=False)
class Part(Generic[G]):
    """The part of the block that is solved, with its equations.

    Args:
        domain: which part.
        tissue: the layers.
        discretisation: what makes equations of it.
        solver: "superlu" or "pardiso".
    """

    domain: Domain[G]
    tissue: Tissue
    discretisation: Discretisation[G]
    solver: str

    @cached_property
    def deformed(self) -> Deformed:
        """Forces and tangents."""
        return self.discretisation.deformed(self.domain.grid, self.tissue.layers, self.domain.free)

    @cached_property
    def at_rest(self) -> FloatArray:
        """The nodal forces that hold the prestress [N], shape (3, nodes)."""
        return self.deformed.forces(np.zeros(self.domain.grid.nodes.shape))

    @cached_property
    def mass(self) -> sp.csr_array:
        """M [kg] between the free unknowns."""
        return submatrix(self.discretisation.mass(self.domain.grid, self.tissue.layers), self.domain.free)

    @cached_property
    def rest_factors(self) -> Factorisation:
        """Of the tangent at rest: what every load starts from, whichever came before."""
        return Factorisation(self.deformed.stiffness(np.zeros(self.domain.grid.nodes.shape)), self.solver)

    def damping_about(self, unknowns: FloatArray) -> sp.csr_array | None:
        """Return C [N s/m] about free unknowns [m]; None where no layer is damped."""
        if not any(layer.retardation_time for layer in self.tissue.layers):
            return None
        return self.deformed.damping(self.spread(unknowns))

    def internal(self, field: FloatArray) -> FloatArray:
        """Return the nodal forces [N] that hold a displacement [m], beyond those at rest; both (3, nodes)."""
        return self.deformed.forces(field) - self.at_rest

    def freed(self, field: FloatArray) -> FloatArray:
        """Return a field's free unknowns, shape (n,)."""
        return field.ravel()[self.domain.free]

    def spread(self, unknowns: FloatArray) -> FloatArray:
        """Return a field, shape (3, nodes), from its free unknowns."""
        field = np.zeros(self.domain.held.size)
        field[self.domain.free] = unknowns
        return field.reshape(self.domain.held.shape)

    def where(self, element: int) -> str:
        """Say where an element is: layer and centre."""
        grid = self.domain.grid
        x, y, z = grid.centres[:, element] / MILLIMETRE
        name = self.tissue.layer_names[int(grid.element_layer[element])]
        return f"layer {name!r}, element centred at ({x:.3g}, {y:.3g}, {z:.3g}) mm"

    def most_squeezed(self, field: FloatArray) -> int:
        """Return the element with the smallest principal stretch."""
        return int(np.argmin(self.deformed.smallest_stretch(field)))

    def why(self, stopped: NewtonError, field: FloatArray) -> str:
        """Say why and where Newton's method stopped, coming from `field`."""
        if stopped.element is None:
            element = self.most_squeezed(field)
            return f"{stopped.reason}; {self.where(element)} is squeezed the most"
        return f"{self.where(stopped.element)}: {stopped.reason}"


class Static:
    """The balance of a part under a load: a system of `Equations`.

    Args:
        part: what is loaded.
        force: nodal forces [N], shape (n,), of the free unknowns.
    """

    def __init__(self, part: Part[Any], force: FloatArray) -> None:
        self._part = part
        self._force = force

    def imbalance(self, unknowns: FloatArray) -> FloatArray:
        """Return internal less external forces [N]."""
        return self._part.freed(self._part.internal(self._part.spread(unknowns))) - self._force

    def tangent(self, unknowns: FloatArray) -> sp.csr_array:
        """Return the tangent stiffness [N/m]."""
        return self._part.deformed.stiffness(self._part.spread(unknowns))

    def convex(self, unknowns: FloatArray) -> sp.csr_array | None:
        """Return a positive definite stand-in for it, or None."""
        return self._part.deformed.convex(self._part.spread(unknowns))
