"""What an organ of a scene looks like: its surface on a grid of nodes as seen from above, and the faces beside that.

To what the sites have sunk by come the near field under each tip and the way along with friction, as on a block
(`simulation.surface`). The surface moves along its normals.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from trocar.model import FloatArray
from trocar.simulation.organ import Organ
from trocar.simulation.scene import Scene
from trocar.simulation.step import DRAG, FORCE, PLACE
from trocar.simulation.surface import LEAST, REACH
from trocar.waves.in_plane import InPlane
from trocar.waves.mesh.faces import among, outward_faces
from trocar.waves.mesh.mesh_tick import MeshTick, sunk_sites
from trocar.waves.mesh.press_grid import cubic_table
from trocar.waves.near_field import SMOOTH, half_space, near_field

# Of the force under a tip, one standard deviation in its mean semi-axis: a tip deep in a soft organ presses with all of
# its patch, whose dent at the middle is that of a Gaussian so wide (a rigid disc's; Johnson 1985, section 3.7).
_WIDTH = 0.55
_HALVINGS = 12  # of the way between two nodes, to find the outline
_WAVES = 2 * SMOOTH  # the shortest in-plane wave that is drawn is some twice as long


class OrganSurface:
    """The surface of an organ on a grid over its rectangle.

    Args:
        scene: parameters.
        organ: it is made of.
        grid: nodes along x and y.

    Attributes:
        rim: numbers of the nodes that lie beside the organ and were drawn to its outline.
    """

    def __init__(self, scene: Scene, organ: Organ, *, grid: tuple[int, int]) -> None:
        assert isinstance(scene.tick, MeshTick)
        self._tick, self._organ, self._grid = scene.tick, organ, grid
        self._x, self._y = (np.linspace(0.0, side, n) for side, n in zip(organ.size, grid, strict=True))
        even = np.stack(np.meshgrid(self._x, self._y, indexing="xy"), axis=-1)
        nodes, self.rim = _drawn_to_outline(even, self._heights)
        self._table: sp.csr_array = cubic_table(organ.grid, nodes)
        self._places = np.column_stack([nodes, self._heights(nodes)])
        normals = self._table @ organ.grid.normals
        size = np.linalg.norm(normals, axis=1, keepdims=True)
        self._normals = np.divide(normals, size, out=np.zeros_like(normals), where=size > 0)
        self._near = [
            near_field(
                half_space(organ.skin),
                pad=width,
                window=organ.grid.window,
                reach=REACH * organ.grid.window,
            )
            for width in (_WIDTH * np.prod(scene.axes, axis=1) ** (1 / 3)).tolist()
        ]
        modes = tuple(int(np.ceil(side / _WAVES)) for side in organ.size)
        self._in_plane = InPlane(
            organ.block, size=organ.size, modes=(modes[0], modes[1]), radius=2 * SMOOTH, x=self._x, y=self._y
        )

    @property
    def rest(self) -> FloatArray:
        """Heights of the nodes at rest [m], NaN where nothing is drawn, shape (ny, nx)."""
        return self._places[:, 2].reshape(self._grid[::-1])

    @property
    def rim_places(self) -> FloatArray:
        """Where on the outline those of `rim` lie [m], shape (n, 2)."""
        places: FloatArray = self._places[self.rim, :2]
        return places

    def _heights(self, points: FloatArray) -> FloatArray:
        return self._organ.model.elements.heights(self._organ.grid.surface, points)

    @cached_property
    def sides(self) -> tuple[FloatArray, FloatArray, NDArray[np.int64]]:
        """Faces that are no part of the grid: their corners [m], shape (n, 3), normals there, triangles, shape (k, 3).

        The normals are the mean ones of all faces that meet, so that the organ looks round where sides meet the grid.
        """
        mesh = self._organ.model.mesh
        faces, outward = outward_faces(mesh.corners, mesh.cells)
        triangles = faces if faces.shape[1] == 3 else np.concatenate([faces[:, :3], faces[:, [0, 2, 3]]])
        column, row = (
            np.clip(np.rint(mesh.corners[triangles, axis] / side * (n - 1)).astype(int), 0, n - 1)
            for axis, (side, n) in enumerate(zip(self._organ.size, self._grid, strict=True))
        )
        touched = among(faces, mesh.surfaces[self._organ.grid.surface])
        touched = touched if faces.shape[1] == 3 else np.tile(touched, 2)
        drawn = touched & np.isfinite(self.rest[row, column]).all(axis=1)
        used, numbers = np.unique(triangles[~drawn], return_inverse=True)
        normals = np.zeros_like(mesh.corners)
        for corner in range(faces.shape[1]):
            np.add.at(normals, faces[:, corner], outward)
        normals = normals[used] / np.linalg.norm(normals[used], axis=1, keepdims=True)
        return mesh.corners[used], normals, numbers.reshape(-1, 3).astype(np.int64)

    def moved(
        self, amplitudes: FloatArray, records: FloatArray
    ) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
        """Return u_z [m], shape (1, ny, nx), and u_x and u_y [m], shape (2, ny, nx), at the nodes.

        Args:
            amplitudes: what the picture is made of (`amplitudes`), shape (1, 1, N).
            records: of both instruments (`advance`), shape (2, RECORD).
        """
        sunk = self._table @ sunk_sites(self._tick, np.asarray(amplitudes, dtype=np.float64))
        along = np.zeros((2, *self._grid[::-1]))
        for record, near in zip(records, self._near, strict=True):
            x, y = record[PLACE : PLACE + 2].tolist()
            drag = float(record[DRAG]), float(record[DRAG + 1])
            if max(map(abs, drag)) >= LEAST:
                along += self._in_plane.under(x, y, drag)
            centre = int(
                np.rint(y / self._organ.size[1] * (self._grid[1] - 1)) * self._grid[0]
                + np.rint(x / self._organ.size[0] * (self._grid[0] - 1))
            )
            force = float(record[FORCE : FORCE + 3] @ self._normals[centre])
            if abs(force) < LEAST:
                continue
            away = np.linalg.norm(self._places - self._place_at(x, y), axis=1)
            close = np.flatnonzero(away < near.radii[-1])  # never of a node that is not drawn
            sunk[close] += force * near.at(away[close])[:, 0]
        moved = -sunk[:, None] * self._normals
        in_plane = along + moved[:, :2].T.reshape(along.shape)
        return (
            moved[:, 2].reshape(1, *self._grid[::-1]).astype(np.float32),
            in_plane.astype(np.float32),
        )

    def _place_at(self, x: float, y: float) -> FloatArray:
        """Return the place of the surface at x, y [m]."""
        height = cubic_table(self._organ.grid, np.array([[x, y]])) @ self._organ.grid.places[:, 2]
        return np.array([x, y, float(height[0])])


def _drawn_to_outline(
    even: FloatArray, heights: Callable[[FloatArray], FloatArray]
) -> tuple[FloatArray, NDArray[np.int64]]:
    """Draw the nodes next beside a surface to its outline, so that what is drawn of it ends there and not at a node.

    Args:
        even: the nodes of a grid [m], shape (ny, nx, 2).
        heights: of the surface at points, NaN beside it.

    Returns:
        All nodes, shape (ny nx, 2), and the numbers of those that were drawn.
    """
    ny, nx, _ = even.shape
    on = np.isfinite(heights(even.reshape(-1, 2))).reshape(ny, nx)
    wide, places = np.pad(on, 1), np.pad(even, ((1, 1), (1, 1), (0, 0)))
    about = [(j, i) for j in range(3) for i in range(3) if (j, i) != (1, 1)]
    beside = np.stack([wide[j : j + ny, i : i + nx] for j, i in about])
    at = np.stack([places[j : j + ny, i : i + nx] for j, i in about])
    count = beside.sum(axis=0)
    rim = np.flatnonzero((~on & (count > 0)).ravel())
    nodes = even.reshape(-1, 2).copy()
    inner = (beside[..., None] * at).sum(axis=0).reshape(-1, 2)[rim] / count.ravel()[rim, None]
    nearest = at[np.argmax(beside, axis=0), *np.indices((ny, nx))].reshape(-1, 2)[rim]
    inner = np.where(
        np.isfinite(heights(inner))[:, None], inner, nearest
    )  # the outline may bend between them
    outer = nodes[rim]
    for _ in range(_HALVINGS):
        middle = (inner + outer) / 2
        within = np.isfinite(heights(middle))[:, None]
        inner, outer = np.where(within, middle, inner), np.where(within, outer, middle)
    nodes[rim] = inner
    return nodes, rim
