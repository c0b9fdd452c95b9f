"""The linear solver seam: one factorisation, many right-hand sides, every residual checked.

`superlu` is SciPy's sparse LU, here given an already dissected order so that it keeps it. `pardiso` is the
sparse Cholesky of Intel's MKL through pypardiso, several times faster on large meshes; MKL is proprietary and
comes only with the extra `trocar[pardiso]`.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from importlib.util import find_spec
from weakref import finalize

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from trocar.errors import InputError, SolverError
from trocar.model import FloatArray
from trocar.reference.grid import IntArray

Solve = Callable[[FloatArray], FloatArray]

_ACCEPTED = 1e-7  # the largest returned: a residual is a load out of balance, and 1e-7 of it moves as little


def choose_solver(name: str) -> str:
    """Return the solver that `name` asks for: "auto" is the fastest installed.

    Raises:
        InputError: there is no such solver, or it is not installed.
    """
    installed = find_spec("pypardiso") is not None
    match name:
        case "auto":
            return "pardiso" if installed else "superlu"
        case "superlu":
            return name
        case "pardiso" if installed:
            return name
        case "pardiso":
            raise InputError(
                "solver", "an installed solver", name, "install trocar[pardiso] or use 'superlu'"
            )
    raise InputError("solver", "one of auto, superlu, pardiso", name)


def submatrix(matrix: sp.csr_array, unknowns: IntArray) -> sp.csr_array:
    """Return a matrix's part between some unknowns, in their order."""
    return sp.csr_array(matrix[unknowns][:, unknowns])


class Factorisation:
    """A factored symmetric positive definite matrix.

    Args:
        matrix: shape (n, n), its unknowns in the order to eliminate them in.
        solver: "superlu" or "pardiso".

    Raises:
        SolverError: the matrix is singular.
    """

    def __init__(self, matrix: sp.csr_array, solver: str) -> None:
        self._matrix = matrix
        try:
            self._solve = (_Pardiso if solver == "pardiso" else _superlu)(matrix)
        except (RuntimeError, ValueError) as error:
            raise SolverError(
                f"{solver} could not factor the {matrix.shape[0]} unknowns ({error}); "
                "a layer may be too soft or too thin beside the others, or Poisson's ratio too near 0.5"
            ) from error

    def approximate(self, right: FloatArray) -> FloatArray:
        """Solve without a look at the residual: to precondition another matrix."""
        return self._solve(right)

    def solve(self, right: FloatArray) -> FloatArray:
        """Solve for a right-hand side, shape (n,).

        Raises:
            SolverError: the residual stays above 1e-7 of the right-hand side.
        """
        size = np.linalg.norm(right)
        if size == 0:
            return np.zeros_like(right)
        solution = self._solve(right)
        error = np.linalg.norm(right - self._matrix @ solution) / size
        if not error <= _ACCEPTED:
            raise SolverError(
                f"expected a residual below {_ACCEPTED:g} of the load, got {error:.2g}; "
                "bring the layers' moduli closer together or lower Poisson's ratio"
            )
        return solution


def _superlu(matrix: sp.csr_array) -> Solve:
    options = {"SymmetricMode": True, "Equil": False}
    return splu(matrix.tocsc(), permc_spec="NATURAL", diag_pivot_thresh=0.0, options=options).solve


class _Pardiso:
    """One factorisation of MKL's, freed with this object: pypardiso itself keeps what it allocated."""

    def __init__(self, matrix: sp.csr_array) -> None:
        pypardiso = import_module("pypardiso")
        solver = pypardiso.PyPardisoSolver(mtype=2)  # 2: real, symmetric, positive definite
        finalize(self, solver.free_memory, everything=True)
        self._upper = sp.csr_matrix(sp.triu(matrix, format="csr"))
        self._upper.sort_indices()
        self._solver = solver
        try:
            solver.factorize(self._upper)
        except pypardiso.pardiso_wrapper.PyPardisoError as error:  # not positive definite
            raise ValueError(str(error)) from error

    def __call__(self, right: FloatArray) -> FloatArray:
        return np.asarray(self._solver.solve(self._upper, right), dtype=np.float64)
