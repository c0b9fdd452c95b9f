"""The mesh-free model: a layered block by element-free Galerkin, static and in time, that can be cut and sewn.

    M u'' + C u' + internal forces(u) = f(t),    u(x) = sum over nodes of N_I(x) u_I

with moving least squares N_I (`shape`; T. Belytschko, Y. Y. Lu and L. Gu 1994, Int. J. Numer. Methods Eng. 37:229) on a
cloud of nodes (`cloud`), smoothed gradients (`patches`), and linear or neo-Hookean layers in the total Lagrangian form
(`stress`). Time is explicit by default (`explicit`).
"""

from __future__ import annotations

from dataclasses import replace
from enum import StrEnum
from functools import cached_property
from math import inf, isfinite

import numpy as np

from trocar.errors import InputError
from trocar.model import FloatArray, Load, Press, Support
from trocar.reference.arguments import central_press, check_step, checked_size, checked_support
from trocar.reference.block import MeshSize
from trocar.reference.mesh_free.body import Body
from trocar.reference.mesh_free.cloud import inherited, scatter
from trocar.reference.mesh_free.cut import Cut
from trocar.reference.mesh_free.explicit import advance, critical_step
from trocar.reference.mesh_free.implicit import AverageAcceleration
from trocar.reference.mesh_free.large import equilibrium
from trocar.reference.mesh_free.state import MeshFreeState
from trocar.reference.mesh_free.top_face import TopFace
from trocar.reference.parity import QUARTERS
from trocar.reference.solver import choose_solver
from trocar.reference.stress import Deformation
from trocar.tissues import Linear, NeoHookean, Tissue

_LEAST_RESOLUTION, _MOST_RESOLUTION = 0.4, 8.0
_LONGEST_STEP = 2.5e-4  # [s] of implicit time, as of the finite elements
_QUARTERS = len(QUARTERS)
_KEPT_PRESSES, _KEPT_STEPS = 16, 2


class Stepping(StrEnum):
    """How time is taken."""

    EXPLICIT = "explicit"  # central differences, within `critical_step`
    IMPLICIT = "implicit"  # average acceleration, of linear layers


