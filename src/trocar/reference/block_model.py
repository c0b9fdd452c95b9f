"""What models of a block have in common, whatever turns its grid into equations.

    M u'' + C u' + K u + sum over branches G y = f(t),    C = sum over layers of tau K_layer

(Prony series: `branches`), a quarter of the block at a time (`parity`), or where it deforms much the part that the
load needs (`large`, `moving`): layers perfectly bonded, dead traction.
"""

from __future__ import annotations

from dataclasses import replace
from math import inf
from typing import Generic

import numpy as np

from trocar.model import FloatArray, Load, Support
from trocar.reference.arguments import check_step
from trocar.reference.discretisation import Discretisation
from trocar.reference.domain import wholes
from trocar.reference.forces import NodalForces
from trocar.reference.grid import G
from trocar.reference.large import LargeDeformation
from trocar.reference.parity import QUARTERS, Parity, fold, mirror_signs, quarter_fields
from trocar.reference.quarter import QuarterSystem
from trocar.reference.solver import choose_solver
from trocar.reference.state import FEAState
from trocar.tissues import Tissue

_CACHED_RESPONSES = 16  # responses kept; each is a few arrays the size of the mesh
_POINTS_PER_ELEMENT = (
    6  # along an edge, where the largest deflection is looked for: it is missed by 2e-4 at most
)
_LONGEST_STEP = 2.5e-4  # [s]


