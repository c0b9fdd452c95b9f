"""A fill-reducing order of nodes by where they lie: nested dissection of a cloud.

The nodes are cut in two at the median along the axis on which they make up most planes; those of the one side that meet
a node of the other are eliminated after both (A. George 1973, SIAM J. Numer. Anal. 10:345).
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from trocar.model import FloatArray
from trocar.reference.grid import IntArray

_LEAF = 48  # nodes that are no longer cut


def dissection_order(places: FloatArray, graph: sp.csr_array) -> IntArray:
    """Return the nodes in the order of their elimination, shape (n,).

    Args:
        places: of the nodes [m], shape (n, 3).
        graph: which nodes meet, shape (n, n).
    """
    plane = np.stack([np.unique(places[:, axis], return_inverse=True)[1] for axis in range(3)], axis=1)
    order: list[IntArray] = []
    above = np.zeros(len(places), dtype=np.int32)

    def cut(nodes: IntArray) -> None:
        extent = np.ptp(plane[nodes], axis=0)
        axis = int(np.argmax(extent))
        if len(nodes) <= _LEAF or extent[axis] < 2:
            order.append(nodes)
            return
        upper = plane[nodes, axis] > np.median(plane[nodes, axis])
        above[nodes[upper]] = 1
        lower = nodes[~upper]
        meets = graph[lower] @ above > 0
        above[nodes[upper]] = 0
        if not upper.any() or meets.all():
            order.append(nodes)
            return
        cut(nodes[upper])
        cut(lower[~meets])
        order.append(lower[meets])

    cut(np.arange(len(places)))
    return np.concatenate(order)
