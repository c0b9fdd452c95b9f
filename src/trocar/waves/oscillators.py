"""J groups of blocks with inputs and outputs: the part of a wave model that moves.

A group is one wavenumber. Its inputs are modal forces, its outputs amplitudes of the layers' faces.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from trocar.model import FloatArray
from trocar.waves.decouple import decouple
from trocar.waves.kernel import advance
from trocar.waves.propagator import Propagator

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
    ) -> Oscillators:
        """Build them from M q'' + C q' + K q = forcing f, y = reading q.

        Args:
            mass: shape (J, r, r).
            damping: shape (J, r, r).
            stiffness: shape (J, r, r).
            forcing: shape (J, r, n).
            reading: shape (J, k, r).

        Raises:
            SolverError: the matrices are not those of a stable tissue.
        """
        order = mass.shape[-1]
        blocks = decouple(mass, damping, stiffness)
        accelerations = np.linalg.solve(mass, forcing)
        return cls(
            matrices=blocks.matrices,
            inputs=np.einsum("jsia,jan->jsin", blocks.entry[..., order:], accelerations),
            outputs=np.einsum("jka,jasi->jksi", reading, blocks.exit),
            entry=blocks.entry,
            # From the stiffness, not from A: a slow pole beside a very fast one is lost in A's rounding.
            holds=np.einsum("jsia,jan->jsin", blocks.entry[..., :order], np.linalg.solve(stiffness, forcing)),
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
