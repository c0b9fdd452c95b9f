"""One step in time of a block under large deformation, which neither makes nor loses energy of its own.

With u1 = u0 + D, v1 = 2 D / h - v0 and W what the block stores, the step solves

    M (v1 - v0) / h + integral over x from 0 to 1 of dW/du(u0 + x D) + C D / h = (f0 + f1) / 2 .

The integral's work over the step is W(u1) - W(u0) whatever the law: the average vector field method (R. I. McLachlan,
G. R. W. Quispel and N. Robidoux 1999, Phil. Trans. R. Soc. A 357:1021), second order, its matrix symmetric. It is
taken with three Gauss points, so what energy is made is of the order of h^7 a step. For a linear law it is Newmark's
average acceleration, which is the linear model's step. C is the Kelvin-Voigt damping about u0 + h v0 / 2, near the
middle of the step: D . C D / h is never below 0, so damping only ever takes energy.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

import numpy as np
import scipy.sparse as sp

from trocar.errors import SolverError
from trocar.model import FloatArray
from trocar.reference.deformed import InversionError
from trocar.reference.newton import TOLERANCE, Directions, NewtonError, balance
from trocar.reference.part import Part
from trocar.reference.solver import Factorisation

_GAUSS = (
    (0.5 - 0.5 * sqrt(0.6), 5 / 18),
    (0.5, 8 / 18),
    (0.5 + 0.5 * sqrt(0.6), 5 / 18),
)  # places and weights
_LEANING = 2 / 3  # where one stiffness K stands for 2 times the mean of x K: exact for K linear in x
_MOST_HALVINGS = 8


class Moving:
    """The balance of a step: a system of `Equations` for the change D of the free unknowns.

    Args:
        part: what moves.
        start: displacement [m] and velocity [m/s] at the start, shape (n,) each.
        force: mean of the nodal forces at start and end [N], shape (n,).
        dt: [s].
    """

    def __init__(
        self, part: Part[Any], start: tuple[FloatArray, FloatArray], force: FloatArray, dt: float
    ) -> None:
        self._part, self._dt = part, dt
        self._displacement, velocity = start
        self._damping = part.damping_about(self._displacement + 0.5 * dt * velocity)
        momentum = 2 / dt * (part.mass @ velocity)
        self._driven = force + momentum
        held = np.linalg.norm(part.freed(part.internal(part.spread(self._displacement))))
        self.scale = float(max(np.linalg.norm(force), np.linalg.norm(momentum), held))

    def imbalance(self, unknowns: FloatArray) -> FloatArray:
        """Return what is left of the step's equation [N]."""
        total = 2 / self._dt**2 * (self._part.mass @ unknowns) - self._driven
        if self._damping is not None:
            total += self._damping @ unknowns / self._dt
        for (_, weight), field in zip(_GAUSS, self._fields(unknowns), strict=True):
            total += weight * self._part.freed(self._part.internal(field))
        return np.asarray(total)

    def tangent(self, unknowns: FloatArray) -> sp.csr_array:
        """Return its derivative [N/m], the mean of x K over the step from one point: Newton's method forgives that."""
        return self._matrix(self._part.deformed.stiffness(self._leant(unknowns)))

    def convex(self, unknowns: FloatArray) -> sp.csr_array | None:
        """Return a positive definite stand-in for it, or None."""
        stand_in = self._part.deformed.convex(self._leant(unknowns))
        return None if stand_in is None else self._matrix(stand_in)

    def _leant(self, unknowns: FloatArray) -> FloatArray:
        return self._part.spread(self._displacement + _LEANING * unknowns)

    def _fields(self, unknowns: FloatArray) -> list[FloatArray]:
        return [self._part.spread(self._displacement + place * unknowns) for place, _ in _GAUSS]

    def _matrix(self, stiffness: sp.csr_array) -> sp.csr_array:
        total = 2 / self._dt**2 * self._part.mass + 0.5 * stiffness
        if self._damping is not None:
            total = total + self._damping / self._dt
        return sp.csr_array(total)


def rest_factors(part: Part[Any], dt: float) -> Factorisation:
    """Factor the matrix of a step at rest: what later ones start from, whichever came before."""
    nothing = np.zeros(len(part.domain.free))
    return Factorisation(Moving(part, (nothing, nothing), nothing, dt).tangent(nothing), part.solver)


def advance(
    part: Part[Any],
    start: tuple[FloatArray, FloatArray],
    forces: tuple[FloatArray, FloatArray],
    dt: float,
    factors: Factorisation,
    halvings: int = 0,
) -> tuple[FloatArray, FloatArray]:
    """Step by dt [s]; a step that Newton's method cannot take is taken as two halves.

    Args:
        part: what moves.
        start: displacement [m] and velocity [m/s], shape (n,) each, of the free unknowns.
        forces: nodal forces [N] at start and end, shape (n,) each.
        dt: [s].
        factors: of the matrix of such a step at rest.
        halvings: of the step asked for so far.

    Returns:
        Displacement and velocity at the end.

    Raises:
        SolverError: halving did not help; it says where and why.
    """
    displacement, velocity = start
    equations = Moving(part, start, 0.5 * (forces[0] + forces[1]), dt)
    if equations.scale == 0.0:
        return displacement, velocity
    try:
        found = balance(
            equations,
            np.zeros_like(displacement),
            scale=equations.scale,
            tolerance=TOLERANCE,
            directions=Directions(part.solver, factors),
        )
        end = displacement + found.unknowns
        part.deformed.forces(part.spread(end))
    except (NewtonError, InversionError) as error:
        if halvings == _MOST_HALVINGS:
            stopped = error if isinstance(error, NewtonError) else NewtonError(error.reason, error.element)
            raise SolverError(
                f"large deformation: a step was halved {halvings} times to {dt:.2g} s and still could not be taken: "
                f"{part.why(stopped, part.spread(displacement))}; take less force or a slower load"
            ) from error
        middle = 0.5 * (forces[0] + forces[1])
        half = advance(part, start, (forces[0], middle), 0.5 * dt, factors, halvings + 1)
        return advance(part, half, (middle, forces[1]), 0.5 * dt, factors, halvings + 1)
    return end, 2 / dt * found.unknowns - velocity
