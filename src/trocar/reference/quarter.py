"""The equations of the quarter: matrices assembled once, one factorisation for every parity in use."""

from __future__ import annotations

from functools import cached_property
from typing import Generic

import numpy as np
import scipy.sparse as sp

from trocar.model import FloatArray, Support
from trocar.reference.block import held_by_support
from trocar.reference.branches import Branches
from trocar.reference.discretisation import Discretisation
from trocar.reference.grid import G, IntArray
from trocar.reference.ordering import dissection_order
from trocar.reference.parity import Parity, held_on_mirrors
from trocar.reference.solver import Factorisation, submatrix
from trocar.tissues import Tissue


class QuarterSystem(Generic[G]):
    """M u'' + C u' + K u + sum of G y = f on the quarter of a block; y are the branches' (see `branches`).

    Args:
        grid: the quarter's mesh.
        tissue: the layers.
        discretisation: what makes equations of them.
        support: how the block is held.
        solver: "superlu" or "pardiso".
    """

    def __init__(
        self,
        grid: G,
        tissue: Tissue,
        discretisation: Discretisation[G],
        support: Support,
        solver: str,
    ) -> None:
        self.grid = grid
        self._discretisation = discretisation
        self._tissue = tissue
        self._layers = tissue.layers
        self._solver = solver
        self.held = held_by_support(grid, support)
        self._free: dict[Parity, IntArray] = {}
        self._static: dict[Parity, Factorisation] = {}
        self._dynamic: dict[tuple[Parity, float], Factorisation] = {}
        self._creeping: dict[tuple[Parity, float], Factorisation] = {}

    @cached_property
    def stiffness(self) -> sp.csr_array:
        """K [N/m], prestress included."""
        return self._discretisation.stiffness(self.grid, self._layers)

    @cached_property
    def damping(self) -> sp.csr_array:
        """C [N s/m]."""
        return self._discretisation.damping(self.grid, self._layers)

    @cached_property
    def mass(self) -> sp.csr_array:
        """M [kg]."""
        return self._discretisation.mass(self.grid, self._layers)

    @cached_property
    def branches(self) -> Branches:
        """What the layers remember with."""
        times, layers = self._tissue.relaxation_times, self._layers
        return Branches(times, tuple(self._discretisation.branch(self.grid, layers, time) for time in times))

    @cached_property
    def _order(self) -> IntArray:
        nodes = dissection_order(self.grid)
        return (nodes[:, None] + len(nodes) * np.arange(3)).ravel()

    def free(self, parity: Parity) -> IntArray:
        """Return the unknowns of a parity in the order of their elimination."""
        if parity not in self._free:
            held = self.held | held_on_mirrors(self.grid, parity)
            self._free[parity] = self._order[~held.ravel()[self._order]]
        return self._free[parity]

    def equilibrium(self, parity: Parity, force: FloatArray) -> FloatArray:
        """Solve K u = f; force [N] and displacement [m] of shape (3, nodes)."""
        free = self.free(parity)
        if parity not in self._static:
            self._static[parity] = Factorisation(submatrix(self.stiffness, free), self._solver)
        return self._spread(self._static[parity].solve(force.ravel()[free]), free)

    def step(
        self,
        parity: Parity,
        displacement: FloatArray,
        velocity: FloatArray,
        memory: FloatArray,
        mean_force: FloatArray,
        dt: float,
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Advance by dt [s] with Newmark's average acceleration, in displacement and velocity alone.

            u1 - u0 = dt (v0 + v1) / 2
            M (v1 - v0) + dt C (v0 + v1) / 2 + dt K (u0 + u1) / 2 + dt G mean(y) = dt (f0 + f1) / 2

        Second order, stable for every dt, and without damping it keeps v M v / 2 + u K u / 2 (Newmark 1959;
        Hughes 1987, sec. 9.1). No acceleration is stored, so a load may jump between two steps. The branches' mean
        is that of u going straight from u0 to u1, so they never give more work than they took.

        Args:
            parity: of the part.
            displacement: at the start [m], shape (3, nodes).
            velocity: at the start [m/s], shape (3, nodes).
            memory: y at the start [m], shape (D, 3, nodes).
            mean_force: mean of the nodal forces at start and end [N], shape (3, nodes).
            dt: [s].

        Returns:
            Displacement, velocity and memory at the end.
        """
        free = self.free(parity)
        key = (parity, dt)
        remembers = len(memory) > 0
        if key not in self._dynamic:
            matrix = self.mass + 0.5 * dt * self.damping + 0.25 * dt**2 * self.stiffness
            if remembers:
                matrix = matrix + 0.5 * dt**2 * self.branches.on_average(dt)
            self._dynamic[key] = Factorisation(submatrix(matrix, free), self._solver)
        u, v, fields = displacement.ravel(), velocity.ravel(), memory.reshape(len(memory), displacement.size)
        force = mean_force.ravel() - self.damping @ v - self.stiffness @ (u + 0.5 * dt * v)
        if remembers:
            force -= self.branches.mean_force(fields, dt) + self.branches.on_average(dt) @ (dt * v)
        change = self._spread(self._dynamic[key].solve(dt * force[free]), free)
        moved = dt * (velocity + 0.5 * change)
        if remembers:
            memory = self.branches.advanced(fields, moved.ravel(), dt).reshape(memory.shape)
        return displacement + moved, velocity + change, memory

    def creep(
        self, parity: Parity, displacement: FloatArray, memory: FloatArray, force: FloatArray, dt: float
    ) -> tuple[FloatArray, FloatArray]:
        """Advance by dt [s] without inertia and damping, to equilibrium with a force at the end.

        Exact where the displacement is linear in time over the step; else second order.

        Args:
            parity: of the part.
            displacement: at the start [m], shape (3, nodes).
            memory: y at the start [m], shape (D, 3, nodes).
            force: nodal, at the end [N], shape (3, nodes).
            dt: [s].

        Returns:
            Displacement and memory at the end.
        """
        free, fields = self.free(parity), memory.reshape(len(memory), displacement.size)
        key = (parity, dt)
        if key not in self._creeping:
            matrix = self.stiffness + self.branches.at_end(dt) if len(memory) else self.stiffness
            self._creeping[key] = Factorisation(submatrix(matrix, free), self._solver)
        right = force.ravel() - self.stiffness @ displacement.ravel()
        if len(memory):
            right -= self.branches.force_at_end(fields, dt)
        moved = self._spread(self._creeping[key].solve(right[free]), free)
        return displacement + moved, self.branches.advanced(fields, moved.ravel(), dt).reshape(memory.shape)

    def _spread(self, values: FloatArray, free: IntArray) -> FloatArray:
        field = np.zeros(self.held.size)
        field[free] = values
        return field.reshape(self.held.shape)
