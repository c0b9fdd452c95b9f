"""A mesh in few amplitudes: their matrices, what moves of them, and how a state goes over to another basis.

    q'' + C q' + K q + sum over times of G_d (q - z_d) = P f,    tau_d z_d' = q - z_d

Its blocks x' = A x + B p, q = R x (`Oscillators`) keep no z_d, but they know them. Where q = R x,

    z_d = R (1 + tau_d A)^-1 x,

and what a lag adds to x must decay by itself as it does, so that from amplitudes, rates and lags

    x = (entry of q and q' that all z_d equal q) - sum of tau_d (1 + tau_d A)^-1 B G_d (q - z_d),

each block by itself; B is of forces on every amplitude. Without inertia x follows from the z_d alone.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from trocar.model import FloatArray
from trocar.waves.memory import Memory
from trocar.waves.oscillators import Oscillators

_ALONE = 1e-13  # of a block's larger factor 1 + tau s: a state that no branch couples to anything is left out


@dataclass(frozen=True, eq=False)
class Reduced:
    """The equations of motion of n amplitudes of unit mass.

    Attributes:
        own: vectors beside the modes [kg^-1/2], of unit mass and upright on them and on each other, (unknowns, k).
        damping: C, shape (n, n).
        stiffness: K after long, shape (n, n).
        forcing: P, from a force of 1 N of each press, shape (n, presses).
        memory: of one system; None where nothing remembers.
        massless: whether inertia and damping are left out.
    """

    own: FloatArray
    damping: FloatArray
    stiffness: FloatArray
    forcing: FloatArray
    memory: Memory | None
    massless: bool

    @cached_property
    def oscillators(self) -> Oscillators:
        """One group, read in all amplitudes: pushed by each press, or without inertia at each amplitude."""
        one = np.eye(len(self.stiffness))[None]
        if not self.massless:
            return Oscillators.of(
                one, self.damping[None], self.stiffness[None], self.forcing[None], one, self.memory
            )
        if self.memory is None:  # nothing moves: what is static is all
            count = len(self.stiffness)
            return Oscillators(
                matrices=np.zeros((1, 0, 2, 2)),
                inputs=np.zeros((1, 0, 2, count)),
                outputs=np.zeros((1, count, 0, 2)),
                entry=np.zeros((1, 0, 2, 2 * count)),
                holds=np.zeros((1, 0, 2, count)),
            )
        return Oscillators.massless(self.stiffness[None], one, one, self.memory)

    def inputs(self, forces: FloatArray) -> FloatArray:
        """Return what `oscillators` take of forces of the presses [N], shape (presses,) to (1, inputs)."""
        pushed = self.forcing @ forces if self.massless else forces
        return np.asarray(pushed[None], dtype=np.float64)

    def amplitudes(self, state: FloatArray, forces: FloatArray) -> FloatArray:
        """Return q of a state under forces of the presses [N], shape (n,)."""
        if not self.massless:
            return np.asarray(self.oscillators.read(state)[0], dtype=np.float64)
        pushed = self.inputs(forces)
        late = self.oscillators.read(state - self.oscillators.equilibrium(pushed))[0]
        return np.asarray(np.linalg.solve(self.stiffness, pushed[0]) + late)

    def carried(self, older: Reduced, state: FloatArray, overlap: FloatArray) -> FloatArray:
        """Return the state of an older basis in this one.

        Args:
            older: that basis.
            state: in it.
            overlap: its vectors beside the modes seen from those of this one, shape (k, k of the older).
        """
        modes = len(older.stiffness) - overlap.shape[1]

        def turned(amplitudes: FloatArray) -> FloatArray:
            return np.concatenate([amplitudes[:modes], overlap @ amplitudes[modes:]])

        own, old = self.oscillators, older.oscillators
        moved, rates = turned(old.read(state)[0]), turned(old.read_rates(state)[0])
        found = np.asarray(np.einsum("jsia,a->jsi", own.entry, np.concatenate([moved, rates])))
        if self.memory is None:
            return found
        pushes = own.inputs if self.massless else own.entry[..., len(moved) :]
        for time, branch in zip(self.memory.times, self.memory.stiffness, strict=True):
            lagging = turned(np.einsum("jksi,jsih,jsh->k", old.outputs, _delay(old, time), state))
            stress = branch[0] @ (lagging if self.massless else lagging - moved)
            found += time * np.einsum("jsih,jsha,a->jsi", _delay(own, time), pushes, stress)
        return found


def _delay(oscillators: Oscillators, time: float) -> FloatArray:
    """Return (1 + time A)^-1 of each block, shape (1, s, 2, 2)."""
    inverse = np.linalg.pinv(np.eye(2) + time * oscillators.matrices, rcond=_ALONE)
    return np.asarray(inverse, dtype=np.float64)
