"""What names an organ: one that Trocar makes, or a mesh file and how to read it."""

from __future__ import annotations

from pathlib import Path

from trocar.errors import InputError
from trocar.waves.mesh.mesh_file import ENDINGS, check_file
from trocar.waves.mesh.reading import check_reading

ORGANS = ("liver",)
"""Those that Trocar makes."""


def check_organ(name: str, *, unit: str = "mm", up: str = "+z") -> None:
    """Refuse a name, unit or direction that no organ can be read with, before anything slow is begun.

    Args:
        name: one of `ORGANS`, or the path of a file.
        unit: of the file's lengths, as in `SolidMesh.read`.
        up: which of its axes looks up.

    Raises:
        InputError: there is no such organ, the file cannot be opened, or there is no such unit or axis.
    """
    check_reading(unit=unit, up=up)
    if name in ORGANS:
        return
    path = Path(name)
    if path.suffix.lower() not in ENDINGS:
        raise InputError("mesh", f"{' or '.join(ORGANS)}, or a file that ends in {' '.join(ENDINGS)}", name)
    check_file(path)
