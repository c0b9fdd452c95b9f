"""WaveSolid: linear elastic waves in a layered block, by thin layers through the thickness.

Across the block the series of `series` diagonalise the problem exactly where the sides are simply supported, so what
is left per wavenumber is a small banded system (see `thin_layer`). Two nested sets of wavenumbers serve it: all of
them follow the load statically (`banded`), and the lower ones besides carry oscillators (`ritz`), whose static part
is exact. Where the sides are clamped (`edges`, `edges+base`), tractions on them undo what the series leaves free there
(`clamped`): exact for a static answer, while in motion the clamps act at once. Where layers remember (a Prony series),
the wavenumbers that carry no oscillators creep (`creep`): they follow the load without inertia, but not at once. With
`massless` all of them do.
"""

from __future__ import annotations

from functools import cached_property, lru_cache, partial
from math import inf

import numpy as np

from trocar.errors import InputError
from trocar.model import FloatArray, Load, Press, Support
from trocar.tissues.tissue import Tissue
from trocar.waves.banded import surface_compliance
from trocar.waves.clamped import SIDE_MODES, ClampedSides
from trocar.waves.creep import Creep, creep_of
from trocar.waves.near_field import layered_compliance
from trocar.waves.oscillators import Oscillators
from trocar.waves.polarised import audible, distinct, polarised, turned_to_axes
from trocar.waves.ritz import creeping_oscillators, ritz_oscillators
from trocar.waves.series import Series
from trocar.waves.state import WaveState, require_step
from trocar.waves.thin_layer import ThinLayers, horizontal_shear, vertical_and_along


