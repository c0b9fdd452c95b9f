"""Deformed faces on a grid, for pictures and files."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from trocar.model import FloatArray, TissueModel


@dataclass(frozen=True)
class Surface:
    """The upper face of every layer on one grid.

    Attributes:
        x: [m], shape (n,).
        y: [m], shape (m,).
        displacement: of each layer's upper face [m], shape (3, n, m); layers top first.
    """

    x: FloatArray
    y: FloatArray
    displacement: dict[str, FloatArray]


def surface(
    model: TissueModel[Any], state: Any, *, points: int = 61, layers: tuple[str, ...] = ()
) -> Surface:
    """Sample the faces of a model.

    Args:
        model: any tissue.
        state: of this model.
        points: along each side of the block.
        layers: which; all where empty.
    """
    x = np.linspace(0.0, model.size[0], points)
    y = np.linspace(0.0, model.size[1], points)
    grid_x, grid_y = np.meshgrid(x, y, indexing="ij")
    where = np.stack([grid_x.ravel(), grid_y.ravel(), np.zeros(points * points)], axis=1)
    return Surface(
        x=x,
        y=y,
        displacement={
            layer: model.displacement(state, where, layer).T.reshape(3, points, points)
            for layer in layers or model.layer_names
        },
    )
