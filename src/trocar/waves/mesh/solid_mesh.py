"""A solid made of straight tetrahedra or hexahedra, each with a material, held and touched at named faces.

x and y begin at 0 and the highest point has z = 0, as in a block; `placed` moves a mesh there.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import numpy.typing as npt

from trocar.errors import InputError
from trocar.model import FloatArray, Support
from trocar.tissues.layer import Layer
from trocar.waves.mesh.parts import parts

IntArray = npt.NDArray[np.int64]

LONGEST = 1.0  # [m] a larger tissue is a smaller one in another unit
SHORTEST = 1e-3  # [m]
MOST_CORNERS = 200_000  # a million nodes do not fit into the memory of the machines this is for
_FLAT = 1e-6  # of the mean volume: a flatter element has none

# Corners of the faces, by corners of an element. Hexahedra are numbered as by VTK and meshio: a quadrilateral, and the
# one above it.
FACES = {
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
        if self.cells.ndim != 2 or self.cells.shape[1] not in FACES or len(self.cells) == 0:
            raise InputError(
                "mesh: cells", "tetrahedra or hexahedra, shape (m, 4) or (m, 8)", self.cells.shape
            )
        if len(self.corners) > MOST_CORNERS:
            raise InputError(
                "mesh: corners",
                f"at most {MOST_CORNERS}",
                len(self.corners),
                "make larger elements: 10,000 are a whole organ",
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
        self._check_pieces()
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

    @classmethod
    def read(
        cls,
        path: Path | str,
        materials: Layer | Mapping[str, Layer],
        *,
        unit: str = "mm",
        up: str = "+z",
        held: str | Sequence[str] = "below",
        touched: str = "above",
        spacing: float | None = None,
        drop_unused: bool = False,
    ) -> SolidMesh:
        """Read a file of tetrahedra or hexahedra, or fill a closed surface with tetrahedra.

        Args:
            path: a .vtk, .vtu, .msh, .inp, .mesh, .bdf or .nas file; of surfaces also .stl, .obj, .ply and .off.
            materials: one for all, or by the names of the file's regions (physical groups, element sets, numbers).
            unit: of the file's lengths: m, cm, mm or um.
            up: which axis of the file looks up: +z, -z, +y, -y, +x or -x.
            held: groups of faces or nodes that do not move; "below": faces within 45 degrees of looking down.
            touched: the group of faces that can be pressed; "above": all that are seen from above.
            spacing: of the tetrahedra that fill a surface [m]; None takes a twenty-fourth of its longest side.
            drop_unused: leave out nodes that no element has.

        Raises:
            InputError: the file cannot be read, or what it says cannot be a tissue.
        """
        from trocar.waves.mesh.reading import read_mesh  # noqa: PLC0415 - it makes what this module defines

        return read_mesh(
            Path(path),
            materials,
            unit=unit,
            up=up,
            held=held,
            touched=touched,
            spacing=spacing,
            drop_unused=drop_unused,
        )

    @property
    def size(self) -> tuple[float, float]:
        """Extent along x and y [m]."""
        x, y, _ = np.ptp(self.corners, axis=0)
        return float(x), float(y)

    @property
    def thickness(self) -> float:
        """From the lowest to the highest point [m]."""
        return float(np.ptp(self.corners[:, 2]))

    def _check_size(self) -> None:
        extent = np.ptp(self.corners, axis=0)
        if not (extent >= SHORTEST / 100).all() or not SHORTEST <= extent.max() <= LONGEST:
            raise InputError(
                "mesh: size",
                f"a solid, {1e3 * SHORTEST:g} to {1e3 * LONGEST:g} mm long",
                " x ".join(f"{1e3 * side:.4g}" for side in extent) + " mm",
                "is the unit right? lengths are in metres here",
            )

    def _check_pieces(self) -> None:
        piece = parts(self.cells, len(self.corners))
        if piece.max() > 0:
            lost = self.corners[self.cells[piece == 1]].mean(axis=(0, 1))
            raise InputError(
                "mesh: cells",
                "one piece, whose elements share nodes",
                f"{int(piece.max()) + 1} pieces, the second of {int((piece == 1).sum())} elements about {shown(lost)}",
                "merge nodes at the same place in the program that made it, or leave the smaller pieces out",
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
                "remove nodes that no element has (SolidMesh.read: pass drop_unused=True)",
            )
        volumes = volumes_of(self.corners, self.cells)
        bad = volumes <= _FLAT * np.abs(volumes).mean()
        if bad.any():
            first = int(np.argmax(bad))
            centre = shown(self.corners[self.cells[first]].mean(axis=0))
            raise InputError(
                "mesh: cells",
                "elements with a volume above 0, corners in right-handed order",
                f"{int(bad.sum())} flat or inverted, the first {first}, at {centre}",
                "repair the mesh; if all are inverted, exchange two corners of each",
            )


def shown(place: FloatArray) -> str:
    """Return a place [m] in millimetres, as messages show it."""
    return "(" + ", ".join(f"{1e3 * x:.4g}" for x in place) + ") mm"


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
