"""What a scene's tissue looks like: every layer's upper face on a grid of nodes, from the waves and the instruments.

To the waves come what is too short for them, the near field under each tip, and the top face's way along with friction;
both follow from the records of the instruments. Nothing is exaggerated.
"""

from __future__ import annotations

from functools import partial

import numpy as np
from numpy.typing import NDArray

from trocar.model import FloatArray
from trocar.simulation.scene import Scene
from trocar.simulation.step import DRAG, FORCE, PLACE
from trocar.tissues.tissue import Tissue
from trocar.waves.in_plane import InPlane
from trocar.waves.near_field import SMOOTH, layered_compliance, near_field

REACH = 4.0  # of the near field that is drawn, in windows
_WIDTH = 0.25  # of the force under a tip, one standard deviation in its mean semi-axis: half a patch
LEAST = 1e-6  # [N] a smaller force is not drawn


class Surface:
    """The faces of a scene on a grid from edge to edge.

    Args:
        scene: parameters.
        tissue: its layers.
        size: sides of the block [m].
        grid: nodes along x and y.
    """

    def __init__(
        self, scene: Scene, tissue: Tissue, *, size: tuple[float, float], grid: tuple[int, int]
    ) -> None:
        self._x, self._y = (np.linspace(0.0, side, nodes) for side, nodes in zip(size, grid, strict=True))
        rows, columns = scene.modes
        self._along = np.sin(np.outer(np.arange(1, rows + 1) * (np.pi / size[0]), self._x))
        self._across = np.sin(np.outer(np.arange(1, columns + 1) * (np.pi / size[1]), self._y))
        self._near = [
            near_field(
                partial(layered_compliance, tissue, base_held=True, finest=width),
                pad=width,
                window=SMOOTH,
                reach=REACH * SMOOTH,
            )
            for width in (_WIDTH * np.prod(scene.axes, axis=1) ** (1 / 3)).tolist()
        ]
        self._in_plane = InPlane(
            tissue, size=size, modes=scene.modes, radius=2 * SMOOTH, x=self._x, y=self._y
        )

    def moved(
        self, amplitudes: FloatArray, records: FloatArray
    ) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
        """Return u_z of every layer's upper face [m], shape (layers, ny, nx), and u_x and u_y of the top face [m].

        Args:
            amplitudes: of the waves (`amplitudes`) [m], shape (layers, M, N).
            records: of both instruments (`advance`), shape (2, RECORD).
        """
        return self.heights(amplitudes, records), self.in_plane(records)

    def heights(self, amplitudes: FloatArray, records: FloatArray) -> NDArray[np.float32]:
        """Return u_z of every layer's upper face [m], shape (layers, ny, nx), top first.

        Args:
            amplitudes: of the waves (`amplitudes`) [m], shape (layers, M, N).
            records: of both instruments (`advance`), shape (2, RECORD).
        """
        faces = np.ascontiguousarray(self._across.T @ np.swapaxes(amplitudes, 1, 2) @ self._along)
        for record, near in zip(records, self._near, strict=True):
            force, (x, y) = record[FORCE + 2], record[PLACE : PLACE + 2]
            if abs(force) < LEAST:
                continue
            reach = near.radii[-1]
            rows = slice(*np.searchsorted(self._y, (y - reach, y + reach)))
            columns = slice(*np.searchsorted(self._x, (x - reach, x + reach)))
            away = np.hypot(self._x[columns] - x, self._y[rows, None] - y)
            faces[:, rows, columns] -= force * np.moveaxis(near.at(away), 2, 0)
        return faces.astype(np.float32)

    def in_plane(self, records: FloatArray) -> NDArray[np.float32]:
        """Return u_x and u_y of the top face [m], shape (2, ny, nx).

        Args:
            records: of both instruments (`advance`), shape (2, RECORD).
        """
        total = np.zeros((2, len(self._y), len(self._x)))
        for record in records:
            drag = float(record[DRAG]), float(record[DRAG + 1])
            if max(map(abs, drag)) >= LEAST:
                total += self._in_plane.under(float(record[PLACE]), float(record[PLACE + 1]), drag)
        return total.astype(np.float32)
