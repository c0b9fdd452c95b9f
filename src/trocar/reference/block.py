"""The mesh a block needs: fine where the tools are, coarser away from them, every layer resolved."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

import numpy as np

from trocar.errors import InputError
from trocar.model import FloatArray, Load, Press, Profile, Support
from trocar.reference.footprint import half_extent, require_on_block
from trocar.reference.grid import Grid
from trocar.reference.mesh import Bricks, Spacing, graded_lines
from trocar.tissues import Tissue

_GAUSSIAN_WIDTH = 0.6  # of its radius, two standard deviations: most of its force is nearer the centre


@dataclass(frozen=True, kw_only=True)
class MeshSize:
    """How finely a block is meshed; the defaults are measured by `bench/fea_convergence.py`.

    Args:
        per_radius: elements along a footprint's half width [1]; along 0.6 of it for a Gaussian.
        growth: by how much elements grow per distance from the footprint [m/m].
        top: height of an element at the top face, in half widths of the smallest footprint [1].
        deepening: by how much elements grow per depth [m/m].
        side: length of an element at a clamped side, in half widths of the smallest footprint [1].
        refinement: how many times every element is split in two along every direction.

    Raises:
        InputError: a number is not possible.
    """

    per_radius: float = 3.5
    growth: float = 0.33
    top: float = 0.25
    deepening: float = 0.4
    side: float = 0.15
    refinement: int = 0

    def __post_init__(self) -> None:
        for key in ("per_radius", "growth", "top", "deepening", "side"):
            value = getattr(self, key)
            if not (np.isfinite(value) and value > 0):
                raise InputError(f"mesh: {key}", "a finite number above 0", value)
        if not 0 <= self.refinement <= 4:
            raise InputError("mesh: refinement", "0, 1, 2, 3 or 4", self.refinement)


def quarter_mesh(
    tissue: Tissue, size: tuple[float, float], support: Support, around: Load, mesh: MeshSize
) -> Bricks:
    """Mesh the quarter 0 <= x <= a/2, 0 <= y <= b/2 of a block.

    Args:
        tissue: the layers.
        size: sides a, b of the block [m].
        support: how the block is held; a clamped side needs short elements.
        around: presses whose footprints are resolved, mirrored into the quarter; at least one.
        mesh: how finely.

    Raises:
        InputError: a footprint is off the block.
    """
    for press in around:
        require_on_block(press, size)
    smallest = min(min(_resolved(press, tissue)) for press in around)
    clamped = mesh.side * smallest if support.sides_clamped else inf
    x, y = (
        graded_lines(0.0, 0.5 * side, _along(side, tissue, around, axis, clamped, mesh), mesh.refinement)
        for axis, side in enumerate(size)
    )
    z, slab_layer = _through(tissue, smallest, mesh)
    return Bricks(x=x, y=y, z=z, slab_layer=slab_layer)


def _resolved(press: Press, tissue: Tissue) -> tuple[float, float]:
    """What the mesh has to resolve along x and y [m]: half the footprint's width.

    A footprint wider than the block is thick bends it within a thickness of its rim, which is then resolved instead,
    down to a quarter of that half width.
    """
    x, y = _half_width(press)
    return max(min(x, tissue.thickness), x / 4), max(min(y, tissue.thickness), y / 4)


def _half_width(press: Press) -> tuple[float, float]:
    narrow = _GAUSSIAN_WIDTH if press.profile is Profile.GAUSSIAN else 1.0
    x, y = half_extent(press)
    return narrow * x, narrow * y


def _along(side: float, tissue: Tissue, around: Load, axis: int, clamped: float, mesh: MeshSize) -> Spacing:
    spans = []
    for press in around:
        centre, half = (press.x, press.y)[axis], _half_width(press)[axis]
        folded = min(centre, side - centre)
        spans.append((folded, half, _resolved(press, tissue)[axis]))

    def spacing(places: FloatArray) -> FloatArray:
        wished = [
            fine / mesh.per_radius + mesh.growth * np.maximum(np.abs(places - folded) - half, 0.0)
            for folded, half, fine in spans
        ]
        return np.asarray(np.min([*wished, clamped + mesh.growth * places], axis=0))

    return spacing


def _through(tissue: Tissue, smallest: float, mesh: MeshSize) -> tuple[FloatArray, np.ndarray]:
    def spacing(places: FloatArray) -> FloatArray:
        return mesh.top * smallest - mesh.deepening * places

    lines, slab_layer = [np.array([0.0])], []
    upper = 0.0
    for number, layer in enumerate(tissue.layers):
        lower = upper - layer.thickness
        through = graded_lines(lower, upper, spacing, mesh.refinement)[::-1]
        lines.append(through[1:])
        slab_layer += [number] * (len(through) - 1)
        upper = lower
    return np.concatenate(lines)[::-1].copy(), np.array(slab_layer[::-1], dtype=np.int64)


def held_by_support(grid: Grid, support: Support) -> np.ndarray[tuple[int, ...], np.dtype[np.bool_]]:
    """Return which displacement components the support holds at zero, shape (3, nodes)."""
    held = np.zeros(grid.nodes.shape, dtype=np.bool_)
    if support.base_held:
        held |= grid.nodes[2] <= grid.z[0] + 1e-9 * (grid.z[-1] - grid.z[0])
    for axis, lines in ((0, grid.x), (1, grid.y)):
        side = grid.nodes[axis] <= 1e-12 * lines[-1]
        for component in range(3):
            if support.sides_clamped or component != axis:
                held[component] |= side
    return held
