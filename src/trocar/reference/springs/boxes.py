"""The lattice's grid: boxes with a mass at each corner."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from trocar.model import FloatArray
from trocar.reference.grid import Grid, IntArray, locate


@dataclass(frozen=True, eq=False)
class Boxes(Grid):
    """Boxes with nodes at their corners, numbered as the boxes are: z fastest, then y, then x."""

    @cached_property
    def nodes(self) -> FloatArray:
        """Places of the nodes [m], shape (3, nodes)."""
        return np.stack(np.meshgrid(self.x, self.y, self.z, indexing="ij")).reshape(3, -1)

    @property
    def strides(self) -> tuple[int, int, int]:
        """By how much a node's number grows from one node to the next along x, y and z."""
        _, ny, nz = self.shape
        return (ny + 1) * (nz + 1), nz + 1, 1

    def first_nodes(self, counts: tuple[int, int, int]) -> IntArray:
        """Return the numbers of the first so many nodes along x, y and z, shape (product of counts,)."""
        ranges = [stride * np.arange(count) for stride, count in zip(self.strides, counts, strict=True)]
        return np.asarray(sum(np.meshgrid(*ranges, indexing="ij"))).ravel()

    def interpolation(self, points: FloatArray, line: int) -> tuple[IntArray, FloatArray]:
        """As the grid's; 4 nodes around each point, bilinear."""
        ix, fx = locate(self.x, points[:, 0])
        iy, fy = locate(self.y, points[:, 1])
        along, across, _ = self.strides
        first = ix * along + iy * across + line
        nodes = np.stack([first, first + along, first + across, first + along + across])
        weights = np.stack([(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy])
        return nodes, weights
