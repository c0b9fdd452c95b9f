"""A fill-reducing order of the unknowns: nested dissection of the grid.

A block of elements is cut in two by the grid plane that halves its longest direction; the nodes of the plane
are eliminated after those on either side, and each side is cut again (George 1973, SIAM J. Numer. Anal.
10:345).
"""

from __future__ import annotations

import numpy as np

from trocar.reference.grid import Grid, IntArray

_LEAF = 2  # elements along every direction of a block that is no longer cut


def dissection_order(grid: Grid) -> IntArray:
    """Return the nodes in the order of their elimination, shape (nodes,)."""
    place = np.stack(
        [half_index(lines, nodes) for lines, nodes in zip((grid.x, grid.y, grid.z), grid.nodes, strict=True)]
    )
    order: list[IntArray] = []

    def cut(nodes: IntArray, low: tuple[int, ...], high: tuple[int, ...]) -> None:
        extent = [last - first for first, last in zip(low, high, strict=True)]
        axis = int(np.argmax(extent))
        if extent[axis] <= _LEAF:
            order.append(nodes)
            return
        middle = (low[axis] + high[axis]) // 2
        side = place[axis, nodes] - 2 * middle
        cut(nodes[side < 0], low, (*high[:axis], middle, *high[axis + 1 :]))
        cut(nodes[side > 0], (*low[:axis], middle, *low[axis + 1 :]), high)
        order.append(nodes[side == 0])

    cut(np.arange(grid.nodes.shape[1]), (0, 0, 0), grid.shape)
    return np.concatenate(order)


def half_index(lines: np.ndarray, places: np.ndarray) -> IntArray:
    """Number corners 0, 2, 4 ... and the middles between them 1, 3, 5 ..."""
    marks = np.empty(2 * len(lines) - 1)
    marks[0::2], marks[1::2] = lines, 0.5 * (lines[1:] + lines[:-1])
    return np.searchsorted(0.5 * (marks[1:] + marks[:-1]), places).astype(np.int64)
