"""`WaveMesh`: the finite-element modes of any mesh and support, and vectors of each press for those left out.

    M u'' + C u' + K u = f,   C = sum over materials of tau K_material,   u = B q

The basis B holds the lowest modes, K phi = omega^2 M phi, and for each press of force f the vectors

    v1 = K^-1 f,   v2 = K^-1 M v1,   v3 = K^-1 C v1,   and K^-1 M, K^-1 C of v2 and v3,

less what the modes hold of them. The first makes the static answer that of the whole mesh, whatever the number of
modes, and with the others the answer to slow forces is right to the second order of frequency and nearly so beyond
(Krylov vectors: Bai and Su 2005, SIAM J. Sci. Comput. 26:1692). What moves is then some seventy amplitudes, coupled by
B^T C B where materials damp differently; their first-order system is decoupled once (`decouple`); its step
is exact.
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
from trocar.waves.mesh.assembled import Assembled
from trocar.waves.mesh.basis_cache import BasisCache, fingerprint
from trocar.waves.mesh.elements import Elements
from trocar.waves.mesh.footprint import Approach, footprint_points, turn_to
from trocar.waves.mesh.solid_mesh import SolidMesh
from trocar.waves.oscillators import Oscillators
from trocar.waves.state import WaveState, require_step

MOST_MODES = 500
_REMEMBERED = 16  # presses whose vectors are kept, and sets of them whose basis is
_MOST_PRESSES = 8  # whose vectors a state holds; those that no longer press are left first
_GENERATIONS = 2  # of vectors: 1 + 2 + 4 of a press
STEEPEST = 0.259  # z of the normal where a tool still comes from above: 75 degrees
_NEW = 1e-5  # relative: a vector that is nearer to those before it says nothing new


@dataclass(frozen=True)
class MeshState(WaveState):
    """Where the amplitudes stand: one family, shape (1, n, 2), of the basis of `presses`.

    Attributes:
        presses: those of 1 N whose vectors are in the basis, the latest last.
    """

    presses: tuple[Press, ...] = ()


@dataclass(frozen=True, eq=False)
class _Basis:
    """The modes and the vectors of some presses.

    Attributes:
        own: vectors beside the modes [kg^-1/2], of unit mass and upright on them and on each other, (unknowns, k).
        oscillators: of all amplitudes, one group, from a force of 1 N of each press.
    """

    own: FloatArray
    oscillators: Oscillators


class WaveMesh:
    """Move a meshed tissue by its lowest modes; a `TissueModel`.

    Args:
        mesh: of the tissue.
        modes: how many are in the basis.
        approach: along what a tool without tilt comes to a surface that slopes; on a level one there is no difference.
        cache: where modes, and vectors of presses, are looked for and kept; None computes them.

    Raises:
        InputError: fewer modes than one, or more than the mesh has; no such approach; a material states a Prony
            series.
        SolverError: the mesh is not held, or its modes could not be found.
    """

    def __init__(
        self,
        mesh: SolidMesh,
        *,
        modes: int = 60,
        approach: Approach | str = Approach.NORMAL,
        cache: BasisCache | None = None,
    ) -> None:
        for material in mesh.materials:
            if material.prony:
                raise InputError(
                    f"layer {material.name!r}: prony",
                    "no series in a mesh: WaveMesh does not remember yet",
                    material.prony,
                    "take wave-solid, wave-membrane or fea for a block",
                )
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
        self._cache = cache
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
        squares, modes = self.kept(lambda: self.matrices.modes(self.modes), "modes")
        return squares, modes

    def kept(self, make: Callable[[], tuple[FloatArray, ...]], *names: object) -> tuple[FloatArray, ...]:
        """Return arrays that follow from this model and from what prints as names out of the cache, or make them."""
        if self._cache is None:
            return make()
        return self._cache.remembered(fingerprint(self.mesh, self.modes, self.approach, *names), make)

    @property
    def frequencies(self) -> FloatArray:
        """Frequencies of the modes that move, without damping [Hz], shape (r,)."""
        return np.asarray(np.sqrt(self.lowest[0]) / (2 * np.pi))

    def init(self) -> MeshState:
        """Return the state at rest at time 0."""
        return MeshState(0.0, (self._basis(()).oscillators.rest,))

    def static(self, load: Load) -> MeshState:
        """Return the equilibrium under a constant load.

        Raises:
            InputError: a footprint is not wholly on the surface.
        """
        presses = _units(load)
        held = self._basis(presses).oscillators.equilibrium(_forces(load, presses))
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
        amplitudes = self._carried(state, presses)
        moved = self._basis(presses).oscillators.step(
            amplitudes, _forces(load0, presses), _forces(load1, presses), dt
        )
        return MeshState(state.time + dt, (moved,), load1, presses)

    def _carried(self, state: MeshState, presses: tuple[Press, ...]) -> FloatArray:
        """Return a state's amplitudes in the basis of other presses."""
        if presses == state.presses:
            return state.oscillators[0]
        old, new = self._basis(state.presses), self._basis(presses)
        overlap = new.own.T @ (self.matrices.mass @ old.own)
        values = []
        for read in (old.oscillators.read, old.oscillators.read_rates):
            amplitudes = read(state.oscillators[0])[0]
            values += [amplitudes[: self.modes], overlap @ amplitudes[self.modes :]]
        return np.asarray(np.einsum("jsia,a->jsi", new.oscillators.entry, np.concatenate(values)))

    def oscillators(self, presses: Load) -> Oscillators:
        """Return what moves while these press: one group, from a force of 1 N of each to all amplitudes."""
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

    def field(self, state: MeshState) -> FloatArray:
        """Return the displacement of every node [m], shape (3, nodes)."""
        basis = self._basis(state.presses)
        amplitudes = basis.oscillators.read(state.oscillators[0])[0]
        total = self.lowest[1] @ amplitudes[: self.modes] + basis.own @ amplitudes[self.modes :]
        return np.asarray(total.reshape(3, -1))

    def nodal_forces(self, press: Press) -> FloatArray:
        """Return the forces of a press on every node [N], flattened from (3, nodes).

        Raises:
            InputError: the footprint is not wholly on the surface.
        """
        surface, force = self.layer_names[0], np.asarray(press.force_vector)
        points, share = footprint_points(press)
        if self.approach is Approach.NORMAL:
            normal = share @ self.elements.seen(surface, points)[1]
            normal /= np.linalg.norm(normal)
            if normal[2] < STEEPEST:
                raise InputError(
                    "press: x, y",
                    "a place where the surface looks up, at most 75 degrees from it",
                    f"{np.degrees(np.arccos(normal[2])):.0f} degrees at {1e3 * press.x:.4g}, {1e3 * press.y:.4g} mm",
                    "turn the mesh so that this side is above",
                )
            turn, centre = turn_to(normal), np.array([press.x, press.y])
            points, force = centre + (points - centre) @ turn[:2, :2].T, turn @ force
        nodes, weights = self.elements.at(surface, points)
        spread = np.bincount(nodes.ravel(), (weights * share).ravel(), minlength=self.elements.nodes.shape[1])
        return np.asarray(np.outer(force, spread)).ravel()

    def _vectors_of(self, press: Press) -> FloatArray:
        """Return the vectors of a press beside the modes, the static one first, shape (unknowns, k)."""
        return self.kept(lambda: (self._made_vectors(press),), press)[0]

    def _made_vectors(self, press: Press) -> FloatArray:
        found = [self._left_out(self.nodal_forces(press))]
        matrices = (
            (self.matrices.mass, self.matrices.damping)
            if self.matrices.damping.count_nonzero()
            else (self.matrices.mass,)
        )
        new = found
        for _ in range(_GENERATIONS):
            new = [self._left_out(matrix @ vector) for vector in new for matrix in matrices]
            found = found + new
        return np.stack(found, axis=1)

    def _basis_of(self, presses: tuple[Press, ...]) -> _Basis:
        squares, shapes = self.lowest
        own = np.zeros((len(shapes), 0))
        for place in range(
            1 + 2 * (2**_GENERATIONS - 1)
        ):  # the static vectors first: none of them may be lost
            for press in presses:
                vectors = self._vectors(press)
                if place < vectors.shape[1]:
                    own = _joined(own, vectors[:, place], self.matrices.mass)
        count = self.modes + own.shape[1]
        damping, stiffness = np.zeros((count, count)), np.diag(np.append(squares, np.zeros(own.shape[1])))
        lossy = self.matrices.damping @ np.concatenate([shapes, own], axis=1)
        damping[: self.modes] = shapes.T @ lossy
        damping[self.modes :] = own.T @ lossy
        beside = own.T @ (self.matrices.stiffness @ own)
        stiffness[self.modes :, self.modes :] = 0.5 * (beside + beside.T)
        forces = np.zeros((count, len(presses)))
        for number, press in enumerate(presses):
            nodal = self.nodal_forces(press)
            forces[: self.modes, number], forces[self.modes :, number] = shapes.T @ nodal, own.T @ nodal
        one = np.eye(count)[None]
        return _Basis(
            own, Oscillators.of(one, 0.5 * (damping + damping.T)[None], stiffness[None], forces[None], one)
        )

    def _left_out(self, forces: FloatArray) -> FloatArray:
        """Return the static answer of the modes that are not in the basis to nodal forces [N]."""
        squares, shapes = self.lowest
        return np.asarray(self.matrices.answer(forces) - shapes @ ((shapes.T @ forces) / squares))


def _units(load: Load) -> tuple[Press, ...]:
    """Return the distinct presses of a load, each of 1 N."""
    return tuple(dict.fromkeys(press.with_force(1.0) for press in load))


def _forces(load: Load, presses: tuple[Press, ...]) -> FloatArray:
    """Return the force [N] on each of the presses, shape (1, presses)."""
    total = np.zeros((1, len(presses)))
    for press in load:
        total[0, presses.index(press.with_force(1.0))] += press.force
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
