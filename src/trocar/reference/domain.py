"""The part of the block that is solved where parities mix: a quarter, a half or all of it.

Large deformation couples the parities of `trocar.reference.parity`: the square of an odd field is even. But what is
even under a mirror stays even, so half the block is enough for loads that are even under one mirror and a quarter for
those even under both (a bifurcation that breaks the symmetry is not seen then). States stay sums of parities on
the quarter, so that everything that reads them is the linear model's.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import product
from typing import Generic

import numpy as np
import numpy.typing as npt

from trocar.model import FloatArray, Support
from trocar.reference.block import held_by_support
from trocar.reference.grid import G, Grid, IntArray
from trocar.reference.ordering import dissection_order, half_index
from trocar.reference.parity import Parity, held_on_mirrors, mirror_signs, mirrored_lines


@dataclass(frozen=True, eq=False)
class Domain(Generic[G]):
    """A part of the block, its mesh the quarter's with mirror images.

    Args:
        quarter: the quarter's mesh.
        size: sides of the block [m].
        whole: along x, along y: whether both halves are in it.
        support: how the block is held.
    """

    quarter: G
    size: tuple[float, float]
    whole: tuple[bool, bool]
    support: Support

    @cached_property
    def grid(self) -> G:
        """The mesh; on an axis that is not whole it ends at the mirror plane."""
        quarter = self.quarter
        if not any(self.whole):
            return quarter
        x, y = (
            mirrored_lines(lines, side) if whole else lines
            for lines, side, whole in zip((quarter.x, quarter.y), self.size, self.whole, strict=True)
        )
        return replace(quarter, x=x, y=y)

    @property
    def copies(self) -> int:
        """How many of these parts make up the block."""
        return 4 // len(self._quarters)

    @cached_property
    def held(self) -> npt.NDArray[np.bool_]:
        """Which displacement components support and mirror planes hold at zero, shape (3, nodes)."""
        here = self._spread_flags(held_by_support(self.quarter, self.support))
        mirrors = held_on_mirrors(self.quarter, Parity(1, 1))
        for axis, whole in enumerate(self.whole):
            if not whole:
                here[axis] |= self._spread_flags(mirrors)[axis]
        return here

    @cached_property
    def supported(self) -> npt.NDArray[np.bool_]:
        """Which components the support holds, shape (3, nodes)."""
        return self._spread_flags(held_by_support(self.quarter, self.support))

    @cached_property
    def free(self) -> IntArray:
        """The unknowns in the order of their elimination, component i of node n being i * nodes + n."""
        nodes = dissection_order(self.grid)
        order = (nodes[:, None] + len(nodes) * np.arange(3)).ravel()
        free: IntArray = order[~self.held.ravel()[order]]
        return free

    def field(self, parts: Mapping[Parity, FloatArray]) -> FloatArray:
        """Return the displacement [m], shape (3, nodes), that the parts of a state add up to."""
        result = np.zeros(self.grid.nodes.shape)
        for quarter, nodes in self._twins.items():
            result[:, nodes] = self._quarter_sum(parts, quarter)
        return result

    def forces(self, parts: Mapping[Parity, FloatArray]) -> FloatArray:
        """Return the nodal forces [N], shape (3, nodes), of parts as `NodalForces` gives them."""
        result = np.zeros(self.grid.nodes.shape)
        for quarter, nodes in self._twins.items():
            result[:, nodes] += self._quarter_sum(parts, quarter)  # on a mirror plane both sides add up
        return result

    def parts(self, field: FloatArray) -> dict[Parity, FloatArray]:
        """Return a field [m], shape (3, nodes), as parts on the quarter, the inverse of `field`."""
        signs = (1, -1)
        found = {}
        for x, y in product(signs[: 1 + self.whole[0]], signs[: 1 + self.whole[1]]):
            parity, total = Parity(x, y), np.zeros(self.quarter.nodes.shape)
            for quarter, nodes in self._twins.items():
                factors = mirror_signs(parity, np.array([quarter]))
                total += factors * field[:, nodes]
            found[parity] = total / len(self._twins)
        return found

    def _quarter_sum(self, parts: Mapping[Parity, FloatArray], quarter: tuple[int, int]) -> FloatArray:
        total = np.zeros(self.quarter.nodes.shape)
        for parity, part in parts.items():
            total += mirror_signs(parity, np.array([quarter])) * part
        return total

    @property
    def _quarters(self) -> list[tuple[int, int]]:
        return list(product(range(1 + self.whole[0]), range(1 + self.whole[1])))

    @cached_property
    def _twins(self) -> dict[tuple[int, int], IntArray]:
        """The node here that is each quarter node's mirror image, by quarter."""
        grid = self.grid
        shape = tuple(2 * count + 1 for count in grid.shape)
        number = np.full(shape, -1, dtype=np.int64)
        number[_places(grid)] = np.arange(grid.nodes.shape[1])
        x, y, z = _places(self.quarter)
        return {
            (in_x, in_y): number[shape[0] - 1 - x if in_x else x, shape[1] - 1 - y if in_y else y, z]
            for in_x, in_y in self._quarters
        }

    def _spread_flags(self, flags: npt.NDArray[np.bool_]) -> npt.NDArray[np.bool_]:
        result = np.zeros(self.grid.nodes.shape, dtype=np.bool_)
        for nodes in self._twins.values():
            result[:, nodes] |= flags
        return result


def wholes(parities: Iterable[Parity]) -> tuple[bool, bool]:
    """Return along which axes both halves are needed, for parts of these parities."""
    kinds = tuple(parities)
    return any(parity.x < 0 for parity in kinds), any(parity.y < 0 for parity in kinds)


def _places(grid: Grid) -> tuple[IntArray, IntArray, IntArray]:
    x, y, z = (
        half_index(lines, nodes) for lines, nodes in zip((grid.x, grid.y, grid.z), grid.nodes, strict=True)
    )
    return x, y, z
