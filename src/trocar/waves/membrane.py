"""WaveMembrane: the paper's model done right.

Coupled membranes with fixed edges (see `stack`), each mode sin(kx x) sin(ky y) a small system of as many oscillators
as there are layers, moved by the one exact step. An initial shape or velocity given as a function enters through the
double Fourier series (Kreyszig, Advanced Engineering Mathematics, section 12.9); a tool enters through the
closed-form transform of its footprint. Forces act on the top sheet, across it; a tilted press's drag along the
surface is not seen by a membrane, which moves only up and down.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property, lru_cache
from math import inf

import numpy as np

from trocar.errors import InputError
from trocar.model import FloatArray, Load, Press, Support
from trocar.tissues.tissue import Tissue
from trocar.waves.fit import RADII, fitted_stack
from trocar.waves.footprint import modal_forces
from trocar.waves.memory import Memory
from trocar.waves.near_field import SMOOTH, layered_compliance
from trocar.waves.oscillators import Oscillators
from trocar.waves.series import Field, Series
from trocar.waves.stack import Stack, derived_stack, weight_of
from trocar.waves.state import WaveState, require_step


class WaveMembrane:
    """Coupled membranes on a rectangle with fixed edges.

    Args:
        stack: the coefficients.
        size: sides a, b [m].
        modes: highest m and n of the series.
        support: whose block the coefficients describe; told to whoever asks, it changes nothing here.
        fit_error: how far the fit that made the coefficients missed its target [1]; None where there was none.
        tissue: the layers the coefficients imitate, where they do: waves too short for sheets are then the layers' own.
        massless: leaves inertia and Kelvin-Voigt damping out of `step`: what is left is creep, where sheets remember.

    Raises:
        InputError: a size or mode count is impossible.
        SolverError: the stack has no stiffness.
    """

    def __init__(
        self,
        stack: Stack,
        *,
        size: tuple[float, float],
        modes: tuple[int, int] = (48, 48),
        support: Support | str = Support.EDGES,
        fit_error: float | None = None,
        tissue: Tissue | None = None,
        massless: bool = False,
    ) -> None:
        self.stack = stack
        self.massless = massless
        self.fit_error = fit_error
        self._tissue = tissue
        self.size = size
        self.support = Support(support)
        self.layer_names = tuple(sheet.name for sheet in stack.sheets)
        self._series = Series(size, modes)
        self._mass, self._damping, self._stiffness = _matrices(stack, self._series)
        self._memory = _memory(stack, self._series)
        layers = len(stack.sheets)
        self._forcing = np.zeros((len(self._mass), layers, 1))
        self._forcing[:, 0, 0] = 4 / (size[0] * size[1])
        self._reading = np.broadcast_to(np.eye(layers), self._mass.shape)
        self._moving: tuple[Oscillators, ...] = self._creep if massless else (self.oscillators,)
        self._unit_forces = lru_cache(maxsize=16)(self._forces_of_unit_press)

    @classmethod
    def derived(
        cls,
        tissue: Tissue,
        *,
        size: tuple[float, float],
        support: Support | str = Support.BASE,
        modes: tuple[int, int] = (48, 48),
    ) -> WaveMembrane:
        """Build one with coefficients derived from the layers alone (see `derived_stack`)."""
        return cls(derived_stack(tissue, Support(support)), size=size, modes=modes, support=support)

    @classmethod
    def fitted(
        cls,
        tissue: Tissue,
        *,
        size: tuple[float, float],
        support: Support | str = Support.BASE,
        modes: tuple[int, int] = (48, 48),
        radii: tuple[float, ...] = RADII,
        massless: bool = False,
    ) -> WaveMembrane:
        """Build one with coefficients fitted to `WaveSolid`'s response (see `fit`) under tools of these radii [m]."""
        fit = fitted_stack(tissue, size=size, support=Support(support), radii=radii)
        return cls(
            fit.stack,
            size=size,
            modes=modes,
            support=support,
            fit_error=fit.error,
            tissue=tissue,
            massless=massless,
        )

    @property
    def modes(self) -> tuple[int, int]:
        """Highest m and n."""
        return self._series.modes

    @property
    def dofs(self) -> int:
        """Amplitudes solved for: modes times layers."""
        return self.modes[0] * self.modes[1] * len(self.layer_names)

    @property
    def longest_step(self) -> float:
        """Infinite: the step is exact."""
        return inf

    def init(self) -> WaveState:
        """Return the state at rest at time 0."""
        return WaveState(0.0, tuple(moving.rest for moving in self._moving))

    @cached_property
    def oscillators(self) -> Oscillators:
        """One group per mode (m, n), n fastest: from a modal force [N] to u_z of every sheet [m]."""
        return Oscillators.of(
            self._mass, self._damping, self._stiffness, self._forcing, self._reading, self._memory
        )

    @cached_property
    def _creep(self) -> tuple[Oscillators, ...]:
        """What takes time without inertia: nothing where sheets do not remember."""
        if self._memory is None:
            return ()
        return (Oscillators.massless(self._stiffness, self._forcing, self._reading, self._memory),)

    def released(
        self, *, displacement: Mapping[str, Field] | None = None, velocity: Mapping[str, Field] | None = None
    ) -> WaveState:
        """Return the state at time 0 of a tissue let go from a shape and a velocity.

        Args:
            displacement: for each layer named, a function of x, y [m] that gives u_z [m].
            velocity: likewise, du_z/dt [m/s].

        Sheets that remember were held in that shape for ever.

        Raises:
            InputError: a layer is unknown, a field is not finite on the block, or the model has no inertia.
        """
        if self.massless:
            raise InputError("released", "a model with inertia", "a massless one")
        layers = len(self.layer_names)
        start = np.zeros((len(self._mass), 2 * layers))
        for offset, fields in ((0, displacement or {}), (layers, velocity or {})):
            for name, field in fields.items():
                if name not in self.layer_names:
                    raise InputError("released: layer", f"one of {', '.join(self.layer_names)}", name)
                table = self._series.coefficients(field)
                start[:, offset + self.layer_names.index(name)] = table[1:, 1:].ravel()
        return WaveState(0.0, (np.einsum("jsia,ja->jsi", self.oscillators.entry, start),))

    def step(self, state: WaveState, load0: Load, load1: Load, dt: float) -> WaveState:
        """Advance by dt [s], exactly for a load linear from load0 to load1.

        Raises:
            InputError: dt is not above 0, or the loads hold different numbers of presses.
        """
        require_step(load0, load1, dt)
        first, last = self._inputs(load0), self._inputs(load1)
        advanced = tuple(
            moving.step(now, first, last, dt)
            for moving, now in zip(self._moving, state.oscillators, strict=True)
        )
        return WaveState(state.time + dt, advanced, load1)

    def static(self, load: Load) -> WaveState:
        """Return the equilibrium under a constant load."""
        inputs = self._inputs(load)
        return WaveState(0.0, tuple(moving.equilibrium(inputs) for moving in self._moving), load)

    def displacement(self, state: WaveState, points: FloatArray, layer: str | None = None) -> FloatArray:
        """Return the displacement [m] of a layer at points [m]; both of shape (n, 3). Only u_z is not zero.

        Raises:
            InputError: the layer is unknown.
        """
        result = np.zeros((len(points), 3))
        result[:, 2] = self._series.vertical(self.amplitudes(state, layer), points)
        return result

    def amplitudes(self, state: WaveState, layer: str | None = None) -> FloatArray:
        """Return the series of a layer's u_z [m], shape (M + 1, N + 1)."""
        if layer is not None and layer not in self.layer_names:
            raise InputError("layer", f"one of {', '.join(self.layer_names)}", layer)
        place = 0 if layer is None else self.layer_names.index(layer)
        table = np.zeros(self._series.shape)
        table[1:, 1:] = self._sheets(state)[:, place].reshape(self.modes)
        return table

    def _sheets(self, state: WaveState) -> FloatArray:
        """Return every sheet's amplitudes [m], shape (M N, layers)."""
        if not self.massless:
            return self.oscillators.read(state.oscillators[0])
        inputs = self._inputs(state.load)
        held = np.asarray(np.linalg.solve(self._stiffness, self._forcing * inputs[:, None])[..., 0])
        for creep, now in zip(self._creep, state.oscillators, strict=True):
            held = held + creep.read(now - creep.equilibrium(inputs))
        return held

    @property
    def surface_modes(self) -> tuple[int, int]:
        """Highest m and n that move."""
        return self.modes

    @property
    def surface_oscillators(self) -> Oscillators:
        """One group per mode (m, n), n fastest: from a modal force [N] to u_z of every layer's upper face [m]."""
        return self.oscillators

    @property
    def series(self) -> Series:
        """The waves."""
        return self._series

    @property
    def least_window(self) -> float:
        """Width of the narrowest window whose waves the sheets answer for [m]: they cannot imitate a local dent."""
        return SMOOTH if self._tissue is not None else 0.0

    @cached_property
    def wave_compliance(self) -> FloatArray:
        """Every face's static amplitude per unit amplitude of pressure [m/Pa], shape (faces, M + 1, N + 1)."""
        result = np.zeros((len(self.layer_names), *self._series.shape))
        result[:, 1:, 1:] = np.moveaxis(self.static_compliance(), 2, 0)
        return result

    def held_back(self, across: FloatArray) -> None:
        """Return nothing: no clamps act on sheets."""
        return

    def mutually_held_back(self, pressures: FloatArray) -> FloatArray:
        """Return zeros, shape (n, n): no clamps act on sheets."""
        return np.zeros((len(pressures), len(pressures)))

    def compliance(self, k: FloatArray, *, finest: float) -> FloatArray:
        """Return every face's static amplitude per unit amplitude of pressure [m/Pa], (J,) to (J, faces).

        Args:
            k: wavenumbers [1/m], in no direction.
            finest: width of the smallest pad that presses [m].
        """
        if self._tissue is None:
            return self.stack.compliance(k)
        return layered_compliance(self._tissue, k, base_held=self.support.base_held, finest=finest)

    @property
    def matrices_of_motion(self) -> tuple[FloatArray, FloatArray]:
        """Mass and stiffness per unit area of each mode, n fastest, each of shape (M N, layers, layers)."""
        return self._mass, self._stiffness

    def modal_energy(self, state: WaveState) -> FloatArray:
        """Return kinetic plus long-term elastic energy of each mode (m, n), all layers together [J], shape (M, N).

        What is stored in branches of a Prony series is not in it.
        """
        (oscillators,) = state.oscillators
        amplitude, rate = self.oscillators.read(oscillators), self.oscillators.read_rates(oscillators)
        density = np.einsum("ja,jab,jb->j", rate, self._mass, rate)
        density += np.einsum("ja,jab,jb->j", amplitude, self._stiffness, amplitude)
        a, b = self.size
        return np.asarray(0.5 * density * a * b / 4, dtype=np.float64).reshape(self.modes)

    def static_compliance(self) -> FloatArray:
        """Return each face's amplitude per unit pressure amplitude on top [m/Pa], shape (M, N, layers)."""
        top = np.zeros((*self._stiffness.shape[:2], 1))
        top[:, 0] = 1.0
        return np.asarray(np.linalg.solve(self._stiffness, top), dtype=np.float64).reshape(*self.modes, -1)

    def modal_forces(self, load: Load) -> FloatArray:
        """Return the load's integrals against the modes [N], shape (M N,), n fastest."""
        total = np.zeros(len(self._mass))
        for press in load:
            total += press.force * self._unit_forces(press.with_force(1.0))
        return total

    def _inputs(self, load: Load) -> FloatArray:
        return self.modal_forces(load)[:, None]

    def _forces_of_unit_press(self, press: Press) -> FloatArray:
        across: FloatArray = modal_forces(press, self._series)[2, 1:, 1:].ravel()
        return across


