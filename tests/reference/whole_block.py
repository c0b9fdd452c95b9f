"""The whole block on the mirrored mesh, without any use of symmetry: what the quarters must add up to."""

from __future__ import annotations

import numpy as np
import scipy.sparse.linalg as sla

from trocar.model import Load, Support
from trocar.reference.assembly import stiffness
from trocar.reference.footprint import footprint_points
from trocar.reference.mesh import Bricks
from trocar.reference.parity import mirrored_lines
from trocar.tissues import Layer


def mirrored(quarter: Bricks, size: tuple[float, float]) -> Bricks:
    """Mirror the mesh of a quarter to that of the block."""
    x, y = (mirrored_lines(lines, side) for lines, side in zip((quarter.x, quarter.y), size, strict=True))
    return Bricks(x=x, y=y, z=quarter.z, slab_layer=quarter.slab_layer)


def forces(bricks: Bricks, load: Load) -> np.ndarray:
    """Nodal forces [N], shape (3, nodes)."""
    total = np.zeros(bricks.nodes.shape)
    for press in load:
        points, share = footprint_points(press, bricks.x, bricks.y)
        nodes, weights = bricks.interpolation(points, len(bricks.z) - 1)
        spread = np.bincount(nodes.ravel(), (weights * share).ravel(), minlength=bricks.nodes.shape[1])
        total += np.outer(press.force_vector, spread)
    return total


def held(nodes: np.ndarray, size: tuple[float, float], support: Support) -> np.ndarray:
    """Which components the support holds, written anew from its definition; both of shape (3, n)."""
    result = np.zeros(nodes.shape, dtype=bool)
    if support is not Support.EDGES:
        result[:, np.isclose(nodes[2], nodes[2].min(), rtol=0, atol=1e-9)] = True
    for axis in (0, 1):
        side = np.isclose(nodes[axis] % size[axis], 0.0, rtol=0, atol=1e-9) | np.isclose(
            nodes[axis], size[axis]
        )
        result[:, side] |= (np.arange(3) != axis)[:, None] | (support is not Support.BASE)
    return result


def solve(
    bricks: Bricks, size: tuple[float, float], layers: tuple[Layer, ...], support: Support, load: Load
) -> np.ndarray:
    """Return the equilibrium [m], shape (3, nodes)."""
    free = np.flatnonzero(~held(bricks.nodes, size, support).ravel())
    matrix = stiffness(bricks, layers)[free][:, free].tocsc()
    displacement = np.zeros(bricks.nodes.size)
    displacement[free] = sla.spsolve(matrix, forces(bricks, load).ravel()[free])
    return displacement.reshape(3, -1)
