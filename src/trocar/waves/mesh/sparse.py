"""A factored stiffness: parts that are eliminated one after the other, dense within, and every residual checked.

`dissection` makes a tree of parts; the multifrontal method (Duff and
Reid 1983, ACM Trans. Math. Softw. 9:302) eliminates each in a dense matrix of its own unknowns and of those that they
touch later,

    [F11  .  ]   L11 L11' = F11,   L21 = F21 L11'^-1,   F22 - L21 L21' goes into the part above.
    [F21  F22]
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numba import njit
from scipy.linalg.blas import dsyrk, dtrsm
from scipy.linalg.lapack import dpotrf

from trocar.errors import SolverError
from trocar.model import FloatArray
from trocar.waves.mesh.solid_mesh import IntArray

_ACCEPTED = 1e-8  # relative residual


@dataclass(frozen=True, eq=False)
class _Front:
    """What is kept of a part: its unknowns begin to end, those it touches later, and its columns of the factor."""

    begin: int
    end: int
    later: IntArray
    square: FloatArray
    beside: FloatArray


@njit(cache=True)
def _add(front: FloatArray, place: IntArray, rest: FloatArray) -> None:  # pragma: no cover - compiled
    """Add the lower triangle of what is left of a part to the front above."""
    for j in range(len(place)):
        for i in range(j, len(place)):
            front[place[i], place[j]] += rest[i, j]


class Factored:
    """A factored symmetric positive definite matrix.

    Args:
        matrix: shape (n, n), its unknowns in the order to eliminate them in.
        sizes: how many unknowns each part has, in that order.
        below: which parts lie below each.

    Raises:
        SolverError: it is singular.
    """

    def __init__(self, matrix: sp.csr_array, sizes: list[int], below: list[tuple[int, ...]]) -> None:
        self._matrix = matrix
        columns = sp.csc_array(sp.tril(matrix))
        ends = np.cumsum(sizes)
        self._fronts: list[_Front] = []
        waiting: dict[int, FloatArray] = {}
        try:
            for number, (end, size) in enumerate(zip(ends.tolist(), sizes, strict=True)):
                begin = end - size
                entries = slice(columns.indptr[begin], columns.indptr[end])
                row, value = columns.indices[entries].astype(np.int64), columns.data[entries]
                column = np.repeat(np.arange(size), np.diff(columns.indptr[begin : end + 1]))
                touched = [row, *(self._fronts[one].later for one in below[number])]
                later = np.unique(np.concatenate([rows[rows >= end] for rows in touched])).astype(np.int64)
                known = np.concatenate([np.arange(begin, end), later])
                front = np.zeros((len(known), len(known)), order="F")
                front[np.searchsorted(known, row), column] = value
                for one in below[number]:
                    _add(front, np.searchsorted(known, self._fronts[one].later), waiting.pop(one))
                square, beside, waiting[number] = self._eliminated(front, size)
                self._fronts.append(_Front(begin, end, later, square, beside))
        except MemoryError as error:
            raise SolverError(
                f"the mesh's {matrix.shape[0]} unknowns do not fit into memory once factored; "
                "make larger elements"
            ) from error

    def _eliminated(self, front: FloatArray, size: int) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return L11, L21 and what goes into the part above, of which only the lower triangle counts."""
        rest = front[size:, size:]
        if size == 0:
            return np.zeros((0, 0)), np.zeros((len(front), 0)), np.asfortranarray(rest)
        square, failed = dpotrf(front[:size, :size], lower=1)
        if failed:
            raise SolverError(
                f"the mesh's {self._matrix.shape[0]} unknowns could not be factored; "
                "is every part of it held or joined to one that is?"
            )
        if size == len(front):
            return square, np.zeros((0, size)), rest
        beside = dtrsm(1.0, square, front[size:, :size], side=1, lower=1, trans_a=1)
        return square, beside, dsyrk(-1.0, beside, beta=1.0, c=rest, lower=1)

    @property
    def stored(self) -> int:
        """Memory that the factor takes [bytes]."""
        return sum(front.square.nbytes + front.beside.nbytes for front in self._fronts)

    def solve(self, right: FloatArray) -> FloatArray:
        """Solve for a right-hand side, shape (n,) or (n, k).

        Raises:
            SolverError: the residual is above 1e-8 of the right-hand side.
        """
        right = np.asarray(right)
        solution = np.array(right.reshape(len(right), -1), dtype=np.float64)
        for front in self._fronts:
            own = slice(front.begin, front.end)
            if front.end > front.begin:
                solution[own] = dtrsm(1.0, front.square, solution[own], lower=1)
                solution[front.later] -= front.beside @ solution[own]
        for front in reversed(self._fronts):
            own = slice(front.begin, front.end)
            if front.end > front.begin:
                rest = solution[own] - front.beside.T @ solution[front.later]
                solution[own] = dtrsm(1.0, front.square, rest, lower=1, trans_a=1)
        solution = solution.reshape(right.shape)
        size = np.linalg.norm(right)
        error = np.linalg.norm(right - self._matrix @ solution)
        if not error <= _ACCEPTED * size:
            raise SolverError(
                f"expected a residual below {_ACCEPTED:g} of the load, got {error / size:.2g}; "
                "bring the materials' moduli closer together or lower Poisson's ratio"
            )
        return solution
