"""Newton's method with a line search, for forces that are the gradient of an energy.

Each direction d solves K d = -r, r the forces out of balance and K their derivative. The step along it is 1 where that
turns no element inside out and either shrinks r or leaves less than nine tenths of the energy's slope d . r;
otherwise it is shortened towards the zero of the slope (M. A. Crisfield 1991, Non-linear Finite Element Analysis,
sec. 9.2). The slope and not the energy decides: near the solution an energy has no digits left.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
import scipy.sparse as sp

from trocar.errors import SolverError, TrocarError
from trocar.model import FloatArray
from trocar.reference.deformed import InversionError
from trocar.reference.solver import Factorisation

TOLERANCE = 1e-10
"""Of the load: what may be out of balance in a solution [1]."""

MOST_ITERATIONS = 25
_MOST_SHORTENINGS = 12  # 2^-12 of Newton's step moves nothing that counts
_SLACK = 0.9  # of the slope that may be left; Crisfield's 0.8 to 0.9
_MOST_GRADIENTS = 30  # of conjugate gradients: more cost as much as a factorisation of small meshes
_ROUNDING = (
    1e-7  # of the load: below it, what an iteration does not halve is rounding; linear residuals have it too
)
_INNER = 1e-7  # of the imbalance that they leave; Newton's next iteration sees to it


class Equations(Protocol):
    """What is to be brought into balance."""

    def imbalance(self, unknowns: FloatArray) -> FloatArray:
        """Return the forces out of balance [N], shape (n,); raise InversionError where there are none."""
        ...

    def tangent(self, unknowns: FloatArray) -> sp.csr_array:
        """Return their derivative [N/m], symmetric, shape (n, n)."""
        ...


@runtime_checkable
class Convexified(Equations, Protocol):
    """Equations that know a positive definite stand-in for their derivative."""

    def convex(self, unknowns: FloatArray) -> sp.csr_array | None:
        """Return it, or None where there is none after all."""
        ...


@dataclass(frozen=True, kw_only=True)
class Balanced:
    """A solution.

    Args:
        unknowns: shape (n,).
        imbalances: norm over the scale at the start and after each iteration [1].
    """

    unknowns: FloatArray
    imbalances: tuple[float, ...]


class NewtonError(TrocarError):
    """Newton's method came to no solution.

    Args:
        reason: why, a clause.
        element: the one it is about, or None.
    """

    def __init__(self, reason: str, element: int | None = None) -> None:
        self.reason = reason
        self.element = element
        super().__init__(reason)


class Directions:
    """Solve with one tangent after the other.

    A factorisation costs some hundred times what a solution with it does, and the next tangent is much like the last.
    So the last factors precondition conjugate gradients (M. R. Hestenes and E. Stiefel 1952), and only where they
    need too many iterations is the tangent itself factored.

    Args:
        solver: "superlu" or "pardiso".
        factors: of a tangent that the first one is like, or None.
        reuse: whether old factors are used at all.
    """

    def __init__(self, solver: str, factors: Factorisation | None = None, *, reuse: bool = True) -> None:
        self._solver = solver
        self._reuse = reuse
        self._factors = factors

    def solve(self, matrix: sp.csr_array, right: FloatArray) -> FloatArray:
        """Solve for one right-hand side.

        Raises:
            SolverError: the matrix could not be factored.
        """
        if self._factors is not None and self._reuse:
            found = _conjugate_gradients(matrix, right, self._factors.approximate)
            if found is not None:
                return found
        self._factors = None  # freed before the next is made
        self._factors = Factorisation(matrix, self._solver)
        return self._factors.solve(right)


def balance(
    equations: Equations, start: FloatArray, *, scale: float, tolerance: float, directions: Directions
) -> Balanced:
    """Find unknowns whose forces are in balance.

    Args:
        equations: what to solve.
        start: first guess, shape (n,).
        scale: what an imbalance is measured by [N], above 0.
        tolerance: the norm of the imbalance allowed, over the scale [1].
        directions: solves the tangent systems.

    Raises:
        NewtonError: there are none, or they were not found.
    """
    unknowns = start
    try:
        force = equations.imbalance(unknowns)
    except InversionError as error:
        raise NewtonError(error.reason, error.element) from error
    imbalances = [float(np.linalg.norm(force)) / scale]
    while imbalances[-1] > tolerance:
        if len(imbalances) > MOST_ITERATIONS:
            raise NewtonError(
                f"Newton's method left {imbalances[-1]:.1g} of the load after {MOST_ITERATIONS} iterations"
            )
        direction = _direction(equations, unknowns, force, directions)
        try:
            unknowns, force = _line_search(equations, unknowns, force, direction)
        except NewtonError:
            if imbalances[-1] <= _ROUNDING:
                break
            raise
        imbalances.append(float(np.linalg.norm(force)) / scale)
        if 0.5 * imbalances[-2] < imbalances[-1] <= _ROUNDING:
            break
    return Balanced(unknowns=unknowns, imbalances=tuple(imbalances))


def _direction(
    equations: Equations, unknowns: FloatArray, force: FloatArray, directions: Directions
) -> FloatArray:
    """Return Newton's direction; where it does not lower the energy, that of the convex stand-in if there is one."""
    singular: SolverError | None = None
    try:
        direction = directions.solve(equations.tangent(unknowns), -force)
        if direction @ force < 0:
            return direction
    except SolverError as error:
        direction, singular = np.zeros_like(force), error
    stand_in = equations.convex(unknowns) if isinstance(equations, Convexified) else None
    if stand_in is not None:
        return directions.solve(stand_in, -force)
    if singular is not None:
        raise NewtonError("the tangent stiffness is singular") from singular
    return direction


def _line_search(
    equations: Equations, unknowns: FloatArray, force: FloatArray, direction: FloatArray
) -> tuple[FloatArray, FloatArray]:
    slope = float(direction @ force)
    if not slope < 0:
        raise NewtonError("Newton's direction does not lower the energy: the equilibrium is not stable")
    size, step = np.linalg.norm(force), 1.0
    inverted: InversionError | None = None
    for _ in range(_MOST_SHORTENINGS):
        trial = unknowns + step * direction
        try:
            there = equations.imbalance(trial)
        except InversionError as error:
            inverted = error
            step *= 0.5
            continue
        left = float(direction @ there)
        if abs(left) <= _SLACK * abs(slope) or np.linalg.norm(there) < size:
            return trial, there
        step *= min(max(slope / (slope - left), 0.1), 0.5)
    if inverted is not None:
        raise NewtonError(inverted.reason, inverted.element)
    raise NewtonError("no step along Newton's direction brings the forces nearer to balance")


def _conjugate_gradients(
    matrix: sp.csr_array, right: FloatArray, precondition: Callable[[FloatArray], FloatArray]
) -> FloatArray | None:
    """Solve iteratively; None where that takes too long or the matrix is not positive along a direction."""
    wanted = _INNER * float(np.linalg.norm(right))
    solution, residual = np.zeros_like(right), right.copy()
    direction = better = precondition(residual)
    product = float(residual @ better)
    for _ in range(_MOST_GRADIENTS):
        image = matrix @ direction
        curvature = float(direction @ image)
        if not (curvature > 0 and product > 0):
            return None
        solution += product / curvature * direction
        residual -= product / curvature * image
        if np.linalg.norm(residual) <= wanted:
            return solution
        better = precondition(residual)
        before, product = product, float(residual @ better)
        direction = better + product / before * direction
    return None
