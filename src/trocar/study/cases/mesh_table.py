"""The table [mesh] of a case file: an organ that Trocar makes, or a mesh file, in the place of a block."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

from trocar.errors import InputError
from trocar.simulation.live_organ import organ_mesh
from trocar.study.cases import quantity as q
from trocar.tissues import Layer, Tissue
from trocar.tissues.key_table import Table
from trocar.waves.mesh.organ_name import ORGANS
from trocar.waves.mesh.solid_mesh import LONGEST, SolidMesh

ANY_THICKNESS = LONGEST
"""Of a material whose extent a mesh says [m], until the mesh is read: nothing counts on it."""

_FILE_KEYS = ("unit", "up", "held", "touched")
_KEYS = ("file", *_FILE_KEYS, q.SPACING.key)


def read_mesh_table(
    table: Table, folder: Path, tissue: Tissue, around: tuple[float, float]
) -> tuple[SolidMesh, Tissue]:
    """Return the mesh that the table means, and its materials as layers, all as thick as the mesh is.

    Args:
        table: [mesh].
        folder: of the case file, which a relative path counts from.
        tissue: a layer for each material.
        around: x and y of a place where a tool presses [m].

    Raises:
        InputError: a key is unknown or does not go with the others, the mesh cannot be read, or a layer is in none of
            its regions; the message names file and key.
    """
    table.only(_KEYS)
    name = table.text("file")
    reading: dict[str, Any] = {key: table.text(key) for key in _FILE_KEYS if key in table.content}
    spacing = table.number(q.SPACING) if q.SPACING.key in table.content else None
    made = name in ORGANS
    for key in _FILE_KEYS if made else ():
        if key in table.content:
            expected = f"no such key beside {name}, which Trocar makes itself"
            raise table.refuse(key, expected, table.content[key], "leave it out")
    try:
        mesh = organ_mesh(
            name if made else str(folder / name), tissue, spacing=spacing, around=around, **reading
        )
    except InputError as error:
        raise _in_table(table, error) from None
    _check_used(table, tissue.layers, mesh)
    return mesh, replace(
        tissue, layers=tuple(replace(layer, thickness=mesh.thickness) for layer in tissue.layers)
    )


def _check_used(table: Table, layers: tuple[Layer, ...], mesh: SolidMesh) -> None:
    """Refuse a layer that nothing of the mesh is made of."""
    used = {material.name for material in mesh.materials}
    for i, layer in enumerate(layers):
        if layer.name not in used:
            raise InputError(
                f"{table.file}: layer[{i}].name",
                "a region of the mesh, or one layer for all of it",
                layer.name,
                "leave it out, or name the regions in the program that made the mesh",
            )


def _in_table(table: Table, error: InputError) -> InputError:
    """Return an error with the case file and, where it is one of the table's keys, that key."""
    if error.where == "around":
        return InputError(
            f"{table.file}: tool[0].position_mm", "a place on the organ, as seen from above", error.got
        )
    key = {"mesh": "file", "spacing": q.SPACING.key}.get(error.where, error.where)
    where = table.where(key) if key in _KEYS else f"{table.where('file')}: {error.where}"
    return InputError(where, error.expected, error.got, error.advice)
