"""Largest deflection of each layer's upper face, for any tissue model.

A deflection is -u_z of a layer's upper face, pushed in; its maximum is looked for on a grid over the whole block and
on a finer one under each tool, the same points for every model. Under a tool the surface is a smooth bowl: a grid of
1/13 of the radius misses the lowest point by at most 0.1 % of the depth, and by the same 0.1 % in both models.
"""

from __future__ import annotations

from typing import TypeVar

import numpy as np

from trocar.model import FloatArray, Load, State, TissueModel

S = TypeVar("S", bound=State)

BLOCK_POINTS = 25  # along each side of the block
TOOL_POINTS = 33  # along each side of the square around a footprint
REACH = 1.25  # half the square's side, in half widths of the footprint


def search_points(size: tuple[float, float], load: Load) -> FloatArray:
    """Return where the largest deflection is looked for [m], shape (n, 3).

    Args:
        size: sides a, b of the block [m].
        load: presses; their forces do not matter.
    """
    grids = [_grid((0.0, size[0]), (0.0, size[1]), BLOCK_POINTS)]
    for press in load:
        reach = REACH * max(press.semi_axes)
        x = (max(press.x - reach, 0.0), min(press.x + reach, size[0]))
        y = (max(press.y - reach, 0.0), min(press.y + reach, size[1]))
        grids.append(_grid(x, y, TOOL_POINTS))
    return np.concatenate(grids)


def deflections(model: TissueModel[S], state: S, points: FloatArray, layers: tuple[str, ...]) -> FloatArray:
    """Return how far each layer's upper face is pushed in at points [m], shape (layers, n)."""
    return np.stack([-model.displacement(state, points, layer)[:, 2] for layer in layers])


def _grid(x: tuple[float, float], y: tuple[float, float], count: int) -> FloatArray:
    grid_x, grid_y = np.meshgrid(np.linspace(*x, count), np.linspace(*y, count), indexing="ij")
    return np.stack([grid_x.ravel(), grid_y.ravel(), np.zeros(count * count)], axis=1)
