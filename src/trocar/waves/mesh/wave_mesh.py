"""`WaveMesh`: the finite-element modes of any mesh and support, and vectors of each press for those left out.

    M u'' + C u' + K u + branches = f,   C = sum over materials of tau K_material,   u = B q

The basis B holds the lowest modes, K phi = omega^2 M phi, and for each press of force f the vectors

    v1 = K^-1 f,   v2 = K^-1 M v1,   v3 = K^-1 C v1,   and K^-1 M, K^-1 C of v2 and v3,

less what the modes hold of them. The first makes the static answer that of the whole mesh, whatever the number of
modes, and with the others the answer to slow forces is right to the second order of frequency and nearly so beyond
(Krylov vectors: Bai and Su 2005, SIAM J. Sci. Comput. 26:1692). What moves is then some seventy amplitudes, coupled by
B^T C B where materials damp differently; their first-order system is decoupled once (`decouple`); its step
is exact.

Materials with a Prony series add branches, whose states join the amplitudes' (`memory`). Vibration is over before most
of them have relaxed, so K above is then the sudden stiffness. Where series differ between materials, the answers after
long and at up to three times between are vectors of each press too: static answers, at once and after long, stay those
of the whole mesh.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache
from math import inf

import numpy as np
import scipy.sparse as sp

from trocar.errors import InputError
from trocar.model import FloatArray, Load, Press, Support
from trocar.waves.decouple import symmetric
from trocar.waves.memory import Memory, between
from trocar.waves.mesh.assembled import Assembled
from trocar.waves.mesh.basis_cache import BasisCache, fingerprint
from trocar.waves.mesh.elements import Elements
from trocar.waves.mesh.footprint import Approach, laid
from trocar.waves.mesh.reduced import Reduced
from trocar.waves.mesh.solid_mesh import SolidMesh
from trocar.waves.oscillators import Oscillators
from trocar.waves.state import WaveState, require_step

MOST_MODES = 500
_REMEMBERED = 16  # presses whose vectors are kept, and sets of them whose basis is
_MOST_PRESSES = 8  # whose vectors a state holds; those that no longer press are left first
_GENERATIONS = 2  # of vectors: 1 + 2 + 4 of a press
_NEW = 1e-5  # relative: a vector that is nearer to those before it says nothing new


@dataclass(frozen=True)
class MeshState(WaveState):
    """Where the amplitudes stand: one family, shape (1, n, 2), of the basis of `presses`.

    Attributes:
        presses: those of 1 N whose vectors are in the basis, the latest last.
    """

    presses: tuple[Press, ...] = ()


class WaveMesh:
    """Move a meshed tissue by its lowest modes; a `TissueModel`.

    Args:
        mesh: of the tissue.
        modes: how many are in the basis.
        approach: along what a tool without tilt comes to a surface that slopes; on a level one there is no difference.
        cache: where modes, and vectors of presses, are looked for and kept; None computes them.
        massless: leaves inertia and Kelvin-Voigt damping out of `step`: what is left is creep.
        progress: told how many modes are found, and of how many, while they are.

    Raises:
        InputError: fewer modes than one, or more than the mesh has; no such approach; too many relaxation times.
        SolverError: the mesh is not held, or its modes could not be found.
    """

    def __init__(
        self,
        mesh: SolidMesh,
        *,
        modes: int = 60,
        approach: Approach | str = Approach.NORMAL,
        cache: BasisCache | None = None,
        massless: bool = False,
        progress: Callable[[int, int], None] | None = None,
    ) -> None:
        self.mesh = mesh
        self.elements = Elements(mesh)
        self.matrices = Assembled(self.elements)
        most = min(MOST_MODES, len(self.matrices.free) - 1)
        if not 1 <= modes <= most:
            raise InputError("modes", f"1 to {most}", modes)
        self.modes = modes
        if approach not in list(Approach):
            raise InputError("approach", f"one of {', '.join(Approach)}", approach)
        self.approach = Approach(approach)
        self.massless = massless
        self._cache = cache
        self._progress = progress
        self._vectors = lru_cache(maxsize=_REMEMBERED)(self._vectors_of)
        self._basis = lru_cache(maxsize=_REMEMBERED)(self._basis_of)

    @property
    def layer_names(self) -> tuple[str, ...]:
        """Names of the surfaces, the one that a tool touches first."""
        return tuple(self.mesh.surfaces)

    @property
    def size(self) -> tuple[float, float]:
        """Extent along x and y [m]."""
        return self.mesh.size

    @property
    def support(self) -> Support:
        """How it is held, in the words for blocks."""
        return self.mesh.support

    @property
    def dofs(self) -> int:
        """Displacements of nodes that are not held."""
        return len(self.matrices.free)

    @property
    def longest_step(self) -> float:
        """Infinite: the step is exact."""
        return inf

    @cached_property
    def lowest(self) -> tuple[FloatArray, FloatArray]:
        """Squared angular frequencies [1/s^2], ascending, and modes [kg^-1/2], shape (r,) and (unknowns, r)."""
        squares, modes = self.kept(lambda: self.matrices.modes(self.modes, progress=self._progress), "modes")
        return squares, modes

    def kept(self, make: Callable[[], tuple[FloatArray, ...]], *names: object) -> tuple[FloatArray, ...]:
        """Return arrays that follow from this model and from what prints as names out of the cache, or make them."""
        if self._cache is None:
            return make()
        return self._cache.remembered(fingerprint(self.mesh, self.modes, self.approach, *names), make)

    @property
    def frequencies(self) -> FloatArray:
        """Frequencies of the modes that move, without damping and as stiff as at once [Hz], shape (r,)."""
        return np.asarray(np.sqrt(self.lowest[0]) / (2 * np.pi))

    def init(self) -> MeshState:
        """Return the state at rest at time 0."""
        return MeshState(0.0, (self._basis(()).oscillators.rest,))

    def static(self, load: Load) -> MeshState:
        """Return the equilibrium under a constant load, held for ever.

        Raises:
            InputError: a footprint is not wholly on the surface.
        """
        presses = _units(load)
        basis = self._basis(presses)
        held = basis.oscillators.equilibrium(basis.inputs(_forces(load, presses)))
        return MeshState(0.0, (held,), load, presses)

    def step(self, state: MeshState, load0: Load, load1: Load, dt: float) -> MeshState:
        """Advance by dt [s], exactly for a load linear from load0 to load1.

        A press that no longer presses keeps its vectors while there is room for them.

        Raises:
            InputError: dt is not above 0, the loads hold different numbers of presses, or one is off the surface.
        """
        require_step(load0, load1, dt)
        now = _units((*load0, *load1))
        older = tuple(press for press in state.presses if press not in now)
        presses = state.presses
        if set(now) - set(presses) or len(presses) > _MOST_PRESSES:
            room = max(0, _MOST_PRESSES - len(now))
            presses = older[len(older) - room :] + now if room < len(older) else older + now
        basis = self._basis(presses)
        start, end = (basis.inputs(_forces(load, presses)) for load in (load0, load1))
        moved = basis.oscillators.step(self._carried(state, presses), start, end, dt)
        return MeshState(state.time + dt, (moved,), load1, presses)

    def _carried(self, state: MeshState, presses: tuple[Press, ...]) -> FloatArray:
        """Return a state's amplitudes in the basis of other presses."""
        if presses == state.presses:
            return state.oscillators[0]
        old, new = self._basis(state.presses), self._basis(presses)
        return new.carried(old, state.oscillators[0], new.own.T @ (self.matrices.mass @ old.own))

    def oscillators(self, presses: Load) -> Oscillators:
        """Return what moves while these press: one group, from a force of 1 N of each to all amplitudes.

        Without inertia the forces are those on every amplitude.
        """
        return self._basis(_units(presses)).oscillators

    def displacement(self, state: MeshState, points: FloatArray, layer: str | None = None) -> FloatArray:
        """Return the displacement [m] of a surface at points [m]; both of shape (n, 3).

        Raises:
            InputError: there is no such surface, or a point is beside it.
        """
        name = self.layer_names[0] if layer is None else layer
        if name not in self.mesh.surfaces:
            raise InputError("layer", f"one of {', '.join(self.layer_names)}", layer)
        nodes, weights = self.elements.at(name, points)
        field = self.field(state)
        return np.asarray(np.einsum("ckn,kn->nc", field[:, nodes], weights))

    def along_normal(self, state: MeshState, points: FloatArray, surface: str) -> FloatArray:
        """Return how far a surface moves out at points, along its normals at rest [m], shape (n,).

        Args:
            state: of this model.
            points: only x and y are used [m], shape (n, 3).
            surface: its name.

        Raises:
            InputError: there is no such surface, or a point is beside it.
        """
        moved = self.displacement(state, points, surface)
        return np.asarray(np.einsum("nc,nc->n", moved, self.elements.seen(surface, points)[1]))

    def field(self, state: MeshState) -> FloatArray:
        """Return the displacement of every node [m], shape (3, nodes)."""
        basis = self._basis(state.presses)
        amplitudes = basis.amplitudes(state.oscillators[0], _forces(state.load, state.presses))
        total = self.lowest[1] @ amplitudes[: self.modes] + basis.own @ amplitudes[self.modes :]
        return np.asarray(total.reshape(3, -1))

    def nodal_forces(self, press: Press) -> FloatArray:
        """Return the forces of a press on every node [N], flattened from (3, nodes).

        Raises:
            InputError: the footprint is not wholly on the surface, or the surface is too steep there.
        """
        nodes, shares, force = laid(press, self.elements, self.layer_names[0], self.approach)
        spread = np.bincount(nodes.ravel(), shares.ravel(), minlength=self.elements.nodes.shape[1])
        return np.asarray(np.outer(force, spread)).ravel()

    def _vectors_of(self, press: Press) -> FloatArray:
        """Return the vectors of a press beside the modes, the static one first, shape (unknowns, k)."""
        return self.kept(lambda: (self._made_vectors(press),), press)[0]

    def _made_vectors(self, press: Press) -> FloatArray:
        forces = self.nodal_forces(press)
        matrices = (
            (self.matrices.mass, self.matrices.damping)
            if self.matrices.damping.count_nonzero()
            else (self.matrices.mass,)
        )
        new = [self._left_out(forces)]
        late = self._delayed(forces)
        found = late[:1] + new + late[1:]
        for _ in range(_GENERATIONS):
            new = [self._left_out(matrix @ vector) for vector in new for matrix in matrices]
            found = found + new
        return np.stack(found, axis=1)

    def _delayed(self, forces: FloatArray) -> list[FloatArray]:
        """Return what modes leave out of the answers after long and later than at once, where their shapes differ."""
        if not self.matrices.changes_shape:
            return []
        times, found = self.matrices.times, []
        for shares in (np.zeros(len(times)), *between(times)):
            vector = self.matrices.delayed_answer(forces, shares)
            for _ in range(2):
                vector = vector - self.lowest[1] @ (self.lowest[1].T @ (self.matrices.mass @ vector))
            found.append(vector)
        return found

    def _basis_of(self, presses: tuple[Press, ...]) -> Reduced:
        squares, shapes = self.lowest
        vectors, own = [self._vectors(press) for press in presses], np.zeros((len(shapes), 0))
        for place in range(max((each.shape[1] for each in vectors), default=0)):
            for each in vectors:  # what is after long, or at once, of all first: none of it may be lost
                if place < each.shape[1]:
                    own = _joined(own, each[:, place], self.matrices.mass)
        basis = np.concatenate([shapes, own], axis=1)
        nodal = np.stack([np.zeros(len(shapes)), *(self.nodal_forces(press) for press in presses)])[1:]
        sudden = np.diag(np.append(squares, np.zeros(own.shape[1])))
        sudden[self.modes :, self.modes :] = symmetric(own.T @ (self.matrices.sudden @ own))
        stiffness, memory = self._relaxing(basis, sudden)
        return Reduced(
            own,
            damping=symmetric(basis.T @ (self.matrices.damping @ basis)),
            stiffness=stiffness,
            forcing=basis.T @ nodal.T,
            memory=memory,
            massless=self.massless,
        )

    def _relaxing(self, basis: FloatArray, sudden: FloatArray) -> tuple[FloatArray, Memory | None]:
        """Return the long-term stiffness in a basis, and what remembers beside it."""
        matrices = self.matrices
        if len(matrices.times) == 0:
            return sudden, None
        if matrices.changes_shape:
            stiffness = symmetric(basis.T @ (matrices.stiffness @ basis))
            branches = np.array([basis.T @ (branch @ basis) for branch in matrices.branches])
        else:
            stiffness = sudden / matrices.stiffening
            branches = matrices.weights[:, 0, None, None] * stiffness
        return stiffness, Memory(matrices.times, symmetric(branches)[:, None])

    def _left_out(self, forces: FloatArray) -> FloatArray:
        """Return the answer at once of the modes that are not in the basis to nodal forces [N]."""
        squares, shapes = self.lowest
        return np.asarray(self.matrices.answer(forces) - shapes @ ((shapes.T @ forces) / squares))


def _units(load: Load) -> tuple[Press, ...]:
    """Return the distinct presses of a load, each of 1 N."""
    return tuple(dict.fromkeys(press.with_force(1.0) for press in load))


def _forces(load: Load, presses: tuple[Press, ...]) -> FloatArray:
    """Return the force [N] on each of the presses, shape (presses,)."""
    total = np.zeros(len(presses))
    for press in load:
        total[presses.index(press.with_force(1.0))] += press.force
    return total


def _joined(basis: FloatArray, vector: FloatArray, mass: sp.csr_array) -> FloatArray:
    """Return a basis of unit masses with one more vector, made upright on it twice; without, where it is in it."""
    before = np.sqrt(vector @ (mass @ vector))
    if before == 0:
        return basis
    for _ in range(2):
        vector = vector - basis @ (basis.T @ (mass @ vector))
    after = np.sqrt(vector @ (mass @ vector))
    if after <= _NEW * before:
        return basis
    return np.concatenate([basis, (vector / after)[:, None]], axis=1)
