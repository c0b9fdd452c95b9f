"""The lattice as a discretisation: its springs' forces, and their derivatives as sparse matrices."""

from __future__ import annotations

from functools import cached_property

import numpy as np
import scipy.sparse as sp

from trocar.model import FloatArray
from trocar.reference.deformed import InversionError
from trocar.reference.grid import IntArray
from trocar.reference.springs import energies
from trocar.reference.springs.boxes import Boxes
from trocar.reference.springs.elements import Springs, layer_springs, masses, weighted_springs
from trocar.tissues import Layer


class Lattice:
    """Springs between masses; a `Discretisation`."""

    def stiffness(self, grid: Boxes, layers: tuple[Layer, ...]) -> sp.csr_array:
        """Return K [N/m] of the lattice at rest, prestress included."""
        return _at_rest(grid, layer_springs(grid, layers))

    def damping(self, grid: Boxes, layers: tuple[Layer, ...]) -> sp.csr_array:
        """Return C [N s/m] at rest: beside each spring a dashpot."""
        return _at_rest(grid, weighted_springs(grid, layers, [layer.retardation_time for layer in layers]))

    def branch(self, grid: Boxes, layers: tuple[Layer, ...], time: float) -> sp.csr_array:
        """Return the stiffness [N/m] of what hangs on dashpots of a relaxation time [s], at rest."""
        return _at_rest(grid, weighted_springs(grid, layers, [layer.relaxing(time) for layer in layers]))

    def mass(self, grid: Boxes, layers: tuple[Layer, ...]) -> sp.csr_array:
        """Return M [kg], diagonal."""
        return sp.csr_array(sp.diags_array(np.tile(masses(grid, layers), 3)))

    def deformed(self, grid: Boxes, layers: tuple[Layer, ...], free: IntArray) -> DeformedLattice:
        """Return the lattice whose springs turn."""
        return DeformedLattice(grid, layers, free)


class DeformedLattice:
    """A lattice whose springs turn.

    Args:
        boxes: the grid.
        layers: top first.
        free: the unknowns that may move, in the order to eliminate them in.
    """

    def __init__(self, boxes: Boxes, layers: tuple[Layer, ...], free: IntArray) -> None:
        self.boxes = boxes
        self.layers = layers
        self.free = free
        self._springs = layer_springs(boxes, layers)

    def forces(self, field: FloatArray) -> FloatArray:
        """Return the nodal forces [N] that hold a displacement [m], both of shape (3, nodes).

        Raises:
            InversionError: a box is inside out.
        """
        return self._forces(field)[0]

    def energy(self, field: FloatArray) -> float:
        """Return what springs and prestress store [J].

        Raises:
            InversionError: a box is inside out.
        """
        return self._forces(field)[1]

    def stiffness(self, field: FloatArray) -> sp.csr_array:
        """Return the derivative of the free forces by the free unknowns [N/m]."""
        return self._pattern.matrix(_blocks(self.boxes, self._springs, field, energies.EXACT))

    def convex(self, field: FloatArray) -> sp.csr_array:
        """Return what is positive in each spring's stiffness [N/m]."""
        return self._pattern.matrix(_blocks(self.boxes, self._springs, field, energies.CONVEX))

    def damping(self, field: FloatArray) -> sp.csr_array:
        """Return the dashpots' damping [N s/m] about a displacement [m], between the free unknowns."""
        return self._pattern.matrix(_blocks(self.boxes, self._dashpots, field, energies.STIFFENING))

    def viscous_forces(self, field: FloatArray, velocity: FloatArray) -> FloatArray:
        """Return the nodal forces [N] of that damping, shape (3, nodes), held nodes too."""
        blocks = _blocks(self.boxes, self._dashpots, field, energies.STIFFENING)
        everything = Pattern(self.boxes, np.arange(field.size))
        return np.asarray(everything.matrix(blocks) @ velocity.ravel()).reshape(field.shape)

    def smallest_stretch(self, field: FloatArray) -> FloatArray:
        """Return the smallest principal stretch of each box's mean edges [1], shape (boxes,)."""
        return np.asarray(np.linalg.svd(self.gradients(field), compute_uv=False).min(axis=1))

    def gradients(self, field: FloatArray) -> FloatArray:
        """Return F [1] of each box's mean edges, shape (boxes, 3, 3)."""
        place = (self.boxes.nodes + field)[:, self._springs.volumes.corners].reshape(3, -1, 2, 2, 2)
        means = [np.diff(place, axis=axis).mean(axis=(2, 3, 4)) for axis in (2, 3, 4)]
        return np.stack(means, axis=2).transpose(1, 0, 2) / self.boxes.edges.T[:, None, :]

    @cached_property
    def _dashpots(self) -> Springs:
        times = [layer.retardation_time for layer in self.layers]
        return weighted_springs(self.boxes, self.layers, times)

    @cached_property
    def _pattern(self) -> Pattern:
        return Pattern(self.boxes, self.free)

    def _forces(self, field: FloatArray) -> tuple[FloatArray, float]:
        rest, moved = np.ascontiguousarray(self.boxes.nodes.T), np.ascontiguousarray(field.T)
        force = np.zeros_like(rest)
        edges, scissors, volumes = self._springs.edges, self._springs.scissors, self._springs.volumes
        stored = energies.edge_forces(
            rest, moved, edges.ends, edges.length, edges.stiffness, edges.tension, force
        )
        stored += energies.scissor_forces(rest, moved, scissors.corners, scissors.stiffness, force)
        squeezed, inside_out = energies.volume_forces(
            moved, volumes.corners, volumes.sides, volumes.energy, force
        )
        if inside_out >= 0:
            raise InversionError(inside_out, "it turned inside out")
        return force.T, float(stored + squeezed)


