"""Equilibria of a block under large deformation: the load grows from rest in steps, each brought into balance.

Loads are dead: they keep direction and place on the body at rest. The prestress is in balance at rest with tractions
on the sides of the block, which stay as they are. Where Newton's method fails at a step the step is halved; what was
reached when that no longer helps is in the error.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Generic

import numpy as np

from trocar.errors import SolverError
from trocar.model import FloatArray, Load, Support
from trocar.reference.discretisation import Discretisation
from trocar.reference.domain import Domain, wholes
from trocar.reference.grid import G
from trocar.reference.moving import advance, rest_factors
from trocar.reference.newton import TOLERANCE, Balanced, Directions, NewtonError, balance
from trocar.reference.parity import Parity
from trocar.reference.part import Part, Static
from trocar.reference.solver import Factorisation
from trocar.reference.state import FEAState
from trocar.tissues import Tissue

_ON_THE_WAY = 1e-4  # of the load, the imbalance left in the steps that lead to it
_FIRST_STEP = (
    0.1  # of the block's thickness, the deflection that the linear answer may have in the first step
)
_EASY, _HARD = 5, 9  # iterations below which steps grow, above which they shrink
_GROWTH = 1.8
_KEPT_LOADS, _KEPT_SIZES, _KEPT_STEPS = 4, 16, 2
_SMALLEST_STEP = 1e-3  # of the first: where smaller ones would be needed, no equilibrium is near


class LargeDeformation(Generic[G]):
    """A block that deforms much.

    Args:
        quarter: the quarter's mesh.
        tissue: the layers.
        discretisation: what makes equations of them.
        size: sides of the block [m].
        support: how it is held.
        solver: "superlu" or "pardiso".
    """

    def __init__(
        self,
        quarter: G,
        tissue: Tissue,
        discretisation: Discretisation[G],
        size: tuple[float, float],
        support: Support,
        solver: str,
    ) -> None:
        self._discretisation = discretisation
        self._quarter, self._tissue, self._size, self._support = quarter, tissue, size, support
        self._solver = solver
        self._parts: dict[tuple[bool, bool], Part[G]] = {}
        self._known: dict[Load, dict[float, Mapping[Parity, FloatArray]]] = {}
        self._steps: dict[tuple[tuple[bool, bool], float], Factorisation] = {}

    @property
    def dofs(self) -> int:
        """Unknowns of the parts solved so far."""
        return sum(len(part.domain.free) for part in self._parts.values())

    def part(self, whole: tuple[bool, bool]) -> Part[G]:
        """Return the part that is whole along these axes."""
        if whole not in self._parts:
            domain = Domain(self._quarter, self._size, whole, self._support)
            self._parts[whole] = Part(domain, self._tissue, self._discretisation, self._solver)
        return self._parts[whole]

    def static(
        self, direction: Load, unit: Mapping[Parity, FloatArray], size: float
    ) -> Mapping[Parity, FloatArray]:
        """Return the displacement [m] under a load, by parity.

        Equilibria are kept; a larger load in the same direction starts from the one before.

        Args:
            direction: the load, its largest press of 1 N.
            unit: its nodal forces on the quarter [N], by parity.
            size: of the largest press [N], above 0.

        Raises:
            SolverError: as `equilibrium`.
        """
        if direction not in self._known and len(self._known) >= _KEPT_LOADS:
            self._known.pop(next(iter(self._known)))
        known = self._known.setdefault(direction, {})
        if size not in known:
            below = max((kept for kept in known if kept < size), default=0.0)
            found = self.equilibrium(wholes(unit), unit, size, (below, known.get(below, {})))
            if len(known) >= _KEPT_SIZES:
                known.pop(next(iter(known)))
            known[size] = found
        return known[size]

    def step(self, state: FEAState, forces: tuple[Mapping[Parity, FloatArray], ...], dt: float) -> FEAState:
        """Advance by dt [s].

        Args:
            state: at the start.
            forces: nodal forces of the quarter [N] at start and end, by parity.
            dt: [s].

        Raises:
            SolverError: the step could not be taken.
        """
        whole = wholes({*state.displacement, *state.velocity, *forces[0], *forces[1]})
        part = self.part(whole)
        if (whole, dt) not in self._steps:
            if len(self._steps) >= _KEPT_STEPS:
                self._steps.pop(next(iter(self._steps)))
            self._steps[whole, dt] = rest_factors(part, dt)
        ends = advance(
            part,
            (
                part.freed(part.domain.field(state.displacement)),
                part.freed(part.domain.field(state.velocity)),
            ),
            (part.freed(part.domain.forces(forces[0])), part.freed(part.domain.forces(forces[1]))),
            dt,
            self._steps[whole, dt],
        )
        displacement, velocity = (part.domain.parts(part.spread(end)) for end in ends)
        return FEAState(time=state.time + dt, displacement=displacement, velocity=velocity)

    def reaction(self, state: FEAState, forces: Mapping[Parity, FloatArray]) -> FloatArray:
        """Return the force of the support on the block [N], shape (3,); `forces` as in `step`, at that time."""
        whole = wholes({*state.displacement, *state.velocity, *forces})
        part = self.part(whole)
        domain = part.domain
        field = domain.field(state.displacement)
        nodal = part.internal(field) - domain.forces(forces)
        if state.velocity and any(layer.retardation_time for layer in self._tissue.layers):
            nodal += part.deformed.viscous_forces(field, domain.field(state.velocity))
        total = np.where(domain.supported, nodal, 0.0).sum(axis=1)
        mirrored_away = [not whole[0], not whole[1], False]  # mirror images push against each other
        return np.where(mirrored_away, 0.0, domain.copies * total)

    def equilibrium(
        self,
        whole: tuple[bool, bool],
        unit: Mapping[Parity, FloatArray],
        size: float,
        known: tuple[float, Mapping[Parity, FloatArray]] = (0.0, {}),
    ) -> dict[Parity, FloatArray]:
        """Return the displacement [m] under `size` times a load, by parity.

        Args:
            whole: along which axes both halves are solved.
            unit: nodal forces of the quarter [N], by parity, of a load whose largest press has 1 N.
            size: of the largest press [N], above 0.
            known: an equilibrium to start from: a smaller size and its displacement; rest by default.

        Raises:
            SolverError: the load was not reached; it says where, why and how far.
        """
        part = self.part(whole)
        force = part.freed(part.domain.forces(unit))
        norm = float(np.linalg.norm(force))
        reached, unknowns = known[0], part.freed(part.domain.field(known[1]))
        directions = Directions(part.solver, part.rest_factors)
        before: tuple[float, FloatArray] | None = None
        step, cuts = self._first_step(part, unknowns, force, directions, size - reached), 0
        smallest = _SMALLEST_STEP * step
        while reached != size:
            aim = size if size - reached <= 1.001 * step else reached + step
            guess = unknowns
            if before is not None:
                guess = unknowns + (aim - reached) / (reached - before[0]) * (unknowns - before[1])
            tolerance = TOLERANCE if aim == size else _ON_THE_WAY
            try:
                found = _from_either(part, aim * force, guess, unknowns, aim * norm, tolerance, directions)
            except NewtonError as error:
                cuts, step, before = cuts + 1, 0.5 * (aim - reached), None
                if step < smallest:
                    raise SolverError(
                        f"large deformation: reached {reached:.4g} of {size:.4g} N and no more, after halving the step "
                        f"{cuts} times: {part.why(error, part.spread(unknowns))}; "
                        "take less force, a wider tool or a law that stiffens more"
                    ) from error
                continue
            before, reached, unknowns = (reached, unknowns), aim, found.unknowns
            taken = len(found.imbalances) - 1
            step = (aim - before[0]) * (_GROWTH if taken < _EASY else 0.6 if taken > _HARD else 1.0)
        return part.domain.parts(part.spread(unknowns))

    def _first_step(
        self,
        part: Part[Any],
        unknowns: FloatArray,
        force: FloatArray,
        directions: Directions,
        distance: float,
    ) -> float:
        """Return the force [N] for which the linear answer, from here on, is a tenth of the thickness."""
        slope = directions.solve(Static(part, force).tangent(unknowns), force)
        deflection = float(np.abs(slope).max())
        longest = _FIRST_STEP * self._tissue.thickness / deflection
        return min(distance, longest)


def _from_either(
    part: Part[Any],
    force: FloatArray,
    guess: FloatArray,
    last: FloatArray,
    scale: float,
    tolerance: float,
    directions: Directions,
) -> Balanced:
    """Bring a load into balance from an extrapolated guess, or where that fails from the last solution."""
    equations = Static(part, force)
    if guess is not last:
        try:
            return balance(equations, guess, scale=scale, tolerance=tolerance, directions=directions)
        except NewtonError:
            pass
    return balance(equations, last, scale=scale, tolerance=tolerance, directions=directions)