def _matrices(stack: Stack, series: Series) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return mass, damping and stiffness per unit area of each mode, each of shape (M N, layers, layers)."""
    own = _own_stiffness(stack, series)
    layers = len(stack.sheets)
    mass = np.zeros((own.shape[1], layers, layers))
    damping, stiffness = mass.copy(), mass.copy()
    for i, sheet in enumerate(stack.sheets):
        mass[:, i, i] = sheet.areal_density
        stiffness[:, i, i] += own[i]
        damping[:, i, i] += sheet.damping + sheet.retardation_time * own[i]
    for i, coupling in enumerate(stack.couplings):
        bed = _bed(i, coupling.stiffness, layers)
        stiffness += bed
        damping += coupling.retardation_time * bed
    return mass, damping, stiffness


def _memory(stack: Stack, series: Series) -> Memory | None:
    """Return what sheets and beds remember; None where they do not."""
    times = stack.relaxation_times
    if not times:
        return None
    own, layers = _own_stiffness(stack, series), len(stack.sheets)
    branches = np.zeros((len(times), own.shape[1], layers, layers))
    for d, time in enumerate(times):
        for i, sheet in enumerate(stack.sheets):
            branches[d, :, i, i] += weight_of(sheet.prony, time) * own[i]
        for i, coupling in enumerate(stack.couplings):
            branches[d] += _bed(i, weight_of(coupling.prony, time) * coupling.stiffness, layers)
    return Memory(times=np.array(times), stiffness=branches)


def _own_stiffness(stack: Stack, series: Series) -> FloatArray:
    """Return each sheet's resistance per unit area without its beds [N/m3], shape (layers, M N)."""
    kx, ky = np.meshgrid(series.kx[1:], series.ky[1:], indexing="ij")
    kx2, ky2 = kx.ravel() ** 2, ky.ravel() ** 2
    return np.array(
        [
            sheet.bending * (kx2 + ky2) ** 2 + sheet.tension_x * kx2 + sheet.tension_y * ky2
            for sheet in stack.sheets
        ]
    )


def _bed(below: int, stiffness: float, layers: int) -> FloatArray:
    pair = np.zeros((layers + 1, layers + 1))
    pair[below : below + 2, below : below + 2] = stiffness * np.array([[1, -1], [-1, 1]])
    return pair[:layers, :layers]
