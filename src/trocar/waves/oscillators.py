"""J groups of blocks with inputs and outputs: the part of a wave model that moves.

A group is one wavenumber. Its inputs are modal forces, its outputs amplitudes of the layers' faces.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from trocar.model import FloatArray
from trocar.waves.decouple import decouple
from trocar.waves.kernel import advance
from trocar.waves.memory import Memory, creeping, decouple_remembering
from trocar.waves.propagator import Propagator

_UNHEARD = 1e-13  # of what a group's poles add to an output together: less is left out
_REMEMBERED_STEPS = 4  # propagators kept: a driver uses one dt, a study a few


@dataclass(frozen=True)
class Oscillators:
    """Blocks x' = A x + B f with outputs y = R x.

    Attributes:
        matrices: A [1/s], shape (J, r, 2, 2).
        inputs: B, shape (J, r, 2, n).
        outputs: R, shape (J, k, r, 2).
        entry: from amplitudes and their rates to x, shape (J, r, 2, 2r).
        holds: the x that a constant unit input holds in place, shape (J, r, 2, n).
    """

    matrices: FloatArray
    inputs: FloatArray
    outputs: FloatArray
    entry: FloatArray
    holds: FloatArray
    _propagators: dict[float, Propagator] = field(default_factory=dict, compare=False, repr=False)

    @classmethod
    def of(
        cls,
        mass: FloatArray,
        damping: FloatArray,
        stiffness: FloatArray,
        forcing: FloatArray,
        reading: FloatArray,
        memory: Memory | None = None,
    ) -> Oscillators:
        """Build them from M q'' + C q' + K q + what is remembered = forcing f, y = reading q.

        Args:
            mass: shape (J, r, r).
            damping: shape (J, r, r).
            stiffness: shape (J, r, r).
            forcing: shape (J, r, n).
            reading: shape (J, k, r).
            memory: of the layers; None where they have none.

        Raises:
            SolverError: the matrices are not those of a stable tissue.
        """
        order = mass.shape[-1]
        if memory is None:
            blocks = decouple(mass, damping, stiffness)
        else:
            blocks = decouple_remembering(mass, damping, stiffness, memory)
        accelerations = np.linalg.solve(mass, forcing)
        return cls(
            matrices=blocks.matrices,
            inputs=np.einsum("jsia,jan->jsin", blocks.entry[..., order:], accelerations),
            outputs=np.einsum("jka,jasi->jksi", reading, blocks.exit),
            entry=blocks.entry,
            # From the stiffness, not from A: a slow pole beside a very fast one is lost in A's rounding.
            holds=np.einsum("jsia,jan->jsin", blocks.entry[..., :order], np.linalg.solve(stiffness, forcing)),
        )

    @classmethod
    def massless(
        cls, stiffness: FloatArray, forcing: FloatArray, reading: FloatArray, memory: Memory
    ) -> Oscillators:
        """Build them without inertia and damping; what they read is right as a difference from equilibrium alone.

        The displacement is that of equilibrium with the load, plus what is read of the state minus `equilibrium`.

        Args:
            stiffness: long-term, shape (J, r, r).
            forcing: shape (J, r, n).
            reading: shape (J, k, r).
            memory: of the layers.

        Raises:
            SolverError: the stiffness is not positive definite.
        """
        rates, seen, shown = creeping(stiffness, memory)
        if rates.shape[1] % 2:  # an idle pole makes the last block whole
            rates = np.concatenate([rates, rates[:, :1]], axis=1)
            seen = np.concatenate([seen, np.zeros_like(seen[:, :1])], axis=1)
            shown = np.concatenate([shown, np.zeros_like(shown[..., :1])], axis=2)
        holds = seen @ np.linalg.solve(stiffness, forcing)
        outputs = reading @ shown
        kept, order = _heard(outputs, holds), reading.shape[2]
        rates = np.take_along_axis(rates, kept, axis=1)
        groups, half = len(rates), kept.shape[1] // 2
        matrices = np.zeros((groups, half, 2, 2))
        for component in (0, 1):
            matrices[..., component, component] = -rates[:, component::2]
        holds = np.take_along_axis(holds, kept[..., None], axis=1)
        return cls(
            matrices=matrices,
            inputs=(rates[..., None] * holds).reshape(groups, half, 2, -1),
            outputs=np.take_along_axis(outputs, kept[:, None, :], axis=2).reshape(groups, -1, half, 2),
            entry=np.zeros((groups, half, 2, 2 * order)),
            holds=holds.reshape(groups, half, 2, -1),
        )

    def gathered(self, groups: np.ndarray) -> Oscillators:
        """Return the groups at these places, repeated where a place is repeated; shape (J',) in."""
        return Oscillators(
            matrices=self.matrices[groups],
            inputs=self.inputs[groups],
            outputs=self.outputs[groups],
            entry=self.entry[groups],
            holds=self.holds[groups],
        )

    @property
    def rest(self) -> FloatArray:
        """The state at rest, shape (J, r, 2)."""
        return np.zeros(self.matrices.shape[:3])

    @property
    def yielding(self) -> FloatArray:
        """The outputs per unit input held in place, shape (J, k, n)."""
        result: FloatArray = np.einsum("jksi,jsin->jkn", self.outputs, self.holds)
        return result

    def step(self, state: FloatArray, force0: FloatArray, force1: FloatArray, dt: float) -> FloatArray:
        """Return the state after dt [s] under inputs linear from force0 to force1, each of shape (J, n)."""
        step = self.propagator(dt)
        advanced = state.copy()
        advance(step.transition, step.start_gain, step.end_gain, advanced, force0, force1)
        return advanced

    def propagator(self, dt: float) -> Propagator:
        """Return the coefficients of a step of length dt [s]; the last few lengths are remembered."""
        if dt not in self._propagators:
            while len(self._propagators) >= _REMEMBERED_STEPS:
                self._propagators.pop(next(iter(self._propagators)))
            self._propagators[dt] = Propagator.over(self.matrices, self.inputs, dt)
        return self._propagators[dt]

    def equilibrium(self, force: FloatArray) -> FloatArray:
        """Return the state that constant inputs, shape (J, n), hold in place."""
        result: FloatArray = np.einsum("jsin,jn->jsi", self.holds, force)
        return result

    def read(self, state: FloatArray) -> FloatArray:
        """Return the outputs y, shape (J, k)."""
        result: FloatArray = np.einsum("jksi,jsi->jk", self.outputs, state)
        return result

    def read_rates(self, state: FloatArray) -> FloatArray:
        """Return y' under no force, shape (J, k); a force bends the rate, not the displacement."""
        rates = np.einsum("jsik,jsk->jsi", self.matrices, state)
        result: FloatArray = np.einsum("jksi,jsi->jk", self.outputs, rates)
        return result


def _heard(outputs: FloatArray, holds: FloatArray) -> np.ndarray:
    """Return the poles that any input reaches and any output hears, the loudest first, an even number; (J, p)."""
    loudness = np.abs(outputs).max(axis=1, initial=0.0) * np.abs(holds).max(axis=2, initial=0.0)
    total = loudness.sum(axis=1, keepdims=True)
    needed = int((loudness > _UNHEARD * total).sum(axis=1).max(initial=0))
    needed += needed % 2
    order = np.argsort(-loudness, axis=1, kind="stable")
    return order[:, :needed]


def joined(pieces: list[Oscillators]) -> Oscillators:
    """Return the groups of all pieces, one after the other; blocks that a piece lacks stay at rest."""
    blocks = max(piece.matrices.shape[1] for piece in pieces)

    def of(name: str, axis: int) -> FloatArray:
        return np.concatenate([_widened(getattr(piece, name), axis, blocks) for piece in pieces])

    return Oscillators(
        matrices=of("matrices", 1),
        inputs=of("inputs", 1),
        outputs=of("outputs", 2),
        entry=of("entry", 1),
        holds=of("holds", 1),
    )


def _widened(values: FloatArray, axis: int, size: int) -> FloatArray:
    """Return an array that ends in zeros along an axis, `size` long."""
    if values.shape[axis] == size:
        return values
    shape = list(values.shape)
    shape[axis] = size - shape[axis]
    return np.concatenate([values, np.zeros(shape)], axis=axis)
