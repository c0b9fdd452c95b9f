"""What is asked of a block from outside: the nodal forces of presses, and fields at points of its faces.

Moving least squares do not pass through their nodes' parameters, so a press is spread over nodes by the shape functions
integrated over its footprint, and a displacement is their sum.
"""

from __future__ import annotations

import numpy as np

from trocar.errors import InputError
from trocar.model import FloatArray, Load, Press
from trocar.reference.footprint import footprint_points
from trocar.reference.mesh_free.body import Body
from trocar.reference.parity import QUARTERS, fold, mirrored_lines

_KEPT_PRESSES = 16  # each an array of the size of the nodes


class TopFace:
    """The face under the tools.

    Args:
        body: of the whole block, or of a quarter.
        size: sides of the block [m].
    """

    def __init__(self, body: Body, size: tuple[float, float]) -> None:
        self._body, self._size = body, size
        self._units: dict[Press, FloatArray] = {}

    def forces(self, load: Load) -> FloatArray:
        """Return the nodal forces of a load [N], shape (nodes, 3).

        Raises:
            InputError: a footprint is not wholly on the block, or not in the middle of a mirrored one.
        """
        total = np.zeros_like(self._body.cloud.places)
        for press in load:
            total += press.force * self._unit(press.with_force(1.0))
        return total

    def interpolated(self, points: FloatArray, layer: int, field: FloatArray) -> FloatArray:
        """Return a field of the nodes at points of a layer's upper face, shape (n, 3).

        Args:
            points: places [m], shape (n, 2 or 3); only x and y are used.
            layer: its number, from the top.
            field: shape (nodes, 3).

        Raises:
            InputError: a point is off the block.
        """
        folded, images = fold(points, self._size)
        if not self._body.mirrored:
            return np.asarray(self._body.interpolation(np.asarray(points), layer) @ field)
        found = self._body.interpolation(folded, layer) @ field
        found[:, :2] *= 1 - 2 * images
        return np.asarray(found)

    def _unit(self, press: Press) -> FloatArray:
        if press not in self._units:
            if len(self._units) >= _KEPT_PRESSES:
                self._units.pop(next(iter(self._units)))
            self._units[press] = self._integrated(press)
        return self._units[press]

    def _integrated(self, press: Press) -> FloatArray:
        lines = self._body.cloud.x, self._body.cloud.y
        if not self._body.mirrored:
            points, shares = footprint_points(press, *lines)
            return np.outer(self._body.interpolation(points, 0).T @ shares, press.force_vector)
        middle = tuple(0.5 * side for side in self._size)
        if press.tilt or not np.allclose((press.x, press.y), middle, rtol=0, atol=1e-9 * max(self._size)):
            raise InputError(
                "press",
                f"an upright one at ({middle[0]:g}, {middle[1]:g}) m for a mirrored model",
                press,
                "leave `mirrored` out",
            )
        halves = zip(lines, self._size, strict=True)
        points, shares = footprint_points(press, *(mirrored_lines(half, side) for half, side in halves))
        spread = self._body.interpolation(fold(points, self._size)[0], 0).T @ shares
        return np.outer(spread / len(QUARTERS), press.force_vector)
