"""A solid made of straight tetrahedra or hexahedra, each with a material, held and touched at named faces.

x and y begin at 0 and the highest point has z = 0, as in a block; `placed` moves a mesh there.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from trocar.errors import InputError
from trocar.model import FloatArray, Support
from trocar.tissues.layer import Layer

IntArray = npt.NDArray[np.int64]

LONGEST = 1.0  # [m] a larger tissue is a smaller one in another unit
SHORTEST = 1e-3  # [m]
MOST_CORNERS = 200_000  # a million nodes do not fit into the memory of the machines this is for
_FLAT = 1e-6  # of the mean volume: a flatter element has none

# Corners of the faces, by corners of an element. Hexahedra are numbered as by VTK and meshio: a quadrilateral, and the
# one above it.
_FACES = {
    4: ((0, 1, 2), (0, 1, 3), (0, 2, 3), (1, 2, 3)),
    8: ((0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)),
}
# Corner, and its three neighbours in right-handed order, for the volume spanned there.
_SPANS = {
    4: ((0, 1, 2, 3),),
    8: tuple((i, j, k, n) for i, j, k, n in ((0, 1, 3, 4), (1, 2, 0, 5), (2, 3, 1, 6), (3, 0, 2, 7),
                                             (4, 7, 5, 0), (5, 4, 6, 1), (6, 5, 7, 2), (7, 6, 4, 3))),
}  # fmt: skip


@dataclass(frozen=True, kw_only=True, eq=False)
class Held:
    """Faces that do not move.

    Attributes:
        faces: their corners, shape (k, 3) or (k, 4).
        along: whether their displacement along x, y and z is zero.
    """

    faces: IntArray
    along: tuple[bool, bool, bool] = (True, True, True)


@dataclass(frozen=True, kw_only=True, eq=False)
class SolidMesh:
    """Describe a solid.

    Args:
        corners: places of the nodes [m], shape (n, 3).
        cells: nodes of each element, shape (m, 4) or (m, 8), numbered as by VTK.
        region: which material each element has, shape (m,).
        materials: by number; of a layer that is no slab, the thickness does not matter.
        held: faces that do not move; without any it would float away.
        surfaces: faces that can be pressed or looked at, seen from above, by name; the first is what a tool touches.
        support: what holds it, in the words for blocks.

    Raises:
        InputError: an element is inverted, a node is in none, nothing is held, sizes are those of another unit, or
            arrays do not go together.
    """

    corners: FloatArray
    cells: IntArray
    region: IntArray
    materials: tuple[Layer, ...]
    held: tuple[Held, ...]
    surfaces: Mapping[str, IntArray]
    support: Support = Support.BASE

    def __post_init__(self) -> None:
        if self.corners.ndim != 2 or self.corners.shape[1] != 3 or not np.isfinite(self.corners).all():
            raise InputError("mesh: corners", "finite places, shape (n, 3)", self.corners.shape)
        if self.cells.ndim != 2 or self.cells.shape[1] not in _FACES or len(self.cells) == 0:
            raise InputError(
                "mesh: cells", "tetrahedra or hexahedra, shape (m, 4) or (m, 8)", self.cells.shape
            )
        if len(self.corners) > MOST_CORNERS:
            raise InputError(
                "mesh: corners", f"at most {MOST_CORNERS}", len(self.corners), "mesh it more coarsely"
            )
        if (
            self.region.shape != (len(self.cells),)
            or not np.isin(self.region, np.arange(len(self.materials))).all()
        ):
            raise InputError(
                "mesh: region", f"a number from 0 to {len(self.materials) - 1} for each element", "others"
            )
        self._check_size()
        self._check_elements()
        if not any(len(one.faces) for one in self.held):
            raise InputError(
                "mesh: held", "faces that do not move", "none", "without a support the tissue floats away"
            )
        corners = {4: 3, 8: 4}[self.cells.shape[1]]
        for faces in (*(one.faces for one in self.held), *self.surfaces.values()):
            if faces.ndim != 2 or faces.shape[1] != corners:
                raise InputError(
                    "mesh: faces", f"{corners} corners each, as its elements' faces have", faces.shape
                )
        if not self.surfaces or not all(len(faces) for faces in self.surfaces.values()):
            raise InputError("mesh: surfaces", "a name with faces at least", sorted(self.surfaces))

    @property
    def size(self) -> tuple[float, float]:
        """Extent along x and y [m]."""
        x, y, _ = np.ptp(self.corners, axis=0)
        return float(x), float(y)

    def _check_size(self) -> None:
        extent = np.ptp(self.corners, axis=0)
        if not (extent >= SHORTEST / 100).all() or not SHORTEST <= extent.max() <= LONGEST:
            raise InputError(
                "mesh: size",
                f"a solid, {1e3 * SHORTEST:g} to {1e3 * LONGEST:g} mm long",
                " x ".join(f"{1e3 * side:.4g}" for side in extent) + " mm",
                "is the unit right? lengths are in metres here",
            )

    def _check_elements(self) -> None:
        if self.cells.min() < 0 or self.cells.max() >= len(self.corners):
            worst = int(self.cells.min() if self.cells.min() < 0 else self.cells.max())
            raise InputError("mesh: cells", f"nodes from 0 to {len(self.corners) - 1}", worst)
        used = np.zeros(len(self.corners), dtype=bool)
        used[self.cells.ravel()] = True
        if not used.all():
            raise InputError(
                "mesh: corners",
                "every node in an element",
                f"{int((~used).sum())} in none, the first {int(np.argmin(used))}",
                "remove nodes that no element has",
            )
        volumes = volumes_of(self.corners, self.cells)
        bad = volumes <= _FLAT * np.abs(volumes).mean()
        if bad.any():
            first = int(np.argmax(bad))
            centre = ", ".join(f"{1e3 * x:.4g}" for x in self.corners[self.cells[first]].mean(axis=0))
            raise InputError(
                "mesh: cells",
                "elements with a volume above 0, corners in right-handed order",
                f"{int(bad.sum())} flat or inverted, the first {first}, at ({centre}) mm",
                "repair the mesh; if all are inverted, exchange two corners of each",
            )


def placed(mesh: SolidMesh) -> SolidMesh:
    """Return a mesh moved so that x and y begin at 0 and its highest point has z = 0."""
    low, high = mesh.corners.min(axis=0), mesh.corners.max(axis=0)
    return replace(mesh, corners=mesh.corners - np.array([low[0], low[1], high[2]]))


def volumes_of(corners: FloatArray, cells: IntArray) -> FloatArray:
    """Return the least of the volumes spanned at the corners of each element [m^3], of the element's kind; (m,)."""
    places = corners[cells]
    spans = _SPANS[cells.shape[1]]
    share = 6.0 if cells.shape[1] == 4 else 1.0
    each = [
        np.linalg.det(np.stack([places[:, n] - places[:, i] for n in others], axis=1)) / share
        for i, *others in spans
    ]
    return np.asarray(np.min(each, axis=0))


def outer_faces(cells: IntArray) -> IntArray:
    """Return the corners of the faces that one element alone has, shape (k, 3) or (k, 4)."""
    faces = np.concatenate([cells[:, list(face)] for face in _FACES[cells.shape[1]]])
    _, first, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    return np.asarray(faces[np.sort(first[count == 1])], dtype=np.int64)
