"""An order of elimination that fills little: nested dissection (George 1973, SIAM J. Numer. Anal. 10:345).

A part is cut at the middle of one of its sides, and as few nodes as possible are taken out so that the halves no longer
touch: a smallest cover of the pairs of neighbours across the cut, from a largest matching (Koenig). Of the three
sides the one that takes fewest is cut. What was taken out is eliminated after both halves.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import maximum_bipartite_matching

from trocar.model import FloatArray
from trocar.waves.mesh.solid_mesh import IntArray

_LEAF = 40  # nodes of a part that is no longer cut


@dataclass(frozen=True, eq=False)
class Part:
    """Nodes that are eliminated together.

    Attributes:
        nodes: their numbers.
        below: places in the order of elimination of the parts that this one parts.
    """

    nodes: IntArray
    below: tuple[int, ...] = ()


def dissected(places: FloatArray, matrix: sp.csr_array) -> list[Part]:
    """Return parts in their order of elimination.

    Args:
        places: of the nodes [m], shape (3, n).
        matrix: which nodes are neighbours, shape (n, n), symmetric.
    """
    pattern = sp.csr_array(matrix)
    found: list[Part] = []

    def cut(nodes: IntArray) -> int:
        best: tuple[IntArray, IntArray, IntArray] | None = None
        if len(nodes) > _LEAF:
            inner = sp.csr_array(pattern[nodes][:, nodes])
            for axis in range(3):
                along = places[axis][nodes]
                left = along < np.median(along)
                if left.any():
                    taken = _between(inner, left)
                    if best is None or len(taken) < len(best[0]):
                        kept = np.ones(len(nodes), dtype=bool)
                        kept[taken] = False
                        best = taken, np.flatnonzero(left & kept), np.flatnonzero(~left & kept)
        if best is None:
            found.append(Part(nodes))
        else:
            below = tuple(cut(nodes[half]) for half in best[1:] if len(half))
            found.append(Part(nodes[best[0]], below))
        return len(found) - 1

    cut(np.arange(len(places[0]), dtype=np.int64))
    return found


def _between(neighbours: sp.csr_array, left: np.ndarray) -> IntArray:
    """Return the fewest nodes without which no node on the left has a neighbour on the right."""
    here, there = np.flatnonzero(left), np.flatnonzero(~left)
    pairs = sp.csr_array(neighbours[here][:, there])
    ones = sp.csr_array((np.ones(pairs.nnz, dtype=np.int8), pairs.indices, pairs.indptr), shape=pairs.shape)
    partner = maximum_bipartite_matching(ones, perm_type="column")  # of each on the left, or -1
    touching = np.diff(ones.indptr) > 0
    reached, seen = touching & (partner < 0), np.zeros(len(there), dtype=bool)
    of = np.full(len(there), -1)
    of[partner[partner >= 0]] = np.flatnonzero(partner >= 0)
    edge = reached.copy()
    while edge.any():  # from unmatched nodes on the left: any pair to the right, matched ones back
        new = np.zeros(len(there), dtype=bool)
        new[ones[np.flatnonzero(edge)].indices] = True
        new &= ~seen
        seen |= new
        back = of[np.flatnonzero(new)]
        edge = np.zeros(len(here), dtype=bool)
        edge[back[back >= 0]] = True
        edge &= ~reached
        reached |= edge
    return np.concatenate([here[touching & ~reached], there[seen]]).astype(np.int64)
