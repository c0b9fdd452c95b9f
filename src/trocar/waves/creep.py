"""Waves that follow a load without inertia, but not at once: what layers remember delays them.

Every wavenumber without oscillators of its own is a set of real poles (`ritz.creeping_oscillators`). A state says how
far each pole has come; read as a difference from the equilibrium with the load, it is what the displacement lacks.

Waves come in parts, by polarisation and by whether m and n are odd: a tool in the middle reaches a quarter of them. A
part is made when a load first reaches it; until then it is at rest, and its state is empty.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from trocar.model import FloatArray
from trocar.waves.oscillators import Oscillators

Creeping = tuple[FloatArray, ...]
_SILENT = 1e-13  # traction relative to the largest: below it is rounding
_UNREACHED = np.zeros((0, 0, 2))


@dataclass(frozen=True)
class CreepingPart:
    """Some waves of one polarisation.

    Args:
        wanted: which m, n they are, shape (M + 1, N + 1).
        pushed: which rows of the traction push them: across the face and along the wave vector, or beside it.
        make: returns one group for each place wanted, with as many inputs as rows.
    """

    wanted: np.ndarray
    pushed: tuple[int, ...]
    make: Callable[[np.ndarray], Oscillators]

    @cached_property
    def waves(self) -> Oscillators:
        """Made when first needed."""
        return self.make(self.wanted)

    def inputs(self, traction: FloatArray) -> FloatArray:
        """Return the traction's amplitudes on each group [Pa], shape (J, rows)."""
        return np.stack([traction[row][self.wanted] for row in self.pushed], axis=1)


@dataclass(frozen=True)
class Creep:
    """The creeping waves of one series; a state is one array for each part.

    Args:
        parts: which together are all waves that creep.
    """

    parts: tuple[CreepingPart, ...]

    @property
    def rest(self) -> Creeping:
        """The state of a tissue that was never loaded."""
        return (_UNREACHED,) * len(self.parts)

    def equilibrium(self, traction: FloatArray) -> Creeping:
        """Return the state that a constant traction holds in place; shapes as in `step`."""
        return tuple(
            part.waves.equilibrium(part.inputs(traction)) if _reaches(part, traction) else _UNREACHED
            for part in self.parts
        )

    def step(self, state: Creeping, start: FloatArray, end: FloatArray, dt: float) -> Creeping:
        """Advance by dt [s] under a traction linear from start to end, exactly.

        Args:
            state: of every part.
            start: amplitudes across the face, along each wave vector and beside it [Pa], shape (3, M + 1, N + 1).
            end: the same after dt.
            dt: [s].
        """
        advanced = []
        for part, now in zip(self.parts, state, strict=True):
            if now.size or _reaches(part, start) or _reaches(part, end):
                begun = now if now.size else part.waves.rest
                advanced.append(part.waves.step(begun, part.inputs(start), part.inputs(end), dt))
            else:
                advanced.append(now)
        return tuple(advanced)

    def lack(
        self, state: Creeping, traction: FloatArray, faces: int
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return what W, V and S of each face have beyond equilibrium with a traction, (M + 1, N + 1, faces) [m]."""
        lack = np.zeros((3, *traction.shape[1:], faces))
        for part, now in zip(self.parts, state, strict=True):
            if now.size:
                beyond = part.waves.read(now - part.waves.equilibrium(part.inputs(traction)))
                for i, row in enumerate(part.pushed):
                    lack[row][part.wanted] = beyond[:, i :: len(part.pushed)]
        return lack[0], lack[1], lack[2]


def creep_of(
    wanted: np.ndarray,
    make_wv: Callable[[np.ndarray], Oscillators],
    make_s: Callable[[np.ndarray], Oscillators],
) -> Creep | None:
    """Divide waves into parts; None where there are none.

    Args:
        wanted: which m, n creep, shape (M + 1, N + 1); vertical and in-plane waves only with m, n >= 1.
        make_wv: of the vertical and in-plane waves; see `CreepingPart`.
        make_s: of the horizontally polarised shear waves.
    """
    m, n = (np.arange(count) % 2 for count in wanted.shape)
    odd = m[:, None] + n[None, :]  # both even 0, one of them 1, both odd 2
    parts = []
    for parity in range(3):
        beside = wanted & (odd == parity)
        across = beside.copy()
        across[0, :] = across[:, 0] = False
        for where, pushed, make in ((across, (0, 1), make_wv), (beside, (2,), make_s)):
            if where.any():
                parts.append(CreepingPart(where, pushed, make))
    return Creep(tuple(parts)) if parts else None


def _reaches(part: CreepingPart, traction: FloatArray) -> bool:
    return bool(np.abs(part.inputs(traction)).max() > _SILENT * np.abs(traction).max())