class Pattern:
    """Where the blocks of nodes and their neighbours go in the matrix of some unknowns.

    Args:
        boxes: the grid.
        unknowns: which, in the order of the matrix.
    """

    def __init__(self, boxes: Boxes, unknowns: IntArray) -> None:
        count = boxes.nodes.shape[1]
        node = np.arange(count)
        index = np.stack(np.unravel_index(node, [n + 1 for n in boxes.shape]))
        step = np.stack(np.meshgrid(*[np.arange(-1, 2)] * 3, indexing="ij")).reshape(3, 27)
        there = index[:, :, None] + step[:, None, :]
        inside = np.all((there >= 0) & (there <= np.array(boxes.shape)[:, None, None]), axis=0)
        neighbour = node[:, None] + np.array(boxes.strides) @ step
        component = np.arange(3)
        shape = (count, 27, 3, 3)
        rows = np.broadcast_to(component[:, None] * count + node[:, None, None, None], shape)
        columns = np.broadcast_to(component * count + neighbour[:, :, None, None], shape)
        kept = np.broadcast_to(inside[:, :, None, None], shape)
        place = np.flatnonzero(kept.ravel())
        full = sp.coo_array((place + 1.0, (rows[kept], columns[kept])), shape=(3 * count, 3 * count)).tocsr()
        part = full[unknowns][:, unknowns]
        part.sort_indices()
        self._places = np.asarray(part.data).astype(np.int64) - 1  # exact: far fewer than 2^53
        self._columns, self._starts, self._shape = part.indices, part.indptr, part.shape

    def matrix(self, blocks: FloatArray) -> sp.csr_array:
        """Return the matrix of blocks, shape (nodes, 27, 3, 3)."""
        return sp.csr_array((blocks.ravel()[self._places], self._columns, self._starts), shape=self._shape)


def _at_rest(boxes: Boxes, springs: Springs) -> sp.csr_array:
    nothing = np.zeros(boxes.nodes.shape)
    return Pattern(boxes, np.arange(nothing.size)).matrix(_blocks(boxes, springs, nothing, energies.EXACT))


def _blocks(boxes: Boxes, springs: Springs, field: FloatArray, kind: int) -> FloatArray:
    rest, moved = np.ascontiguousarray(boxes.nodes.T), np.ascontiguousarray(field.T)
    blocks = np.zeros((len(rest), 27, 3, 3))
    edges, scissors, volumes = springs.edges, springs.scissors, springs.volumes
    energies.edge_stiffness(
        rest, moved, edges.ends, edges.code, edges.length, edges.stiffness, edges.tension, kind, blocks
    )
    energies.scissor_stiffness(rest, moved, scissors.corners, scissors.code, scissors.stiffness, kind, blocks)
    energies.volume_stiffness(moved, volumes.corners, volumes.sides, volumes.energy, kind, blocks)
    return blocks
