"""The mesh: graded tensor-product lines over a quarter of the block, and the 20-node hexahedra on them.

Lines come from a wished element size h(x). They are the images of evenly spaced values of s(x) = integral of
dx/h, so that h changes smoothly and halving the spacing in s splits every element: refined meshes are nested,
which is what Richardson extrapolation asks for.

Every element is an axis-parallel brick, its local axes along x, y, z: its Jacobian is diagonal and constant,
so no mapping has to be evaluated anywhere. Nodes, shape functions and quadrature are scikit-fem's
(`ElementHexS2`, the 20-node serendipity hexahedron).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from skfem import Basis, ElementHexS2, MeshHex

from trocar.model import FloatArray
from trocar.reference.grid import Grid, IntArray, locate

Spacing = Callable[[FloatArray], FloatArray]

REDUCED_ORDER = 3  # polynomial order of the 2 x 2 x 2 Gauss rule
EXACT_ORDER = 5  # of the 3 x 3 x 3 rule, exact for the product of two shape functions
_SAMPLES = (
    4001  # points at which a spacing is integrated; a line's place depends on it by less than 1e-6 of a side
)


def graded_lines(start: float, stop: float, spacing: Spacing, refinement: int = 0) -> FloatArray:
    """Return grid lines from start to stop, about `spacing` apart.

    Args:
        start: lower end [m].
        stop: upper end [m].
        spacing: the wished element size [m] at places [m], array in, array out; above 0.
        refinement: how many times every interval is split in two.

    Returns:
        Ascending places [m], shape (intervals + 1,); the ends are exact.
    """
    places = np.linspace(start, stop, _SAMPLES)
    density = 1.0 / spacing(places)
    steps = 0.5 * (density[1:] + density[:-1]) * np.diff(places)
    travelled = np.concatenate([[0.0], np.cumsum(steps)])
    intervals = max(1, int(np.ceil(travelled[-1] - 1e-9))) * 2**refinement
    lines: FloatArray = np.interp(np.linspace(0.0, travelled[-1], intervals + 1), travelled, places)
    lines[0], lines[-1] = start, stop
    return lines


@dataclass(frozen=True, eq=False)
class Bricks(Grid):
    """20-node bricks between grid lines."""

    @cached_property
    def basis(self) -> Basis:
        """scikit-fem's basis of one scalar component."""
        nx, ny, nz = self.shape
        corners = np.stack(np.meshgrid(self.x, self.y, self.z, indexing="ij")).reshape(3, -1)
        cell = np.stack(np.meshgrid(np.arange(nx), np.arange(ny), np.arange(nz), indexing="ij")).reshape(
            3, -1
        )
        element = ElementHexS2()
        offset = np.asarray(element.doflocs[:8], dtype=np.int64)
        vertex = cell[:, None, :] + offset.T[:, :, None]
        table = (vertex[0] * (ny + 1) + vertex[1]) * (nz + 1) + vertex[2]
        return Basis(MeshHex(corners, table), element, intorder=REDUCED_ORDER)

    @cached_property
    def nodes(self) -> FloatArray:
        """Places of the nodes [m], shape (3, nodes)."""
        return np.asarray(self.basis.doflocs, dtype=np.float64)

    @cached_property
    def element_nodes(self) -> IntArray:
        """Nodes of each element, shape (20, elements), in the order of the shape functions."""
        return np.asarray(self.basis.element_dofs, dtype=np.int64)

    def gauss_rule(self, order: int) -> tuple[FloatArray, FloatArray]:
        """Return the local points, shape (3, q), and weights, shape (q,), of a rule exact up to `order`."""
        rule = Basis(self.basis.mesh, self.basis.elem, intorder=order, elements=np.array([0]))
        return np.asarray(rule.X, dtype=np.float64), np.asarray(rule.W, dtype=np.float64)

    def interpolation(self, points: FloatArray, line: int) -> tuple[IntArray, FloatArray]:
        """As the grid's; 20 nodes around each point."""
        _, ny, nz = self.shape
        ix, fx = locate(self.x, points[:, 0])
        iy, fy = locate(self.y, points[:, 1])
        local = np.stack([fx, fy, np.ones_like(fx)])
        return self.element_nodes[:, (ix * ny + iy) * nz + line - 1], shape_functions(local)[0]


def shape_functions(local: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Evaluate the 20 shape functions at local places, shape (3, n), each coordinate from 0 to 1.

    Returns:
        Values, shape (20, n), and gradients, shape (20, 3, n).
    """
    element = ElementHexS2()
    values, gradients = zip(*(element.lbasis(local, i) for i in range(20)), strict=True)
    return np.stack(values), np.stack(gradients)
