"""What an engine's soft body is made of, over a whole block: tetrahedra of four nodes, or boxes of 8 or 27.

Both lie on grid lines (`Grid`). Tetrahedra are H. Kuhn's (Some combinatorial lemmas in topology, 1960): six a box, all
along its diagonal, so that neighbours fit and every horizontal face is cut from its lowest corner to its highest.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import permutations

import numpy as np
from scipy.sparse import csr_array

from trocar.model import FloatArray, Load, Support
from trocar.reference.block import MeshSize, quarter_mesh
from trocar.reference.footprint import footprint_points
from trocar.reference.grid import Grid, IntArray, locate
from trocar.tissues import Tissue


@dataclass(frozen=True, eq=False)
class Lattice(Grid):
    """Nodes on lines along x, y and z: the grid's, and with order 2 those half way between them too.

    Args:
        x, y, z, slab_layer: as of `Grid`.
        order: of the polynomials along a line, 1 or 2.
    """

    order: int = 1

    @cached_property
    def node_lines(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Lines that carry nodes, along each axis [m]."""
        x, y, z = (self._with_middles(lines) for lines in (self.x, self.y, self.z))
        return x, y, z

    def _with_middles(self, lines: FloatArray) -> FloatArray:
        if self.order == 1:
            return lines
        return np.sort(np.concatenate([lines, 0.5 * (lines[1:] + lines[:-1])]))

    @cached_property
    def nodes(self) -> FloatArray:
        """Places of the nodes [m], shape (3, nodes), z fastest."""
        return np.stack(np.meshgrid(*self.node_lines, indexing="ij")).reshape(3, -1)

    @cached_property
    def held(self) -> np.ndarray[tuple[int, ...], np.dtype[np.bool_]]:
        """Nodes of the base and of the sides, shape (nodes,)."""
        x, y, z = self.nodes
        return (x == self.x[0]) | (x == self.x[-1]) | (y == self.y[0]) | (y == self.y[-1]) | (z == self.z[0])

    def number(self, ix: IntArray, iy: IntArray, iz: IntArray) -> IntArray:
        """Return the numbers of the nodes on node lines ix, iy and iz."""
        _, ny, nz = (len(lines) for lines in self.node_lines)
        return np.asarray((ix * ny + iy) * nz + iz)

    def layer_nodes(self, layer: int) -> IntArray:
        """Return the numbers of a layer's nodes, z fastest."""
        slabs = np.flatnonzero(self.slab_layer == layer)
        nx, ny, _ = (len(lines) for lines in self.node_lines)
        levels = np.arange(self.order * slabs[0], self.order * (slabs[-1] + 1) + 1)
        grid = np.meshgrid(np.arange(nx), np.arange(ny), levels, indexing="ij")
        return self.number(*(part.ravel() for part in grid))

    def masses(self, tissue: Tissue) -> FloatArray:
        """Return the mass lumped in each node [kg], shape (nodes,): every shape function's share of its boxes."""
        density = np.array([tissue.layers[layer].density for layer in self.slab_layer])
        along = (self._shares(lines, np.ones(len(lines) - 1)) for lines in (self.x, self.y))
        x, y = along
        return np.einsum("i,j,k->ijk", x, y, self._shares(self.z, density)).ravel()

    def _shares(self, lines: FloatArray, density: FloatArray) -> FloatArray:
        lengths = density * np.diff(lines)
        shares = np.zeros(self.order * len(lengths) + 1)
        weights = (1 / 2, 1 / 2) if self.order == 1 else (1 / 6, 4 / 6, 1 / 6)
        for place, weight in enumerate(weights):
            shares[place : place + self.order * len(lengths) : self.order] += weight * lengths
        return shares

    def interpolation(self, points: FloatArray, line: int) -> tuple[IntArray, FloatArray]:
        """As the grid's; every node of the box's upper face."""
        (ix, fx), (iy, fy) = locate(self.x, points[:, 0]), locate(self.y, points[:, 1])
        along, across = self._shapes(fx), self._shapes(fy)
        numbers, weights = [], []
        for i in range(self.order + 1):
            for j in range(self.order + 1):
                level = np.full_like(ix, self.order * line)
                numbers.append(self.number(self.order * ix + i, self.order * iy + j, level))
                weights.append(along[i] * across[j])
        return np.stack(numbers), np.stack(weights)

    def _shapes(self, at: FloatArray) -> list[FloatArray]:
        if self.order == 1:
            return [1 - at, at]
        return [(1 - at) * (1 - 2 * at), 4 * at * (1 - at), at * (2 * at - 1)]

    def surface(self, points: FloatArray, layer: int = 0) -> csr_array:
        """Return what turns nodal values into values on a layer's upper face, shape (points, nodes)."""
        numbers, weights = self.interpolation(points, self.upper_face(layer))
        rows = np.broadcast_to(np.arange(len(points)), numbers.shape)
        return csr_array(
            (weights.ravel(), (rows.ravel(), numbers.ravel())), shape=(len(points), self.nodes.shape[1])
        )

    def forces(self, load: Load) -> FloatArray:
        """Return the nodal forces of presses straight down [N], shape (nodes, 3)."""
        result = np.zeros((self.nodes.shape[1], 3))
        for press in load:
            points, shares = footprint_points(press, self.x, self.y)
            result[:, 2] -= press.force * (shares @ self.surface(points))
        return result


