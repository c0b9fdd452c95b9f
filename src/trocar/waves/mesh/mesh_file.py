"""What a mesh file says: nodes, elements and named groups of them, through meshio.

Quadratic elements give their corners; their edges become straight.
"""

from __future__ import annotations

import io
from collections.abc import Iterator
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from trocar.errors import InputError
from trocar.model import FloatArray
from trocar.waves.mesh.solid_mesh import MOST_CORNERS, IntArray

ENDINGS = (".vtk", ".vtu", ".msh", ".inp", ".mesh", ".bdf", ".nas", ".stl", ".obj", ".ply", ".off")
LARGEST_FILE = 500_000_000  # [bytes] of text: far above what so many nodes as are allowed take

_SOLID = {"tetra": 4, "tetra10": 4, "hexahedron": 8, "hexahedron20": 8, "hexahedron27": 8}
_FLAT = {"triangle": 3, "triangle6": 3, "quad": 4, "quad8": 4, "quad9": 4}
_THIN = ("vertex", "line", "line3")  # gmsh writes points and curves too
_NUMBERS = ("gmsh:physical", "medit:ref", "nastran:ref", "region", "material", "MaterialIDs")


@dataclass(frozen=True, kw_only=True)
class MeshFile:
    """What is in a file, in its own unit.

    Attributes:
        points: shape (n, 3).
        cells: corners of the solid elements, shape (m, 4) or (m, 8); (0, 4) where there are none.
        mentioned: which points solid elements have, middles of edges too, shape (n,).
        regions: numbers of elements, by name.
        faces: corners of triangles or quadrilaterals, by name.
        triangles: all triangles, shape (k, 3).
        nodes: numbers of points, by name.
    """

    points: FloatArray
    cells: IntArray
    mentioned: np.ndarray
    regions: dict[str, IntArray]
    faces: dict[str, IntArray]
    triangles: IntArray
    nodes: dict[str, IntArray]

    @property
    def used(self) -> np.ndarray:
        """Which points its elements have, or its triangles where it has no elements, shape (n,)."""
        if len(self.cells):
            return self.mentioned
        found = np.zeros(len(self.points), dtype=bool)
        found[self.triangles.ravel()] = True
        return found


def read_file(path: Path) -> MeshFile:
    """Read a mesh file.

    Raises:
        InputError: it cannot be read, is of an unknown kind, or has elements that are neither tetrahedra nor hexahedra,
            or neither such elements nor triangles.
    """
    found = _parsed(path)
    kinds = {block.type for block in found.cells}
    unknown = sorted(kinds - set(_SOLID) - set(_FLAT) - set(_THIN))
    if unknown:
        raise InputError(
            str(path),
            "elements that are tetrahedra or hexahedra (and triangles or quadrilaterals on faces)",
            ", ".join(unknown),
            "mesh it with tetrahedra alone",
        )
    sizes = {_SOLID[kind] for kind in kinds if kind in _SOLID}
    if len(sizes) > 1:
        raise InputError(
            str(path), "tetrahedra or hexahedra", "both in one file", "mesh it with tetrahedra alone"
        )
    if not any(len(b.data) for b in found.cells if b.type in _SOLID or _FLAT.get(b.type) == 3):
        raise InputError(
            str(path),
            "tetrahedra, hexahedra, or triangles of a closed surface",
            "none of them",
            "the file holds no triangles and no solid elements: write it again in the program that made it",
        )
    points = np.asarray(found.points, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] != 3 or not np.isfinite(points).all():
        raise InputError(str(path), "nodes with finite x, y and z", f"an array of {points.shape}")
    size = sizes.pop() if sizes else 4
    solid = [_corners(block, size) for block in found.cells if block.type in _SOLID]
    cells = np.concatenate([np.zeros((0, size), dtype=np.int64), *solid])
    mentioned = np.zeros(len(points), dtype=bool)
    for block in found.cells:
        numbers = np.asarray(block.data)
        if numbers.size and (numbers.min() < 0 or numbers.max() >= len(points)):
            raise InputError(
                str(path),
                f"elements of nodes 0 to {len(points) - 1}",
                f"nodes {numbers.min()} to {numbers.max()}",
            )
        if block.type in _SOLID:
            mentioned[numbers.ravel()] = True
    regions: dict[str, list[IntArray]] = {}
    faces: dict[str, list[IntArray]] = {}
    starts = np.cumsum([0] + [len(b.data) if b.type in _SOLID else 0 for b in found.cells])
    for name, number, rows in _groups(found):
        block = found.cells[number]
        if block.type in _SOLID:
            regions.setdefault(name, []).append(rows + starts[number])
        elif block.type in _FLAT:
            faces.setdefault(name, []).append(_corners(block, _FLAT[block.type])[rows])
    triangles = [_corners(b, 3) for b in found.cells if _FLAT.get(b.type) == 3]
    return MeshFile(
        points=points,
        cells=cells,
        mentioned=mentioned,
        regions={name: np.concatenate(rows) for name, rows in regions.items()},
        faces={
            name: np.concatenate(rows) for name, rows in faces.items() if len({r.shape[1] for r in rows}) == 1
        },
        triangles=np.concatenate([np.zeros((0, 3), dtype=np.int64), *triangles]),
        nodes={name: np.asarray(rows, dtype=np.int64) for name, rows in found.point_sets.items()},
    )


