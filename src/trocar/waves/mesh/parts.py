"""Which elements hang together."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components


def parts(cells: npt.NDArray[np.int64], nodes: int) -> npt.NDArray[np.int64]:
    """Return which piece each element is of, shape (m,): pieces share no node, the one with most elements is 0.

    Args:
        cells: nodes of each element, shape (m, k).
        nodes: how many there are.
    """
    other = cells[:, 1:].ravel()
    one = np.repeat(cells[:, 0], cells.shape[1] - 1)
    joined = sp.coo_array((np.ones(len(one), dtype=np.int8), (one, other)), shape=(nodes, nodes))
    _, label = connected_components(joined, directed=False)
    _, piece, count = np.unique(label[cells[:, 0]], return_inverse=True, return_counts=True)
    rank = np.empty(len(count), dtype=np.int64)
    rank[np.argsort(-count, kind="stable")] = np.arange(len(count))
    return np.asarray(rank[piece.ravel()])
