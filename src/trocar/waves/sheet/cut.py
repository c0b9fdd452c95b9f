"""Cutting a lattice: the links that a straight cut crosses hold no more.

A cut is told in rest coordinates, where the nodes of the taut, whole sheet lie. A node on it counts as on its left, so
that no cut slips between two links.
"""

from __future__ import annotations

from numba import njit

from trocar.waves.sheet.lattice import AHEAD, Lattice, LatticeState


@njit(cache=True)
def cut_along(
    lattice: Lattice, state: LatticeState, x0: float, y0: float, x1: float, y1: float
) -> int:  # pragma: no cover - compiled
    """Cut every link that a segment crosses; return how many held before.

    Args:
        lattice: parameters.
        state: which links hold, and where those that do not were crossed; overwritten.
        x0: of the segment's beginning, at rest [m].
        y0: likewise [m].
        x1: of its end [m].
        y1: likewise [m].
    """
    h, n = lattice.spacing, lattice.columns
    rows = len(lattice.free) // n
    first, last = max(int(min(x0, x1) / h) - 1, 0), min(int(max(x0, x1) / h) + 2, n - 1)
    bottom, top = max(int(min(y0, y1) / h) - 1, 0), min(int(max(y0, y1) / h) + 2, rows - 1)
    dx, dy = x1 - x0, y1 - y0
    count = 0
    for j in range(bottom, top + 1):
        for i in range(first, last + 1):
            side = dx * (j * h - y0) - dy * (i * h - x0)
            for way in range(4):
                at = j * n + i
                if state.whole[way, at] == 0.0:
                    continue
                ex, ey = AHEAD[way][0] * h, AHEAD[way][1] * h
                turn = dx * ey - dy * ex
                if (side >= 0.0) == (side + turn >= 0.0):
                    continue
                # The link's sides differ, so turn is not 0: where on the segment they meet.
                share = ((i * h - x0) * ey - (j * h - y0) * ex) / turn
                if 0.0 <= share <= 1.0:
                    state.whole[way, at] = 0.0
                    state.crossed[way, at] = min(max(-side / turn, 0.0), 1.0)
                    count += 1
    return count
