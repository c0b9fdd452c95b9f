"""A factored stiffness: an order of elimination that fills little, and every residual checked."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from trocar.errors import SolverError
from trocar.model import FloatArray
from trocar.waves.mesh.solid_mesh import IntArray

_LEAF = 60  # nodes of a part that is no longer cut
_ACCEPTED = 1e-8  # relative residual


def dissected(places: FloatArray, matrix: sp.csr_array) -> IntArray:
    """Return an order of elimination by nested dissection (George 1973, SIAM J. Numer. Anal. 10:345).

    A part is cut at the middle of its longest side; whoever has a neighbour on the other side is eliminated last.

    Args:
        places: of the nodes [m], shape (3, n).
        matrix: which nodes are neighbours, shape (n, n), symmetric.
    """
    pattern = sp.csr_array(matrix)
    side = np.zeros(len(places[0]), dtype=np.int8)
    found: list[IntArray] = []

    def cut(nodes: IntArray) -> None:
        if len(nodes) <= _LEAF:
            found.append(nodes)
            return
        along = places[int(np.argmax(np.ptp(places[:, nodes], axis=1)))][nodes]
        left = along < np.median(along)
        if not left.any() or left.all():
            found.append(nodes)
            return
        side[nodes] = np.where(left, 1, 2)
        rows = pattern[nodes[left]]
        touching = np.repeat(np.flatnonzero(left), np.diff(rows.indptr))[side[rows.indices] == 2]
        side[nodes] = 0
        apart = np.zeros(len(nodes), dtype=bool)
        apart[touching] = True
        cut(nodes[left & ~apart])
        cut(nodes[~left])
        found.append(nodes[apart])

    cut(np.arange(len(places[0]), dtype=np.int64))
    return np.concatenate(found)


class Factored:
    """A factored symmetric positive definite matrix.

    Args:
        matrix: shape (n, n), its unknowns in the order to eliminate them in.

    Raises:
        SolverError: it is singular.
    """

    def __init__(self, matrix: sp.csr_array) -> None:
        self._matrix = matrix
        options = {"SymmetricMode": True, "Equil": False}
        try:
            self._factor = splu(matrix.tocsc(), permc_spec="NATURAL", diag_pivot_thresh=0.0, options=options)
        except (RuntimeError, MemoryError) as error:
            raise SolverError(
                f"the mesh's {matrix.shape[0]} unknowns could not be factored ({error}); "
                "is every part of it held or joined to one that is?"
            ) from error

    def solve(self, right: FloatArray) -> FloatArray:
        """Solve for a right-hand side, shape (n,) or (n, k).

        Raises:
            SolverError: the residual is above 1e-8 of the right-hand side.
        """
        solution = np.asarray(self._factor.solve(right))
        size = np.linalg.norm(right)
        error = np.linalg.norm(right - self._matrix @ solution)
        if not error <= _ACCEPTED * size:
            raise SolverError(
                f"expected a residual below {_ACCEPTED:g} of the load, got {error / size:.2g}; "
                "bring the materials' moduli closer together or lower Poisson's ratio"
            )
        return solution