class MeshFree:
    """Move a layered block by element-free Galerkin; a `TissueModel`.

    Args:
        tissue: the layers, all linear or all neo-Hookean, without a Prony series.
        size: sides a, b of the block [m].
        support: how the block is held, or its name.
        around: presses under whose footprints nodes lie close together; their forces do not matter. None: a 1/15 of
            the shorter side in the middle.
        resolution: nodes per length, relative to two along a footprint's half width [1]; the cost of an equilibrium
            grows with its fifth to sixth power, that of explicit time with its fourth.
        cuts: what is cut from the start.
        mirrored: solves a quarter of the block, for upright presses in its middle and no cuts.
        stepping: "explicit" or "implicit" time.
        massless: leaves inertia and damping out of `step`: every instant is an equilibrium.
        solver: "superlu", "pardiso" (Intel MKL, from the extra `trocar[pardiso]`) or "auto", the fastest installed.

    Raises:
        InputError: an argument is not possible.
    """

    def __init__(
        self,
        tissue: Tissue,
        *,
        size: tuple[float, float],
        support: Support | str,
        around: Load = (),
        resolution: float = 1.0,
        cuts: tuple[Cut, ...] = (),
        mirrored: bool = False,
        stepping: Stepping | str = Stepping.EXPLICIT,
        massless: bool = False,
        solver: str = "auto",
    ) -> None:
        _check_tissue(tissue)
        if not (isfinite(resolution) and _LEAST_RESOLUTION <= resolution <= _MOST_RESOLUTION):
            raise InputError(
                "resolution", f"a number from {_LEAST_RESOLUTION:g} to {_MOST_RESOLUTION:g}", resolution
            )
        if mirrored and cuts:
            raise InputError("mirrored", "a whole block where there are cuts", mirrored)
        self._stepping = _checked_stepping(stepping, tissue)
        self._size, self._support = checked_size(size), checked_support(support)
        self._massless, self._resolution, self._cuts = massless, resolution, tuple(cuts)
        self._around = around or central_press(self._size)
        cloud = scatter(
            tissue,
            self._size,
            self._support,
            self._around,
            _spacing(resolution),
            self._cuts,
            mirrored=mirrored,
        )
        self._body = Body(cloud, tissue, self._support, choose_solver(solver), mirrored)
        self._face = TopFace(self._body, self._size)
        self._responses: dict[Press, FloatArray] = {}
        self._equilibria: dict[Load, FloatArray] = {}
        self._steps: dict[float, AverageAcceleration] = {}

    @property
    def tissue(self) -> Tissue:
        """The layers."""
        return self._body.tissue

    @property
    def layer_names(self) -> tuple[str, ...]:
        """Names of the layers, top first."""
        return self.tissue.layer_names

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
        return self.tissue.large_deformation

    @property
    def cuts(self) -> tuple[Cut, ...]:
        """What is cut, in the order of cutting."""
        return self._cuts

    @property
    def nodes(self) -> FloatArray:
        """Places of the nodes at rest [m], shape (n, 3), those on cuts twice."""
        return self._body.cloud.places

    @property
    def dofs(self) -> int:
        """Components of nodes that may move."""
        return int((~self._body.held).sum())

    @property
    def longest_step(self) -> float:
        """Of implicit time a hundredth of a 40 Hz period [s]; else infinite: explicit time cuts steps itself."""
        return _LONGEST_STEP if self._stepping is Stepping.IMPLICIT and not self._massless else inf

    @cached_property
    def critical_step(self) -> float:
        """The longest stable step of explicit time near rest [s]."""
        return critical_step(self._body)

    def cut(self, cut: Cut) -> MeshFree:
        """Return this model with one more cut."""
        return self._with_cuts((*self._cuts, cut))

    def rejoin(self, cut: Cut) -> MeshFree:
        """Return this model with a cut sewn together, as if it had never been.

        Raises:
            InputError: there is no such cut.
        """
        if cut not in self._cuts:
            raise InputError("cut", "one of the model's cuts", cut)
        left = list(self._cuts)
        left.remove(cut)
        return self._with_cuts(tuple(left))

    def carried(self, state: MeshFreeState, of: MeshFree) -> MeshFreeState:
        """Return the state of a model that differs in cuts alone, as this model has it: a cut or a seam in mid motion.

        Args:
            state: of the other model.
            of: the other model.

        Raises:
            InputError: the models differ in more than cuts, or the state is not the other one's.
        """
        of._check_state(state)
        mine, other = self._body.cloud, of._body.cloud
        if not all(np.array_equal(here, there) for here, there in zip(mine[:3], other[:3], strict=True)):
            raise InputError(
                "of", "a model that differs in cuts alone", "one with other nodes", "use `cut` and `rejoin`"
            )
        displacement, velocity = (
            inherited(mine, other, field) for field in (state.displacement, state.velocity)
        )
        return MeshFreeState(time=state.time, displacement=displacement, velocity=velocity)

    def _with_cuts(self, cuts: tuple[Cut, ...]) -> MeshFree:
        return MeshFree(
            self.tissue,
            size=self._size,
            support=self._support,
            around=self._around,
            resolution=self._resolution,
            cuts=cuts,
            mirrored=self._body.mirrored,
            stepping=self._stepping,
            massless=self._massless,
            solver=self._body.solver,
        )

    def init(self) -> MeshFreeState:
        """Return the state at rest at time 0."""
        rest = np.zeros_like(self.nodes)
        return MeshFreeState(time=0.0, displacement=rest, velocity=rest)

    def static(self, load: Load) -> MeshFreeState:
        """Return the equilibrium under a constant load, at time 0.

        Raises:
            InputError: a footprint is not wholly on the block.
            SolverError: the equations could not be solved accurately, or the load was not reached.
        """
        found = np.zeros_like(self.nodes)
        if self.tissue.large_deformation:
            if load not in self._equilibria:
                if len(self._equilibria) >= _KEPT_PRESSES:
                    self._equilibria.pop(next(iter(self._equilibria)))
                self._equilibria[load] = equilibrium(self._body, self._forces(load))
            found = self._equilibria[load]
        else:
            for press in load:
                found = found + press.force * self._response(press.with_force(1.0))
        return MeshFreeState(time=0.0, displacement=found, velocity=np.zeros_like(found))

    def step(self, state: MeshFreeState, load0: Load, load1: Load, dt: float) -> MeshFreeState:
        """Advance by dt [s] under a load going linearly from load0 to load1.

        Raises:
            InputError: dt is not above 0, the loads hold unequally many presses, one is off the block, or the state is
                of a model with other cuts.
            SolverError: the step could not be taken.
        """
        check_step(load0, load1, dt)
        self._check_state(state)
        if self._massless:
            return replace(self.static(load1), time=state.time + dt)
        start, forces = (state.displacement, state.velocity), (self._forces(load0), self._forces(load1))
        if self._stepping is Stepping.IMPLICIT:
            if dt not in self._steps:
                if len(self._steps) >= _KEPT_STEPS:
                    self._steps.pop(next(iter(self._steps)))
                self._steps[dt] = AverageAcceleration(self._body, dt)
            displacement, velocity = self._steps[dt].advance(start, forces)
        else:
            displacement, velocity = advance(self._body, self.critical_step, start, forces, dt)
        return MeshFreeState(time=state.time + dt, displacement=displacement, velocity=velocity)

    def displacement(self, state: MeshFreeState, points: FloatArray, layer: str | None = None) -> FloatArray:
        """Return the displacement [m], shape (n, 3), of a layer's upper face (None: the top layer's).

        Args:
            state: of this model.
            points: rest positions [m], shape (n, 3); only x and y are used. In a cut, the mean of both faces.
            layer: name of the layer.

        Raises:
            InputError: a point is off the block, there is no such layer, or the state is of a model with other cuts.
        """
        self._check_state(state)
        number = self.tissue.index(layer)
        return self._face.interpolated(points, number, state.displacement)

    def reaction(self, state: MeshFreeState, load: Load = ()) -> FloatArray:
        """Return the force of the supports on the block [N], shape (3,), at an equilibrium under a load."""
        self._check_state(state)
        internal = self._body.internal(state.displacement, state.velocity)
        total = np.where(self._body.held, internal - self._forces(load), 0.0).sum(axis=0)
        return np.asarray(_QUARTERS * np.array([0, 0, total[2]]) if self._body.mirrored else total)

    def deformation(self, state: MeshFreeState) -> dict[str, Deformation]:
        """Return how far each layer is stretched and its volume changed, at the points of the quadrature."""
        self._check_state(state)
        return dict(zip(self.layer_names, self._body.deformations(state.displacement), strict=True))

    def _response(self, press: Press) -> FloatArray:
        if press not in self._responses:
            if len(self._responses) >= _KEPT_PRESSES:
                self._responses.pop(next(iter(self._responses)))
            right = self._forces((press,)).ravel()[self._body.free]
            self._responses[press] = self._body.spread(self._body.factors.solve(right))
        return self._responses[press]

    def _forces(self, load: Load) -> FloatArray:
        return self._face.forces(load)

    def _check_state(self, state: MeshFreeState) -> None:
        if state.displacement.shape != self.nodes.shape:
            raise InputError(
                "state",
                f"{len(self.nodes)} nodes, as this model has",
                f"{len(state.displacement)} nodes",
                "cutting and rejoining make another model: take the state over with `carried`",
            )


def _spacing(resolution: float) -> MeshSize:
    return MeshSize(
        per_radius=2.0 * resolution,
        growth=0.6 / resolution,
        top=0.4 / resolution,
        deepening=0.7 / resolution,
        side=0.4 / resolution,
    )


def _check_tissue(tissue: Tissue) -> None:
    if tissue.relaxation_times:
        raise InputError(
            "tissue: prony",
            "no series for the mesh-free model",
            tissue.name,
            "it damps by a loss factor alone; take the finite elements for layers that remember",
        )
    for layer in tissue.layers:
        if not isinstance(layer.law, Linear | NeoHookean):
            raise InputError(
                f"layer {layer.name!r}: law",
                "a linear or neo-Hookean law for the mesh-free model",
                type(layer.law).__name__,
                "take the finite elements for this one",
            )


def _checked_stepping(stepping: Stepping | str, tissue: Tissue) -> Stepping:
    try:
        chosen = Stepping(stepping)
    except ValueError:
        raise InputError("stepping", f"one of {', '.join(Stepping)}", stepping) from None
    if chosen is Stepping.IMPLICIT and tissue.large_deformation:
        raise InputError("stepping", "explicit time for neo-Hookean layers", str(chosen))
    return chosen
