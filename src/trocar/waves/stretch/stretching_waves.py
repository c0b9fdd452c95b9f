"""StretchingWaves: linear waves that stiffen, since a dent stretches the sheet it bends.

The waves answer two things at once: the load, and the pressure -G with which the sheet resists (`energy`). Over a step
G is the discrete gradient of the stored energy between the sheet's two shapes, held constant. The linear waves take a
constant force exactly, so the work they get from the sheet is G . (w0 - w1) = V(w0) - V(w1): what the sheet loses the
waves gain, to rounding, for every dt. The sum of their true energies grows by no more than the load's work, whatever
the waves are, as long as they by themselves make no energy: damped or not, remembering or not. (A discrete gradient
within an exact linear flow: X. Wu, B. Wang and W. Shi 2013, J. Comput. Phys. 235:587. There the flow is that of an
undamped oscillator; any passive one will do.) The step is of second order in dt.

The resistance acts on the top face and follows its deflection; layers of a sheet move up and down together.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from math import inf

import numpy as np

from trocar.errors import InputError
from trocar.model import FloatArray, Load, Support
from trocar.tissues.tissue import Tissue
from trocar.waves.membrane import WaveMembrane
from trocar.waves.oscillators import Oscillators
from trocar.waves.series import Series
from trocar.waves.solid import WaveSolid
from trocar.waves.state import WaveState
from trocar.waves.stretch.balance import in_balance
from trocar.waves.stretch.energy import StretchEnergy
from trocar.waves.stretch.moduli import (
    FITTED_SHARE,
    MembraneModuli,
    bed_below,
    bonded,
    stretching_layers,
)

_LONGEST_STEP = 2.5e-4  # [s] half a per cent after 8 ms of free swing: `bench/stiffening.py order`


@dataclass(frozen=True)
class StretchState:
    """Where the waves stand.

    Attributes:
        waves: of the linear model, under the load alone.
        answer: of its surface oscillators, under the sheet's resistance alone, shape (J, r, 2).
    """

    waves: WaveState
    answer: FloatArray

    @property
    def time(self) -> float:
        """Time since the start [s]."""
        return self.waves.time


class StretchingWaves:
    """Linear waves and a sheet on top of them that stretches; a `TissueModel`.

    Args:
        linear: the waves.
        moduli: of the sheet.
        bed: what the sheet lies on; None where it may be drawn sideways freely.

    Raises:
        InputError: the waves cannot answer a pressure on their face by modes alone, or they creep.
    """

    def __init__(
        self, linear: WaveMembrane | WaveSolid, moduli: MembraneModuli, *, bed: Tissue | None = None
    ) -> None:
        if isinstance(linear, WaveSolid) and linear.support.sides_clamped:
            raise InputError(
                "stretching waves",
                "sides that are not clamped, which WaveSolid answers by all its waves together",
                linear.support.value,
                'use support "base", or the fitted membrane',
            )
        if linear.massless and linear.init().oscillators:
            raise InputError(
                "stretching waves",
                "no Prony series where inertia is left out",
                f"{len(linear.layer_names)} layers that creep",
                "take the waves with inertia, or laws for small strain",
            )
        self.linear = linear
        self.moduli = moduli
        self._over: dict[float, FloatArray] = {}
        self.stretch = StretchEnergy(Series(linear.size, linear.surface_modes), moduli, bed)

    @classmethod
    def of(
        cls, linear: WaveMembrane | WaveSolid, tissue: Tissue, *, share: float = FITTED_SHARE
    ) -> StretchingWaves:
        """Build them with the sheet that follows from a tissue's layers.

        Args:
            linear: the waves, of the same tissue.
            tissue: the layers.
            share: of the derived moduli that the sheet bears [1].

        Raises:
            InputError: no layer is a sheet: the tissue is a single bed; or as for the class.
        """
        layers = stretching_layers(tissue, linear.support)
        if not layers:
            raise InputError(
                "stretching waves", "a layer above the lowest, which a held base makes the bed", tissue.name
            )
        return cls(linear, bonded(layers, share), bed=bed_below(tissue, linear.support))

    @property
    def layer_names(self) -> tuple[str, ...]:
        """Names of the layers, top first."""
        return self.linear.layer_names

    @property
    def size(self) -> tuple[float, float]:
        """Sides a, b [m]."""
        return self.linear.size

    @property
    def support(self) -> Support:
        """How the block is held."""
        return self.linear.support

    @property
    def dofs(self) -> int:
        """Amplitudes solved for: those of the linear waves, and of the sheet."""
        return self.linear.dofs + self.stretch.series.modes[0] * self.stretch.series.modes[1]

    @property
    def longest_step(self) -> float:
        """A quarter of a millisecond; without inertia infinite, since every instant is an equilibrium [s]."""
        return inf if self.linear.massless else _LONGEST_STEP

    @property
    def modes(self) -> tuple[int, int]:
        """Highest m and n of the linear waves."""
        return self.linear.modes

    @property
    def fit_error(self) -> float:
        """How far a fit of the linear waves missed its target [1]; 0 where there was none."""
        return getattr(self.linear, "fit_error", None) or 0.0

    @property
    def large_deformation(self) -> bool:
        """True: equilibria neither scale nor add up."""
        return True

    def init(self) -> StretchState:
        """Return the state at rest at time 0."""
        return StretchState(self.linear.init(), self._face.rest)

    def static(self, load: Load) -> StretchState:
        """Return the equilibrium under a constant load.

        Raises:
            SolverError: deflection and stretch did not come into balance.
        """
        waves = self.linear.static(load)
        free = self._deflection(waves)
        w = in_balance(self._compliance, free, self._resistance, self._shrunk(free))
        held = -self._resistance(w)
        return StretchState(waves, self._face.equilibrium(held.reshape(-1, 1)))

    def step(self, state: StretchState, load0: Load, load1: Load, dt: float) -> StretchState:
        """Advance by dt [s] under a load going linearly from load0 to load1.

        Raises:
            InputError: dt is not above 0, or the loads hold different numbers of presses.
            SolverError: the step could not be taken.
        """
        waves = self.linear.step(state.waves, load0, load1, dt)
        if self.linear.massless:
            still = self.static(load1)
            return StretchState(replace(still.waves, time=waves.time), still.answer)
        start = self.stretch.at(self.deflection(state))
        none = np.zeros((len(state.answer), 1))
        coasting = self._face.step(state.answer, none, none, dt)
        free = self._deflection(waves) + self._read(coasting)

        def resistance(w: FloatArray) -> FloatArray:
            return self.stretch.between(start, self.stretch.at(w))

        w = in_balance(self._compliance_over(dt), free, resistance, free)
        push = -resistance(w).reshape(-1, 1)
        return StretchState(waves, self._face.step(state.answer, push, push, dt))

    def displacement(self, state: StretchState, points: FloatArray, layer: str | None = None) -> FloatArray:
        """Return the displacement [m] of a layer's upper face at points [m]; both of shape (n, 3).

        Raises:
            InputError: the layer is unknown.
        """
        result = self.linear.displacement(state.waves, points, layer)
        place = 0 if layer is None else self.layer_names.index(layer)
        table = np.zeros(self.stretch.series.shape)
        table[1:, 1:] = self._face.read(state.answer)[:, place].reshape(self.stretch.series.modes)
        result[:, 2] += self.stretch.series.vertical(table, points)
        return result

    def deflection(self, state: StretchState) -> FloatArray:
        """Return the waves of the sheet's u_z [m], shape (M, N)."""
        return self._deflection(state.waves) + self._read(state.answer)

    def stretch_energy(self, state: StretchState) -> float:
        """Return what the sheet has stored [J]; the waves' own energy is the linear model's."""
        return self.stretch.energy(self.stretch.at(self.deflection(state)))

    @property
    def _face(self) -> Oscillators:
        return self.linear.surface_oscillators

    @cached_property
    def _compliance(self) -> FloatArray:
        """Static u_z of the top face per modal force, of every wave [m/N], shape (M, N)."""
        return self._read(self._face.equilibrium(np.ones((len(self._face.rest), 1))))

    def _compliance_over(self, dt: float) -> FloatArray:
        """Return u_z of the top face after dt [s] under a constant modal force from rest [m/N], shape (M, N)."""
        if dt not in self._over:
            one = np.ones((len(self._face.rest), 1))
            self._over = {dt: self._read(self._face.step(self._face.rest, one, one, dt))}
        return self._over[dt]

    def _deflection(self, waves: WaveState) -> FloatArray:
        m, n = self.stretch.series.modes
        table = self.linear.amplitudes(waves)
        across: FloatArray = table if table.ndim == 2 else table[2]
        return across[1 : m + 1, 1 : n + 1]

    def _read(self, answer: FloatArray) -> FloatArray:
        return self._face.read(answer)[:, 0].reshape(self.stretch.series.modes)

    def _resistance(self, w: FloatArray) -> FloatArray:
        return self.stretch.gradient(self.stretch.at(w))

    def _shrunk(self, free: FloatArray) -> FloatArray:
        """Return the multiple of a deflection that stores least: energies of second and fourth degree in it."""
        bent = 0.5 * float(np.sum(free**2 / self._compliance))
        stretched = self.stretch.energy(self.stretch.at(free))
        if stretched == 0.0:
            return free
        roots = np.roots(
            [2 * stretched / bent, 0.0, 1.0, -1.0]
        )  # of the derivative by the multiple, over 2 bent
        (share,) = roots.real[np.abs(roots.imag) < 1e-9]
        return float(share) * free