def check_file(path: Path) -> None:
    """Refuse a file that cannot be read, before it is.

    Raises:
        InputError: it is not there, is of an unknown kind, or too large.
    """
    if path.suffix.lower() not in ENDINGS:
        raise InputError(
            str(path),
            f"a file that ends in {' '.join(ENDINGS)}",
            path.suffix or "no ending",
            "save it as one of them",
        )
    try:
        size = path.stat().st_size
        with path.open("rb") as stream:
            stream.read(1)
    except (OSError, ValueError) as error:
        raise InputError(str(path), "a mesh file that can be read", _said(error)) from None
    if size > LARGEST_FILE:
        raise InputError(
            str(path),
            f"at most {LARGEST_FILE // 1_000_000} MB, a mesh of {MOST_CORNERS} nodes",
            f"{size // 1_000_000} MB",
            "make larger elements",
        )


def _parsed(path: Path) -> Any:
    """Return what meshio makes of a file."""
    check_file(path)
    meshio = import_module("meshio")  # half a second: only who reads a mesh waits for it
    words = io.StringIO()
    try:
        with redirect_stdout(words), redirect_stderr(words), np.errstate(all="ignore"):
            return meshio.read(path)
    except (Exception, SystemExit) as error:  # noqa: BLE001 - a foreign parser raises anything at a torn file
        said = " ".join(words.getvalue().split()) or _said(error)
        raise InputError(
            str(path),
            f"a whole {path.suffix.lower()} file",
            said,
            "write it again, as text and in an older version",
        ) from None


def _said(error: BaseException) -> str:
    reason = error.strerror if isinstance(error, OSError) else str(error)
    return f"{type(error).__name__}: {reason}" if reason else type(error).__name__


def _corners(block: Any, size: int) -> IntArray:
    corners = np.asarray(block.data, dtype=np.int64)
    return (
        corners.reshape(len(corners), -1)[:, :size] if len(corners) else np.zeros((0, size), dtype=np.int64)
    )


def _groups(found: Any) -> Iterator[tuple[str, int, IntArray]]:
    """Yield names of groups, the number of a block and its elements in the group."""
    for name, blocks in found.cell_sets.items():
        if ":" in name:  # what formats keep for themselves
            continue
        for number, rows in enumerate(blocks):
            if rows is not None and len(rows):
                yield name, number, np.asarray(rows, dtype=np.int64)
    called = {int(tag): name for name, (tag, *_) in ((n, np.ravel(v)) for n, v in found.field_data.items())}
    for key in _NUMBERS:
        for number, values in enumerate(found.cell_data.get(key, ())):
            for value in np.unique(np.asarray(values)) if np.ndim(values) == 1 else ():
                name = called.get(int(value), str(int(value)))
                if name not in found.cell_sets:
                    yield name, number, np.flatnonzero(np.asarray(values) == value)
