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
    if len(file.cells):
        _check_unit(file.points[file.mentioned], unit, path)
        if not drop_unused and not file.mentioned.all():
            raise InputError(
                str(path),
                "every node in a solid element",
                f"{int((~file.mentioned).sum())} in none, the first {int(np.argmin(file.mentioned))}",
                "pass drop_unused=True to leave them out",
            )
        cells = _upright(points, file.cells)
        region, layers = _materials(file, materials, path)
    elif len(file.triangles):
        _check_unit(file.points[np.unique(file.triangles)], unit, path)
        if isinstance(materials, Mapping):
            raise InputError(
                f"{path}: materials",
                "one layer, for a surface has no regions",
                list(materials),
                "pass one Layer",
            )
        points, cells = filled(points, file.triangles, spacing, name=str(path))
        region, layers = np.zeros(len(cells), dtype=np.int64), (materials,)
    else:
        raise InputError(str(path), "tetrahedra, hexahedra, or triangles of a closed surface", "none of them")
    points = points @ np.array(_UP[up], dtype=np.float64).T
    faces = [_faces(one, file, points, cells, path) for one in ([held] if isinstance(held, str) else held)]
    seen = _faces(touched, file, points, cells, path)
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


def _check_unit(points: FloatArray, unit: str, path: Path) -> None:
    extent = np.ptp(points, axis=0)
    longest = float(extent.max())
    if SHORTEST <= UNITS[unit] * longest <= LONGEST:
        return
    likely = [name for name, size in UNITS.items() if 10 * SHORTEST <= size * longest <= LONGEST]
    advice = f"it looks like {' or '.join(likely)}: pass unit={likely[0]!r}" if likely else "scale the mesh"
    raise InputError(
        str(path),
        f"a solid {1e3 * SHORTEST:g} to {1e3 * LONGEST:g} mm long",
        " x ".join(f"{side:.4g}" for side in extent) + f" {unit}",
        advice,
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
            "name a layer for every region, or pass one Layer for all",
        )
    return region, tuple(materials.values())


def _faces(name: str, file: MeshFile, points: FloatArray, cells: IntArray, path: Path) -> IntArray:
    """Return the faces that a name means: a group of the file, or a word."""
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
        raise InputError(f"{path}: faces", f"one of {known_names}", name)
    if len(found) == 0:
        raise InputError(
            f"{path}: {name}",
            "faces on the outside of the mesh",
            "none",
            "without a support the tissue floats away: name a group of faces, or choose which way is up",
        )
    return found


_WORDS = {"above": above, "below": below}
