"""A block as the mesh-free method sees it: nodes, patches, matrices."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from trocar.errors import InputError
from trocar.model import FloatArray, Support
from trocar.reference.deformed import InversionError
from trocar.reference.grid import IntArray
from trocar.reference.mesh_free.cloud import BoolArray, Cloud, held_nodes
from trocar.reference.mesh_free.ordering import dissection_order
from trocar.reference.mesh_free.patches import Patches, divide
from trocar.reference.mesh_free.shape import evaluate
from trocar.reference.mesh_free.stiffness import Pattern, lumped_mass, moduli_at_rest
from trocar.reference.mesh_free.stress import Laws, internal_forces, laws_of, slopes_of
from trocar.reference.solver import Factorisation
from trocar.reference.stress import Deformation
from trocar.tissues import Tissue

_AT_REST = np.eye(3)[None]  # dJ/dF


@dataclass(frozen=True, eq=False)
class Body:
    """Nodes and what they are held and moved by.

    Args:
        cloud: the nodes.
        tissue: the layers.
        support: how the block is held.
        solver: "superlu" or "pardiso".
        mirrored: whether the nodes are those of a quarter.
    """

    cloud: Cloud
    tissue: Tissue
    support: Support
    solver: str
    mirrored: bool = False

    @cached_property
    def patches(self) -> Patches:
        """The quadrature."""
        return divide(self.cloud)

    @cached_property
    def pattern(self) -> Pattern:
        """Which nodes meet."""
        return Pattern(self.patches, len(self.cloud.places))

    @cached_property
    def laws(self) -> Laws:
        """Of the layers."""
        return laws_of(self.tissue)

    @cached_property
    def held(self) -> BoolArray:
        """Which components the support holds at zero, shape (nodes, 3)."""
        return held_nodes(self.cloud, self.support, mirrored=self.mirrored)

    @cached_property
    def free(self) -> IntArray:
        """The unknowns in the order of their elimination, component i of node n being 3 n + i."""
        nodes = dissection_order(self.cloud.places, self.pattern.graph)
        order = (3 * nodes[:, None] + np.arange(3)).ravel()
        free: IntArray = order[~self.held.ravel()[order]]
        return free

    @cached_property
    def mass(self) -> FloatArray:
        """Of each node [kg], shape (nodes,).

        Raises:
            InputError: cuts leave a node without any.
        """
        mass = lumped_mass(self.patches, self.tissue.layers, len(self.cloud.places))
        if not (mass > 0).all():
            raise InputError(
                "cuts",
                "tissue around every node",
                f"{int((mass <= 0).sum())} nodes in slivers",
                "take a finer resolution, or keep the cuts further apart",
            )
        return mass

    @cached_property
    def stiffness(self) -> sp.csr_array:
        """K at rest [N/m], prestress included, of all unknowns, shape (3 nodes, 3 nodes)."""
        layers = self.tissue.layers
        moduli = moduli_at_rest(layers, np.ones(len(layers)), prestress=True)
        return self.pattern.matrix(moduli, _AT_REST, self.laws.lame)

    @cached_property
    def damping(self) -> sp.csr_array:
        """C at rest [N s/m], of all unknowns: each layer's elastic stiffness times its retardation time."""
        times = self.laws.retardation
        moduli = moduli_at_rest(self.tissue.layers, times, prestress=False)
        return self.pattern.matrix(moduli, _AT_REST, times * self.laws.lame)

    @cached_property
    def factors(self) -> Factorisation:
        """Of the stiffness at rest."""
        return Factorisation(self.freed(self.stiffness), self.solver)

    def freed(self, matrix: sp.csr_array) -> sp.csr_array:
        """Return a matrix's part between the free unknowns."""
        return sp.csr_array(matrix[self.free][:, self.free])

    def spread(self, unknowns: FloatArray) -> FloatArray:
        """Return a field, shape (nodes, 3), from its free unknowns."""
        field = np.zeros(self.held.size)
        field[self.free] = unknowns
        return field.reshape(self.held.shape)

    def internal(self, displacement: FloatArray, velocity: FloatArray) -> FloatArray:
        """Return the nodal forces [N] that hold a displacement [m] at a velocity [m/s]; all of shape (nodes, 3).

        Raises:
            InversionError: tissue is turned inside out.
        """
        forces = np.empty_like(displacement)
        patch = internal_forces(self.patches, self.laws, displacement, velocity, forces)
        if patch >= 0 or not np.isfinite(forces).all():
            raise InversionError(patch, "tissue is turned inside out")
        return forces

    def deformations(self, displacement: FloatArray) -> list[Deformation]:
        """Return how far each layer is deformed by a displacement [m], shape (nodes, 3)."""
        gradient = slopes_of(self.patches, displacement) + np.eye(3)
        layer = np.repeat(self.patches.layer, np.diff(self.patches.part_start))
        return [Deformation.of(gradient[layer == number]) for number in range(len(self.tissue.layers))]

    def interpolation(self, points: FloatArray, layer: int) -> sp.csr_array:
        """Return the shape functions at points of a layer's upper face, shape (points, nodes).

        Args:
            points: places on the block [m], shape (n, 2 or more); only x and y are used.
            layer: its number, from the top.
        """
        upper = int(np.flatnonzero(self.cloud.slab_layer == layer)[-1])
        starts, nodes, values = evaluate(self.cloud, np.ascontiguousarray(points[:, :2]), upper)
        return sp.csr_array((values, nodes, starts), shape=(len(points), len(self.cloud.places)))