@dataclass(frozen=True, eq=False)
class Tetrahedra(Lattice):
    """The same nodes, order 1, with six tetrahedra in every box."""

    @cached_property
    def tetrahedra(self) -> IntArray:
        """Nodes of each, shape (elements, 4); from the fourth the first three are seen clockwise."""
        corners = np.stack(np.meshgrid(*(np.arange(count) for count in self.shape), indexing="ij")).reshape(
            3, -1
        )
        found = []
        for axes in permutations(range(3)):
            steps = np.zeros((4, 3), dtype=np.int64)
            for place, axis in enumerate(axes, start=1):
                steps[place] = steps[place - 1]
                steps[place, axis] += 1
            if np.linalg.det(np.diff(steps, axis=0)) < 0:
                steps[[1, 2]] = steps[[2, 1]]
            found.append(np.stack([self.number(*(corners + step[:, None])) for step in steps], axis=1))
        return np.stack(found, axis=1).reshape(-1, 4)

    @cached_property
    def tetrahedron_layer(self) -> IntArray:
        """The layer of each, shape (elements,)."""
        return np.repeat(self.element_layer, 6)

    def masses(self, tissue: Tissue) -> FloatArray:
        """Return the mass lumped in each node [kg], shape (nodes,): a quarter of its tetrahedra."""
        a, b, c, d = (self.nodes[:, self.tetrahedra[:, i]].T for i in range(4))
        volume = np.einsum("ni,ni->n", b - a, np.cross(c - a, d - a)) / 6
        density = np.array([layer.density for layer in tissue.layers])[self.tetrahedron_layer]
        result = np.zeros(self.nodes.shape[1])
        np.add.at(result, self.tetrahedra, (density * volume / 4)[:, None])
        return result

    def interpolation(self, points: FloatArray, line: int) -> tuple[IntArray, FloatArray]:
        """As the grid's; the three nodes of the triangle."""
        (ix, fx), (iy, fy) = locate(self.x, points[:, 0]), locate(self.y, points[:, 1])
        level = np.full_like(ix, line)
        beside = (fx >= fy).astype(np.int64)  # below the cut: by way of the next x line
        numbers = [
            self.number(ix, iy, level),
            self.number(ix + beside, iy + 1 - beside, level),
            self.number(ix + 1, iy + 1, level),
        ]
        low, high = np.minimum(fx, fy), np.maximum(fx, fy)
        return np.stack(numbers), np.stack([1 - high, high - low, low])


def graded(tissue: Tissue, size: tuple[float, float], around: Load, per_radius: float) -> Tetrahedra:
    """Cut the whole block into tetrahedra, fine under the tool as the finite elements of `trocar bench models`."""
    wished = MeshSize(
        per_radius=per_radius, growth=1.2 / per_radius, top=0.8 / per_radius, deepening=1.4 / per_radius
    )
    quarter = quarter_mesh(tissue, size, Support.BASE, around, wished)
    x, y = (
        np.concatenate([lines, (side - lines)[-2::-1]])
        for lines, side in zip((quarter.x, quarter.y), size, strict=True)
    )
    return Tetrahedra(x=x, y=y, z=quarter.z, slab_layer=quarter.slab_layer)


def even(tissue: Tissue, size: tuple[float, float], across: int, order: int) -> Lattice:
    """Cut the whole block into boxes, evenly: `across` a side, and in each layer about as high as wide."""
    width = min(size) / across
    levels, slabs = [0.0], []
    for number, layer in enumerate(tissue.layers):
        count = max(1, round(layer.thickness / width))
        levels += list(levels[-1] - layer.thickness * np.arange(1, count + 1) / count)
        slabs += [number] * count
    x, y = (np.linspace(0.0, side, across + 1) for side in size)
    return Lattice(x=x, y=y, z=np.array(levels[::-1]), slab_layer=np.array(slabs[::-1]), order=order)