class WaveSolid:
    """A layered elastic block.

    Args:
        tissue: the layers.
        size: sides a, b [m].
        support: how the block is held.
        modes: highest m and n of the static series.
        dynamic_modes: highest m and n that move with inertia and damping; the others follow at once.
        side_modes: highest m and n that resolve clamped sides.
        order: how many Ritz vectors per direction each moving wavenumber has.
        refinement: cuts every thin layer into this many.
        massless: leaves inertia and Kelvin-Voigt damping out of `step`: what is left is creep.

    Raises:
        InputError: a size or mode count is impossible, or layers remember where sides are clamped.
    """

    def __init__(
        self,
        tissue: Tissue,
        *,
        size: tuple[float, float],
        support: Support | str = Support.BASE,
        modes: tuple[int, int] = (128, 128),
        dynamic_modes: tuple[int, int] = (32, 32),
        side_modes: tuple[int, int] = SIDE_MODES,
        order: int = 3,
        refinement: int = 1,
        massless: bool = False,
    ) -> None:
        self.tissue = tissue
        self.size = size
        self.support = Support(support)
        if tissue.relaxation_times and self.support.sides_clamped:
            raise InputError(
                "prony",
                "no Prony series where sides are clamped, which WaveSolid cannot yet take",
                self.support.value,
                'use support "base", WaveMesh or the fitted membrane',
            )
        self.layer_names = tissue.layer_names
        self._series = Series(size, modes)
        self.massless = massless
        self._moving = Series(size, (min(modes[0], dynamic_modes[0]), min(modes[1], dynamic_modes[1])))
        self._clamps = Series(size, (min(modes[0], side_modes[0]), min(modes[1], side_modes[1])))
        self._order = order
        self._refinement = refinement
        shape = self._series.kx.size, self._series.ky.size, len(tissue.layers)
        self._compliance_wv = np.full((*shape, 2, 2), np.nan)
        self._compliance_s = np.full((*shape, 1, 1), np.nan)
        self._unit_response = lru_cache(maxsize=8)(self._response_to_unit_press)
        self._unit_polarised = lru_cache(maxsize=16)(lambda press: polarised(press, self._moving))
        self._unit_tractions = lru_cache(maxsize=8)(lambda press: np.stack(polarised(press, self._series)))

    @cached_property
    def _layers_wv(self) -> ThinLayers:
        return vertical_and_along(self.tissue, base_held=self.support.base_held, refinement=self._refinement)

    @cached_property
    def _layers_s(self) -> ThinLayers:
        return horizontal_shear(self.tissue, base_held=self.support.base_held, refinement=self._refinement)

    @cached_property
    def _sides(self) -> ClampedSides | None:
        return (
            ClampedSides(self._layers_wv, self._layers_s, self._clamps)
            if self.support.sides_clamped
            else None
        )

    @property
    def modes(self) -> tuple[int, int]:
        """Highest m and n of the static series."""
        return self._series.modes

    @property
    def dofs(self) -> int:
        """Amplitudes solved for by the loads so far: wavenumbers they reach times unknowns through the thickness."""
        across = int(np.isfinite(self._compliance_wv[..., 0, 0, 0]).sum()) * self._layers_wv.size
        aside = int(np.isfinite(self._compliance_s[..., 0, 0, 0]).sum())
        clamps = self._sides.dofs if self._sides is not None else 0
        return across + (aside * self._layers_s.size if aside else 0) + clamps

    @property
    def longest_step(self) -> float:
        """Infinite: the step is exact."""
        return inf

    def init(self) -> WaveState:
        """Return the state at rest at time 0."""
        moving = () if self.massless else (self.oscillators_wv.rest, self.oscillators_s.rest)
        return WaveState(0.0, moving + (self._creep.rest if self._creep is not None else ()))

    def static(self, load: Load) -> WaveState:
        """Return the equilibrium under a constant load."""
        return WaveState(0.0, (), load)

    def step(self, state: WaveState, load0: Load, load1: Load, dt: float) -> WaveState:
        """Advance by dt [s], exactly for a load linear from load0 to load1.

        Raises:
            InputError: dt is not above 0, or the loads hold different numbers of presses.
        """
        require_step(load0, load1, dt)
        if not state.oscillators:
            state = WaveState(state.time, self._held(state.load), state.load)
        advanced = tuple(
            family.step(now, f0, f1, dt)
            for family, now, f0, f1 in zip(
                self._families,
                state.oscillators,
                self.moving_forces(load0),
                self.moving_forces(load1),
                strict=False,
            )
        )
        if self._creep is not None:
            creep = state.oscillators[len(self._families) :]
            advanced += self._creep.step(creep, self._tractions(load0), self._tractions(load1), dt)
        return WaveState(state.time + dt, advanced, load1)

    @property
    def _families(self) -> tuple[Oscillators, ...]:
        return () if self.massless else (self.oscillators_wv, self.oscillators_s)

    def _held(self, load: Load) -> tuple[FloatArray, ...]:
        """Return what moves, in equilibrium with a load."""
        moving = tuple(
            family.equilibrium(f) for family, f in zip(self._families, self.moving_forces(load), strict=False)
        )
        return moving + (self._creep.equilibrium(self._tractions(load)) if self._creep is not None else ())

    def displacement(self, state: WaveState, points: FloatArray, layer: str | None = None) -> FloatArray:
        """Return the displacement [m] of a layer's upper face at points [m]; both of shape (n, 3).

        Raises:
            InputError: the layer is unknown.
        """
        along_x, along_y, across = self.amplitudes(state, layer)
        result = np.empty((len(points), 3))
        result[:, 0] = self._series.along_x(along_x, points) if along_x.any() else 0.0
        result[:, 1] = self._series.along_y(along_y, points) if along_y.any() else 0.0
        result[:, 2] = self._series.vertical(across, points)
        return result

    @property
    def series(self) -> Series:
        """The waves of the static answer."""
        return self._series

    @property
    def least_window(self) -> float:
        """Zero: all waves are the layers' own [m]."""
        return 0.0

    @cached_property
    def wave_compliance(self) -> FloatArray:
        """Every face's static W per unit amplitude of pressure [m/Pa], shape (faces, M + 1, N + 1); clamps left out."""
        wanted = np.ones(self._series.shape, dtype=bool)
        wanted[0, :] = wanted[:, 0] = False
        self._fill(self._compliance_wv, self._layers_wv, wanted)
        return np.ascontiguousarray(np.moveaxis(np.nan_to_num(self._compliance_wv[..., 0, 0]), 2, 0))

    def held_back(self, across: FloatArray) -> FloatArray | None:
        """Return what clamped sides add to W under a pressure's waves [Pa]: (faces, M' + 1, N' + 1), M' <= M [m]."""
        if self._sides is None:
            return None
        none = np.zeros_like(across)
        added: FloatArray = np.moveaxis(self._sides.under_load(across, none, none)[0], 2, 0)
        return added

    def mutually_held_back(self, pressures: FloatArray) -> FloatArray:
        """Return what clamped sides add to how pressures of 1 N sink under each other, (n, M + 1, N + 1) to (n, n)."""
        if self._sides is None:
            return np.zeros((len(pressures), len(pressures)))
        return self._sides.mutual(pressures)

    def compliance(self, k: FloatArray, *, finest: float) -> FloatArray:
        """Return every face's static W per unit amplitude of pressure [m/Pa], far from the sides, in no direction.

        Args:
            k: wavenumbers [1/m], shape (J,).
            finest: width of the smallest pad that presses [m].

        Returns:
            Shape (J, faces).
        """
        return layered_compliance(self.tissue, k, base_held=self.support.base_held, finest=finest)

    def amplitudes(self, state: WaveState, layer: str | None = None) -> FloatArray:
        """Return the series of a face's displacement (x, y, z) [m], shape (3, M + 1, N + 1)."""
        face = self.tissue.index(layer)
        table = np.zeros((3, *self._series.shape))
        for press in state.load:
            table += press.force * self._unit_response(press.with_force(1.0))[face]
        if state.oscillators:
            for waves in self._off_balance(state):
                table[:, : waves.shape[2], : waves.shape[3]] += waves[face]
            if self._creep is not None:
                creep = state.oscillators[len(self._families) :]
                lack = self._creep.lack(creep, self._tractions(state.load), len(self.layer_names))
                w, v, s = (part[..., face : face + 1] for part in lack)
                table += turned_to_axes(w, v, s, self._series)[0]
        return table

    # What follows at once -------------------------------------------------------------------------------------

    def _response_to_unit_press(self, press: Press) -> FloatArray:
        """Return every face's static series under one press, shape (layers, 3, M + 1, N + 1)."""
        across, along, side = polarised(press, self._series)
        drags = press.tilt > 0
        self._fill(self._compliance_wv, self._layers_wv, audible(across) | audible(along))
        compliance = np.nan_to_num(self._compliance_wv)
        w = compliance[..., 0, 0] * across[..., None]
        v = compliance[..., 1, 0] * across[..., None]
        s = np.zeros_like(w)
        if drags:
            self._fill(self._compliance_s, self._layers_s, audible(side))
            w = w + compliance[..., 0, 1] * along[..., None]
            v = v + compliance[..., 1, 1] * along[..., None]
            s = np.nan_to_num(self._compliance_s[..., 0, 0]) * side[..., None]
        if self._sides is not None:
            added = self._sides.under_load(across, along, side)
            for waves, more in zip((w, v, s), added, strict=True):
                waves[: more.shape[0], : more.shape[1]] += more
        return turned_to_axes(w, v, s, self._series)

    def _fill(self, table: FloatArray, layers: ThinLayers, wanted: np.ndarray) -> None:
        missing = wanted & np.isnan(table[:, :, 0, 0, 0])
        if missing.any():
            at, places = distinct(self._series, missing, self.tissue)
            table[missing] = surface_compliance(layers, at)[places]

    # What moves -----------------------------------------------------------------------------------------------

    @cached_property
    def oscillators_wv(self) -> Oscillators:
        """Oscillators of the vertical and in-plane waves, one group per m, n >= 1."""
        wanted = np.zeros((self._moving.kx.size, self._moving.ky.size), dtype=bool)
        wanted[1:, 1:] = True
        return self._oscillators(self._layers_wv, wanted)

    @property
    def surface_modes(self) -> tuple[int, int]:
        """Highest m and n that move."""
        return self._moving.modes

    @cached_property
    def surface_oscillators(self) -> Oscillators:
        """Those of `oscillators_wv`, from a modal force [N] across the face to u_z of every layer's upper face [m]."""
        a, b = self.size
        waves, pressure = self.oscillators_wv, 4 / (a * b)
        return Oscillators(
            matrices=waves.matrices,
            inputs=waves.inputs[..., :1] * pressure,
            outputs=np.ascontiguousarray(waves.outputs[:, 0::2]),
            entry=waves.entry,
            holds=waves.holds[..., :1] * pressure,
        )

    @cached_property
    def oscillators_s(self) -> Oscillators:
        """Oscillators of the horizontally polarised shear waves, one group per (m, n) except (0, 0)."""
        wanted = np.ones((self._moving.kx.size, self._moving.ky.size), dtype=bool)
        wanted[0, 0] = False
        return self._oscillators(self._layers_s, wanted)

    def _oscillators(self, layers: ThinLayers, wanted: np.ndarray) -> Oscillators:
        at, places = distinct(self._moving, wanted, self.tissue)
        found = ritz_oscillators(layers, at, self._order, everywhere=self._sides is not None)
        return found.gathered(places)

    def moving_forces(self, load: Load) -> tuple[FloatArray, FloatArray]:
        """Return the traction's amplitudes [Pa] on the groups of `oscillators_wv`, shape (J, 2), and `_s`, (J', 1)."""
        rows, columns = self._moving.kx.size, self._moving.ky.size
        wv = np.zeros((rows, columns, 2))
        s = np.zeros((rows, columns))
        for press in load:
            across, along, side = self._unit_polarised(press.with_force(1.0))
            wv[..., 0] += press.force * across
            wv[..., 1] += press.force * along
            s += press.force * side
        return wv[1:, 1:].reshape(-1, 2), s.reshape(-1, 1)[1:]

    def moving_shapes(self, points: FloatArray) -> FloatArray:
        """Return sin(kx x) sin(ky y) of the groups of `oscillators_wv` at points [m], shape (n, 3); shape (n, J)."""
        along_x = np.sin(np.outer(points[:, 0], self._moving.kx[1:]))
        along_y = np.sin(np.outer(points[:, 1], self._moving.ky[1:]))
        shapes: FloatArray = (along_x[:, :, None] * along_y[:, None, :]).reshape(len(points), -1)
        return shapes

    @cached_property
    def _creep(self) -> Creep | None:
        """What follows the load without inertia, where layers remember."""
        if not self.tissue.relaxation_times:
            return None
        wanted = np.ones(self._series.shape, dtype=bool)
        wanted[0, 0] = False
        if not self.massless:
            wanted[: self._moving.kx.size, : self._moving.ky.size] = False

        def made(layers: ThinLayers, which: np.ndarray) -> Oscillators:
            at, places = distinct(self._series, which, self.tissue)
            return creeping_oscillators(layers, at).gathered(places)

        return creep_of(wanted, partial(made, self._layers_wv), partial(made, self._layers_s))

    def _tractions(self, load: Load) -> FloatArray:
        """Return the traction's amplitudes across the face, along each wave and beside it [Pa], (3, M + 1, N + 1)."""
        total = np.zeros((3, *self._series.shape))
        for press in load:
            total += press.force * self._unit_tractions(press.with_force(1.0))
        return total

    def _off_balance(self, state: WaveState) -> list[FloatArray]:
        """Return what moving waves have beyond the equilibrium with the load, as parts; see `turned_to_axes`."""
        families = self._families
        if not families:
            return []
        across, aside = (
            family.read(now - family.equilibrium(held))
            for family, now, held in zip(
                families, state.oscillators, self.moving_forces(state.load), strict=False
            )
        )
        rows, columns = self._moving.kx.size, self._moving.ky.size
        w, v = np.zeros((2, rows, columns, across.shape[1] // 2))
        read = across.reshape(rows - 1, columns - 1, -1, 2)
        w[1:, 1:], v[1:, 1:] = read[..., 0], read[..., 1]
        s = np.zeros((rows, columns, aside.shape[1]))
        s.reshape(rows * columns, -1)[1:] = aside
        if self._sides is None:
            return [turned_to_axes(w, v, s, self._moving)]
        faces, added = list(self._layers_s.faces), self._sides.under_slide(v, s)
        return [
            turned_to_axes(w[..., faces], v[..., faces], s[..., faces], self._moving),
            turned_to_axes(added[0], added[1], added[2], self._clamps),
        ]
