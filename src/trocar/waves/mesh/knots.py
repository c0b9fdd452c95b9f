"""Knots of a patch: the few places where the surface is looked at for all of a patch's points.

Sites lie half a window apart, and the surface between them is smooth: over a patch as narrow it is nearly the
polynomial through a few places along each tangent (Lagrange). A patch reads, presses and finds its heights at these,
with weights L from knots to points: sunk = L (sunk at knots), forces at knots = L^T p. As L stands on both sides,
W = L W_knots L^T is as symmetric and as positive as W_knots is. `bench/organ_tick.py` prints what it costs in accuracy.
"""

from __future__ import annotations

from math import ceil

import numpy as np

from trocar.model import FloatArray

GAP = 0.35  # of the sites' spacing between knots
_FEWEST, _MOST = 3, 5  # along each tangent; of more the polynomial would swing between them


def knots(offsets: FloatArray, spacing: float) -> tuple[FloatArray, FloatArray]:
    """Choose knots for patches, and find what points take from them.

    Args:
        offsets: of the points from the centre, along both tangents [m], shape (tools, P).
        spacing: of the sites [m].

    Returns:
        Offsets of the knots [m], shape (tools, n), and L, shape (tools, P P, n n). Where three to five knots are not
        fewer than the points, or lie too far apart, every point is one, and L is left out, shape (tools, 0, 0).
    """
    tools, points = offsets.shape
    low, high = offsets.min(axis=1), offsets.max(axis=1)
    count = max(_FEWEST, ceil((high - low).max() / (GAP * spacing)) + 1)
    if count > _MOST or count >= points or not (low < high).all():
        return offsets, np.zeros((tools, 0, 0))
    places = np.linspace(low, high, count, axis=1)
    onto = np.ones((tools, points, count))
    for own in range(count):
        for other in range(count):
            if other != own:
                away = offsets - places[:, [other]]
                onto[:, :, own] *= away / (places[:, [own]] - places[:, [other]])
    both = np.einsum("tpa,tqb->tpqab", onto, onto)
    return places, both.reshape(tools, points * points, count * count)
