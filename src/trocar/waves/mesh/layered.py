"""A block whose layers have thicknesses that vary over x and y: blocks of different thickness, wedges, folds.

The grid of `block_mesh` is kept; its columns stay upright and are stretched layer by layer.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from enum import StrEnum

import numpy as np

from trocar.errors import InputError
from trocar.model import FloatArray, Support
from trocar.tissues.tissue import Tissue
from trocar.waves.mesh.block import block_mesh
from trocar.waves.mesh.solid_mesh import SolidMesh, placed

_THINNEST = 0.01  # of a layer's stated thickness

Thickness = FloatArray | Callable[[FloatArray, FloatArray], FloatArray]
"""Of a layer [m]: at the grid's lines, shape (len(x), len(y)), or a function of x and y [m], arrays of that shape."""


class Flat(StrEnum):
    """Which face of the block is plane."""

    TOP = "top"
    BASE = "base"


def layered_mesh(
    tissue: Tissue,
    lines: Sequence[FloatArray],
    thickness: Mapping[str, Thickness],
    *,
    flat: Flat | str = Flat.BASE,
    support: Support | str = Support.BASE,
) -> SolidMesh:
    """Return a block of layers of varying thickness between grid lines.

    Args:
        tissue: the layers; one that `thickness` does not name is as thick as it says.
        lines: ascending places along x and y from 0, and along z up to 0 [m], the faces of the tissue's layers among
            them, as for `block_mesh`.
        thickness: by the layer's name [m].
        flat: which face stays plane; the other follows the thicknesses.
        support: how it is held.

    Raises:
        InputError: there is no such layer, or it is not a hundredth of its stated thickness somewhere.
    """
    if flat not in list(Flat):
        raise InputError("flat", f"one of {', '.join(Flat)}", flat)
    x, y, z = (np.asarray(line, dtype=np.float64) for line in lines)
    mesh = block_mesh(tissue, lines, support=support)
    for name in thickness:
        if name not in tissue.layer_names:
            raise InputError("thickness", f"names of layers, of {', '.join(tissue.layer_names)}", name)
    grid = np.meshgrid(x, y, indexing="ij")
    own = []
    for layer in tissue.layers:
        given = thickness.get(layer.name)
        if given is None:
            own.append(np.full(grid[0].shape, layer.thickness))
        else:
            own.append(_checked(given, grid, layer.name, layer.thickness))
    stated = np.concatenate([[0.0], np.cumsum([layer.thickness for layer in tissue.layers])])
    depth = np.concatenate(
        [np.zeros((1, *grid[0].shape)), np.cumsum(own, axis=0)]
    )  # of each layer's upper face
    if flat == Flat.BASE:
        depth = depth - depth[-1]
    layer_of = np.clip(np.searchsorted(stated, -z, side="right") - 1, 0, len(own) - 1)
    share = (-z - stated[layer_of]) / (stated[layer_of + 1] - stated[layer_of])
    upper, lower = depth[layer_of], depth[layer_of + 1]
    height = -(upper + share[:, None, None] * (lower - upper))
    corners = mesh.corners.copy()
    corners[:, 2] = np.moveaxis(height, 0, -1).ravel()
    return placed(replace(mesh, corners=corners))


def _checked(given: Thickness, grid: Sequence[FloatArray], name: str, stated: float) -> FloatArray:
    values = np.asarray(given(*grid) if callable(given) else given, dtype=np.float64)
    values = np.broadcast_to(values, grid[0].shape) if values.ndim == 0 else values
    if values.shape != grid[0].shape:
        raise InputError(
            f"thickness of {name}", f"a value at each of {grid[0].shape} lines along x and y", values.shape
        )
    if not np.isfinite(values).all():
        raise InputError(f"thickness of {name}", "finite numbers", "others")
    if values.min() < _THINNEST * stated:
        i, j = np.unravel_index(int(values.argmin()), values.shape)
        raise InputError(
            f"thickness of {name}",
            f"at least {1e3 * _THINNEST * stated:.3g} mm everywhere, a hundredth of what its tissue states",
            f"{1e3 * values.min():.3g} mm at x = {1e3 * grid[0][i, j]:.4g}, y = {1e3 * grid[1][i, j]:.4g} mm",
            "a layer cannot end within a block; are the lengths in metres?",
        )
    return values
