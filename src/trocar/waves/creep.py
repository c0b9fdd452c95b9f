"""Waves that follow a load without inertia, but not at once: what layers remember delays them.

Every wavenumber without oscillators of its own is a set of real poles (`ritz.creeping_oscillators`). A state says how
far each pole has come; read as a difference from the equilibrium with the load, it is what the displacement lacks.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trocar.model import FloatArray
from trocar.waves.oscillators import Oscillators

Creeping = tuple[FloatArray, ...]


@dataclass(frozen=True)
class Creep:
    """The creeping waves of one series.

    Args:
        waves_wv: of the vertical and in-plane waves, one group for each place wanted.
        waves_s: of the horizontally polarised shear waves, likewise.
        wanted_wv: which m, n the groups stand for, shape (M + 1, N + 1).
        wanted_s: likewise.
    """

    waves_wv: Oscillators
    waves_s: Oscillators
    wanted_wv: np.ndarray
    wanted_s: np.ndarray

    @property
    def rest(self) -> Creeping:
        """The state of a tissue that was never loaded."""
        return self.waves_wv.rest, self.waves_s.rest

    def equilibrium(self, traction: FloatArray) -> Creeping:
        """Return the state that a constant traction holds in place."""
        wv, s = self._inputs(traction)
        return self.waves_wv.equilibrium(wv), self.waves_s.equilibrium(s)

    def step(self, state: Creeping, start: FloatArray, end: FloatArray, dt: float) -> Creeping:
        """Advance by dt [s] under a traction linear from start to end, exactly.

        Args:
            state: of both families.
            start: amplitudes across the face, along each wave vector and beside it [Pa], shape (3, M + 1, N + 1).
            end: the same after dt.
            dt: [s].
        """
        first, last = self._inputs(start), self._inputs(end)
        return (
            self.waves_wv.step(state[0], first[0], last[0], dt),
            self.waves_s.step(state[1], first[1], last[1], dt),
        )

    def lack(self, state: Creeping, traction: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return what W, V and S of each face have beyond equilibrium with a traction, (M + 1, N + 1, faces) [m]."""
        held = self.equilibrium(traction)
        wv = self.waves_wv.read(state[0] - held[0]).reshape(len(state[0]), -1, 2)
        w, v, s = np.zeros((3, *self.wanted_wv.shape, wv.shape[1]))
        w[self.wanted_wv], v[self.wanted_wv] = wv[..., 0], wv[..., 1]
        s[self.wanted_s] = self.waves_s.read(state[1] - held[1])
        return w, v, s

    def _inputs(self, traction: FloatArray) -> tuple[FloatArray, FloatArray]:
        wv = np.stack([traction[0][self.wanted_wv], traction[1][self.wanted_wv]], axis=1)
        return wv, traction[2][self.wanted_s][:, None]