class BlockModel(Generic[G]):
    """Move a layered block on a grid of its first quarter; abstract: a model says what its equations are.

    Args:
        tissue: the layers.
        grid: of the quarter 0 <= x <= a/2, 0 <= y <= b/2.
        discretisation: what makes equations of it.
        size: sides a, b of the block [m].
        support: how the block is held.
        around: presses the grid is made for.
        solver: "superlu", "pardiso" or "auto".
        massless: leaves inertia and Kelvin-Voigt damping out of `step`: what is left is creep.
        large: whether large deformation is followed.

    Raises:
        InputError: there is no such solver.
    """

    def __init__(
        self,
        tissue: Tissue,
        grid: G,
        discretisation: Discretisation[G],
        *,
        size: tuple[float, float],
        support: Support,
        around: Load,
        solver: str,
        massless: bool,
        large: bool,
    ) -> None:
        self._tissue = tissue
        self._grid = grid
        self._massless = massless
        self._size = size
        self._support = support
        self.solver_name = choose_solver(solver)
        self._system = QuarterSystem(grid, tissue, discretisation, support, self.solver_name)
        self._nodal_forces = NodalForces(grid, size)
        self._parities = set(self._forces(tuple(press.with_force(1.0) for press in around)))
        self._responses: dict[Load, dict[Parity, FloatArray]] = {}
        self._large = (
            LargeDeformation(grid, tissue, discretisation, size, support, self.solver_name) if large else None
        )
        if self._large:
            self._large.part(wholes(self._parities))

    @property
    def tissue(self) -> Tissue:
        """The layers."""
        return self._tissue

    @property
    def layer_names(self) -> tuple[str, ...]:
        """Names of the layers, top first."""
        return self._tissue.layer_names

    @property
    def size(self) -> tuple[float, float]:
        """Sides a, b of the block along x and y [m]."""
        return self._size

    @property
    def support(self) -> Support:
        """How the block is held."""
        return self._support

    @property
    def large_deformation(self) -> bool:
        """Whether the layers' laws are followed to large strain."""
        return self._large is not None

    @property
    def dofs(self) -> int:
        """Unknowns of the quarter, added over the parities used by `around` and by the loads so far.

        Under large deformation: of the quarter, half or block that these need.
        """
        if self._large:
            return self._large.dofs
        return sum(len(self._system.free(parity)) for parity in self._parities)

    @property
    def longest_step(self) -> float:
        """A hundredth of a 40 Hz period [s]: average acceleration then loses 0.03 % of its phase.

        Without inertia a quarter of the shortest relaxation time, or infinite where there is none.
        """
        if self._massless:
            return min(self._tissue.relaxation_times, default=inf) / 4
        return _LONGEST_STEP

    def init(self) -> FEAState:
        """Return the state at rest at time 0."""
        return FEAState(time=0.0, displacement={}, velocity={})

    def static(self, load: Load) -> FEAState:
        """Return the equilibrium under a constant load, at time 0.

        The response to a load is kept, so a history of one load growing and falling costs one solve. Under large
        deformation equilibria are kept and a larger load starts from a smaller one, which changes the answer by what
        Newton's method leaves: 1e-10 of the load, or what rounding leaves, below 1e-7.

        Raises:
            InputError: a footprint is not wholly on the block.
            SolverError: the equations could not be solved accurately, or the load was not reached.
        """
        largest = max((abs(press.force) for press in load), default=0.0)
        if largest == 0.0:
            return self.init()
        direction = tuple(press.with_force(press.force / largest) for press in load)
        if self._large:
            found = self._large.static(direction, self._forces(direction), largest)
            return FEAState(time=0.0, displacement=found, velocity={})
        response = self._response(direction)
        parts = {parity: largest * part for parity, part in response.items()}
        return FEAState(time=0.0, displacement=parts, velocity={})

    def step(self, state: FEAState, load0: Load, load1: Load, dt: float) -> FEAState:
        """Advance by dt [s] under a load going linearly from load0 to load1.

        Newmark's average acceleration: second order, stable for every dt, no numerical damping. The
        factorisation is kept for each dt. Under large deformation the step keeps the energy likewise (`moving`).

        Raises:
            InputError: dt is not above 0, the loads hold unequally many presses, or one is off the block.
            SolverError: the equations could not be solved accurately.
        """
        check_step(load0, load1, dt)
        force0, force1 = self._forces(load0), self._forces(load1)
        if self._large and self._massless:  # without memory, every instant is an equilibrium
            return replace(self.static(load1), time=state.time + dt)
        if self._large:
            return self._large.step(state, (force0, force1), dt)
        parities = {*state.displacement, *state.velocity, *force0, *force1}
        rest = np.zeros(self._grid.nodes.shape)
        relaxed = np.zeros((len(self._tissue.relaxation_times), *rest.shape))
        displacement, velocity, memory = {}, {}, {}
        for parity in parities:
            start = state.displacement.get(parity, rest), state.memory.get(parity, relaxed)
            first, last = force0.get(parity, rest), force1.get(parity, rest)
            if self._massless:
                displacement[parity], memory[parity] = self._system.creep(parity, *start, last, dt)
                continue
            displacement[parity], velocity[parity], memory[parity] = self._system.step(
                parity, start[0], state.velocity.get(parity, rest), start[1], 0.5 * (first + last), dt
            )
        self._parities |= parities
        return FEAState(
            time=state.time + dt,
            displacement=displacement,
            velocity=velocity,
            memory=memory if relaxed.size else {},
        )

    def displacement(self, state: FEAState, points: FloatArray, layer: str | None = None) -> FloatArray:
        """Return the displacement [m], shape (n, 3), of a layer's upper face (None: the top layer's).

        Args:
            state: of this model.
            points: rest positions [m], shape (n, 3); only x and y are used.
            layer: name of the layer.

        Raises:
            InputError: a point is off the block, or there is no such layer.
        """
        line = self._grid.upper_face(self._tissue.index(layer))
        folded, mirrored = fold(points, self._size)
        nodes, weights = self._grid.interpolation(folded, line)
        total = np.zeros((3, len(folded)))
        for parity, field in state.displacement.items():
            total += mirror_signs(parity, mirrored) * np.einsum("can,an->cn", field[:, nodes], weights)
        return total.T

    def reaction(self, state: FEAState, load: Load = ()) -> FloatArray:
        """Return the force of the supports on the block [N], shape (3,).

        Args:
            state: of this model; of a moving one, the inertia of the held nodes is left out.
            load: the load at that time; it matters only where a footprint reaches into an element at a held
                side, whose nodes then carry some of it straight to the support.
        """
        system, forces, total = self._system, self._forces(load), np.zeros(3)
        if self._large:
            return self._large.reaction(state, forces)
        every_quarter = np.array(QUARTERS)
        for parity in {*state.displacement, *forces}:
            flat = np.zeros(system.held.size)
            if parity in state.displacement:
                flat += system.stiffness @ state.displacement[parity].ravel()
            if parity in state.velocity:
                flat += system.damping @ state.velocity[parity].ravel()
            if parity in state.memory:
                flat += system.branches.force(state.memory[parity].reshape(-1, flat.size))
            if parity in forces:
                flat -= forces[parity].ravel()
            nodal = np.where(system.held, flat.reshape(system.held.shape), 0.0)
            total += mirror_signs(parity, every_quarter).sum(axis=1) * nodal.sum(axis=1)
        return total

    def largest_deflection(self, state: FEAState) -> dict[str, float]:
        """Return the largest deflection [m] of each layer's upper face, over the block; at least 0."""
        fine_x, fine_y = (_subdivided(lines) for lines in (self._grid.x, self._grid.y))
        points = np.stack(np.meshgrid(fine_x, fine_y, indexing="ij"), axis=-1).reshape(-1, 2)
        quarters = self._quarters(state)
        largest = {}
        for number, name in enumerate(self._tissue.layer_names):
            nodes, weights = self._grid.interpolation(points, self._grid.upper_face(number))
            largest[name] = max(
                0.0, *(-float((field[2, nodes] * weights).sum(axis=0).min()) for field in quarters)
            )
        return largest

    def _quarters(self, state: FEAState) -> list[FloatArray]:
        return quarter_fields(state.displacement, self._grid.nodes.shape)

    def _response(self, load: Load) -> dict[Parity, FloatArray]:
        if load not in self._responses:
            forces = self._forces(load)
            response = {parity: self._system.equilibrium(parity, force) for parity, force in forces.items()}
            self._parities |= set(response)
            if len(self._responses) >= _CACHED_RESPONSES:
                self._responses.pop(next(iter(self._responses)))
            self._responses[load] = response
        return self._responses[load]

    def _forces(self, load: Load) -> dict[Parity, FloatArray]:
        return self._nodal_forces.of(load)


def _subdivided(lines: FloatArray) -> FloatArray:
    """Put points between grid lines, so that the largest deflection between two nodes is not missed."""
    part = np.arange(_POINTS_PER_ELEMENT) / _POINTS_PER_ELEMENT
    return np.append((lines[:-1, None] + part * np.diff(lines)[:, None]).ravel(), lines[-1])
