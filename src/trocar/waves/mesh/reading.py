"""From a mesh file to a `SolidMesh`: units, which way is up, regions to materials, names to supports."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from trocar.errors import InputError
from trocar.model import FloatArray
from trocar.tissues.layer import Layer
from trocar.waves.mesh.closed_surface import filled
from trocar.waves.mesh.faces import above, below, outer_faces
from trocar.waves.mesh.mesh_file import MeshFile, read_file
from trocar.waves.mesh.solid_mesh import (
    LONGEST,
    MOST_CORNERS,
    SHORTEST,
    Held,
    IntArray,
    SolidMesh,
    placed,
    volumes_of,
)

UNITS = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6}
"""Lengths that files are written in [m]."""

_UP = {  # the axis that is to look up: rows are the new x, y and z
    "+z": ((1, 0, 0), (0, 1, 0), (0, 0, 1)),
    "-z": ((1, 0, 0), (0, -1, 0), (0, 0, -1)),
    "+y": ((0, 0, 1), (1, 0, 0), (0, 1, 0)),
    "-y": ((0, 0, 1), (-1, 0, 0), (0, -1, 0)),
    "+x": ((0, 1, 0), (0, 0, 1), (1, 0, 0)),
    "-x": ((0, -1, 0), (0, 0, 1), (-1, 0, 0)),
}


def read_mesh(
    path: Path,
    materials: Layer | Mapping[str, Layer],
    *,
    unit: str = "mm",
    up: str = "+z",
    held: str | Sequence[str] = "below",
    touched: str = "above",
    spacing: float | None = None,
    drop_unused: bool = False,
) -> SolidMesh:
    """Read a mesh; `SolidMesh.read` says how."""
    path = Path(path)
    check_reading(unit=unit, up=up)
    file = read_file(path)
    _check_count(len(file.points), path)
    points = UNITS[unit] * file.points
    check_unit(file, unit, path)
    if len(file.cells):
        if spacing is not None:
            raise InputError(
                "spacing",
                "none for a file of solid elements",
                spacing,
                "leave it out: it is for surfaces, which are filled",
            )
        if not drop_unused and not file.mentioned.all():
            raise InputError(
                str(path),
                "every node in a solid element",
                f"{int((~file.mentioned).sum())} in none, the first {int(np.argmin(file.mentioned))}",
                "take them out of the file, or have them left out",
                give={"drop_unused": True},
            )
        cells = _upright(points, file.cells)
        region, layers = _materials(file, materials, path)
    else:
        if isinstance(materials, Mapping):
            raise InputError(
                f"{path}: materials",
                "one layer, for a surface has no regions",
                list(materials),
            )
        points, cells = filled(points, file.triangles, spacing, name=str(path))
        region, layers = np.zeros(len(cells), dtype=np.int64), (materials,)
    points = points @ np.array(_UP[up], dtype=np.float64).T
    groups = [held] if isinstance(held, str) else held
    faces = [_faces("held", one, file, points, cells, path) for one in groups]
    seen = _faces("touched", touched, file, points, cells, path)
    used, renumbered = np.unique(cells, return_inverse=True)
    place = np.full(len(points), -1)
    place[used] = np.arange(len(used))
    return placed(
        SolidMesh(
            corners=points[used],
            cells=renumbered.reshape(cells.shape).astype(np.int64),
            region=region,
            materials=layers,
            held=tuple(Held(faces=place[one]) for one in faces),
            surfaces={"surface" if touched == "above" else touched: place[seen]},
        )
    )


def check_reading(*, unit: str, up: str) -> None:
    """Refuse a unit or a direction that there is not.

    Raises:
        InputError: `unit` is none of `UNITS`, or `up` names no axis.
    """
    if unit not in UNITS:
        raise InputError("unit", f"one of {', '.join(UNITS)}", unit)
    if up not in _UP:
        raise InputError("up", f"one of {', '.join(_UP)}", up)


def _check_count(count: int, path: Path) -> None:
    if count > MOST_CORNERS:
        raise InputError(
            str(path),
            f"at most {MOST_CORNERS} nodes",
            count,
            "make larger elements: 10,000 nodes are a whole organ",
        )


def check_unit(file: MeshFile, unit: str, path: Path, *, shortest: float = SHORTEST) -> None:
    """Refuse a file whose size says that its unit is another.

    Args:
        file: what is in it.
        unit: of its lengths.
        path: of it.
        shortest: the least length of its longest side [m].

    Raises:
        InputError: it is shorter than that, or longer than any tissue.
    """
    extent = np.ptp(file.points[file.used], axis=0)
    longest = float(extent.max())
    if shortest <= UNITS[unit] * longest <= LONGEST:
        return
    least = max(shortest, 10 * SHORTEST)
    likely = [name for name, size in UNITS.items() if least <= size * longest <= LONGEST]
    raise InputError(
        str(path),
        f"a solid {1e3 * shortest:g} to {1e3 * LONGEST:g} mm long",
        " x ".join(f"{side:.4g}" for side in extent) + f" {unit}",
        f"it looks like {' or '.join(likely)}" if likely else "scale the mesh",
        give={"unit": likely[0]} if likely else None,
    )


def _upright(points: FloatArray, cells: IntArray) -> IntArray:
    """Return elements in right-handed order; programs that number all of them the other way are many."""
    if (volumes_of(points, cells) < 0).all():
        return cells[:, [1, 0, 2, 3] if cells.shape[1] == 4 else [4, 5, 6, 7, 0, 1, 2, 3]]
    return cells


def _materials(
    file: MeshFile, materials: Layer | Mapping[str, Layer], path: Path
) -> tuple[IntArray, tuple[Layer, ...]]:
    if isinstance(materials, Layer):
        return np.zeros(len(file.cells), dtype=np.int64), (materials,)
    known = ", ".join(f"{name} ({len(rows)} elements)" for name, rows in file.regions.items()) or "none"
    region = np.full(len(file.cells), -1)
    for number, name in enumerate(materials):
        if name not in file.regions:
            raise InputError(f"{path}: materials", f"regions of the file: {known}", name)
        region[file.regions[name]] = number
    if (region < 0).any():
        raise InputError(
            f"{path}: materials",
            f"a material for every element; the file's regions are {known}",
            f"{int((region < 0).sum())} elements without",
            "name a layer for every region, or one for all",
        )
    return region, tuple(materials.values())


def _faces(
    argument: str, name: str, file: MeshFile, points: FloatArray, cells: IntArray, path: Path
) -> IntArray:
    """Return the faces that a name, given as an argument, means: a group of the file, or a word."""
    if name in file.faces and len(file.cells):
        outside = outer_faces(cells)[0]
        known = {tuple(sorted(face)) for face in outside.tolist()}
        found = np.array([face for face in file.faces[name].tolist() if tuple(sorted(face)) in known])
        found = found.reshape(-1, outside.shape[1]) if len(found) else outside[:0]
    elif name in file.nodes and len(file.cells):
        outside = outer_faces(cells)[0]
        found = outside[np.isin(outside, file.nodes[name]).all(axis=1)]
    elif name in _WORDS:
        found = _WORDS[name](points, cells)
    else:
        known_names = ", ".join([*file.faces, *file.nodes, *_WORDS])
        raise InputError(argument, f"one of {known_names}, as in {path}", name)
    if len(found) == 0:
        raise InputError(
            argument,
            f"a group with faces on the outside of the mesh in {path}",
            name,
            "name another, or choose which axis looks up",
        )
    return found


_WORDS = {"above": above, "below": below}
