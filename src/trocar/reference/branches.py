"""Maxwell branches of a mesh: what a Prony series adds, advanced by a recursion.

A branch of weight g and time tau beside the long-term spring carries the stress g D e of a strain-like e that obeys
e' = strain' - e/tau (Simo and Hughes 1998, Computational Inelasticity, ch. 10). All strains follow from nodal
displacements, so a branch of every element with the same tau is one nodal field y, y' = u' - y/tau, with the force
G y, G = sum over layers of g K_layer. Where u is linear over a step of length dt,

    y1 = exp(-x) y0 + theta (u1 - u0),          theta = (1 - exp(-x))/x,  x = dt/tau,
    mean of y over the step = theta y0 + kappa (u1 - u0),    kappa = (1 - theta)/x,

both without error (Taylor, Pister and Goudreau 1970, Int. J. Numer. Methods Eng. 2:45).
"""

from __future__ import annotations

from functools import reduce
from math import exp, expm1
from operator import add

import numpy as np
import scipy.sparse as sp

from trocar.model import FloatArray

_SHORT = 1e-3  # dt/tau below which kappa is summed as a series: the fraction would cancel


class Branches:
    """The branches of a mesh, one for each relaxation time.

    Args:
        times: the relaxation times [s], shape (D,).
        stiffness: G of each [N/m].
    """

    def __init__(self, times: tuple[float, ...], stiffness: tuple[sp.csr_array, ...]) -> None:
        self.times = times
        self.stiffness = stiffness

    def at_end(self, dt: float) -> sp.csr_array:
        """Return what the end's displacement is resisted with at the end [N/m]."""
        return self._sum([_theta(dt / time) for time in self.times])

    def on_average(self, dt: float) -> sp.csr_array:
        """Return what a change of displacement over a step is resisted with on average [N/m]."""
        return self._sum([_kappa(dt / time) for time in self.times])

    def force(self, fields: FloatArray) -> FloatArray:
        """Return the force [N] of fields y [m], shape (D, dofs); (dofs,)."""
        return self._force([1.0] * len(self.times), fields)

    def force_at_end(self, fields: FloatArray, dt: float) -> FloatArray:
        """Return the force [N] that fields y, shape (D, dofs), still exert after dt if nothing moves; (dofs,)."""
        return self._force([exp(-dt / time) for time in self.times], fields)

    def mean_force(self, fields: FloatArray, dt: float) -> FloatArray:
        """Return the mean force [N] of fields y, shape (D, dofs), over dt if nothing moves; (dofs,)."""
        return self._force([_theta(dt / time) for time in self.times], fields)

    def advanced(self, fields: FloatArray, change: FloatArray, dt: float) -> FloatArray:
        """Return the fields y after dt in which the displacement changed, linearly, by `change` [m], (dofs,)."""
        return np.array(
            [
                exp(-dt / time) * field + _theta(dt / time) * change
                for time, field in zip(self.times, fields, strict=True)
            ]
        ).reshape(fields.shape)

    def _sum(self, shares: list[float]) -> sp.csr_array:
        parts = zip(shares, self.stiffness, strict=True)
        return sp.csr_array(reduce(add, (share * stiffness for share, stiffness in parts)))

    def _force(self, shares: list[float], fields: FloatArray) -> FloatArray:
        total = np.zeros(fields.shape[1])
        for share, stiffness, field in zip(shares, self.stiffness, fields, strict=True):
            total += share * (stiffness @ field)
        return total


def _theta(x: float) -> float:
    return -expm1(-x) / x


def _kappa(x: float) -> float:
    return 1 / 2 - x / 6 + x**2 / 24 - x**3 / 120 if x < _SHORT else (1 - _theta(x)) / x
