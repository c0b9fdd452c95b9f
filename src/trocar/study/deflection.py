"""Largest deflection of each layer's upper face, for any tissue model.

A deflection is how far a layer's upper face is pushed in, -u_z, or on a mesh, whose surface slopes, against its
normal; its maximum is looked for on a grid over the whole block and on a finer one under each tool, the same points for
every model. Under a tool the surface is a smooth bowl: a grid of 1/13 of the radius misses the lowest point by at most
0.1 % of the depth, and by the same 0.1 % in both models.
"""

from __future__ import annotations

from typing import Any, TypeVar

import numpy as np

from trocar.model import FloatArray, Load, State, TissueModel
from trocar.study.cases.experiment import Case
from trocar.waves.mesh.elements import Elements
from trocar.waves.mesh.wave_mesh import MeshState, WaveMesh

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


def points_over(case: Case) -> FloatArray:
    """Return where a case's largest deflection is looked for [m], shape (n, 3); over a mesh, none beside it."""
    points = search_points(case.size, case.load_at(0.0))
    if case.mesh is None:
        return points
    elements = Elements(case.mesh)
    over = np.isfinite([elements.heights(face, points) for face in case.faces]).all(axis=0)
    return np.asarray(points[over])


def deflections(model: TissueModel[S], state: S, points: FloatArray, layers: tuple[str, ...]) -> FloatArray:
    """Return how far each layer's upper face is pushed in at points [m], shape (layers, n)."""
    sloping: Any = model
    if isinstance(sloping, WaveMesh) and isinstance(state, MeshState):
        return np.stack([-sloping.along_normal(state, points, layer) for layer in layers])
    return np.stack([-model.displacement(state, points, layer)[:, 2] for layer in layers])


def _grid(x: tuple[float, float], y: tuple[float, float], count: int) -> FloatArray:
    grid_x, grid_y = np.meshgrid(np.linspace(*x, count), np.linspace(*y, count), indexing="ij")
    return np.stack([grid_x.ravel(), grid_y.ravel(), np.zeros(count * count)], axis=1)
