"""Tensor-product grids: graded lines over a block, or a part of it, and the boxes between them.

Boxes are numbered with z fastest, then y, then x. The 3 components of a node's vector are stored as the 3 rows of an
array of shape (3, nodes); flattened, component i of node n is unknown i * nodes + n. Which nodes a box has is its
kind's choice.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cached_property
from typing import TypeVar

import numpy as np
import numpy.typing as npt

from trocar.model import FloatArray

IntArray = npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Grid(ABC):
    """Boxes between grid lines.

    Args:
        x, y, z: grid lines [m], ascending.
        slab_layer: the layer of each slab between two z lines, shape (len(z) - 1,).
    """

    x: FloatArray
    y: FloatArray
    z: FloatArray
    slab_layer: IntArray

    @property
    def shape(self) -> tuple[int, int, int]:
        """Number of elements along x, y and z."""
        return len(self.x) - 1, len(self.y) - 1, len(self.z) - 1

    @property
    @abstractmethod
    def nodes(self) -> FloatArray:
        """Places of the nodes [m], shape (3, nodes)."""

    @abstractmethod
    def interpolation(self, points: FloatArray, line: int) -> tuple[IntArray, FloatArray]:
        """Return the nodes around points on a z line, and their shape functions there.

        Args:
            points: places within the mesh [m], shape (n, 2).
            line: number of the z line, above the lowest.

        Returns:
            Nodes and weights, both of shape (k, n); a field's value is sum(field[nodes] * weights).
        """

    @cached_property
    def edges(self) -> FloatArray:
        """Edge lengths of each element [m], shape (3, elements)."""
        lengths = np.meshgrid(np.diff(self.x), np.diff(self.y), np.diff(self.z), indexing="ij")
        return np.stack(lengths).reshape(3, -1)

    @cached_property
    def element_layer(self) -> IntArray:
        """The layer of each element, shape (elements,)."""
        nx, ny, _ = self.shape
        return np.tile(self.slab_layer, nx * ny)

    @cached_property
    def centres(self) -> FloatArray:
        """Middles of the elements [m], shape (3, elements)."""
        middles = [0.5 * (lines[1:] + lines[:-1]) for lines in (self.x, self.y, self.z)]
        return np.stack(np.meshgrid(*middles, indexing="ij")).reshape(3, -1)

    def upper_face(self, layer: int) -> int:
        """Return the number of the z line that is a layer's upper face."""
        return int(np.flatnonzero(self.slab_layer == layer)[-1]) + 1


G = TypeVar("G", bound=Grid)


def locate(lines: FloatArray, places: FloatArray) -> tuple[IntArray, FloatArray]:
    """Return the interval that holds each place, and where in it the place lies, 0 to 1."""
    interval = np.clip(np.searchsorted(lines, places, side="right") - 1, 0, len(lines) - 2)
    return interval, (places - lines[interval]) / (lines[interval + 1] - lines[interval])
