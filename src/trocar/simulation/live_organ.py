"""The organ of a live scene, by the name of its mesh: one that Trocar makes, or a file."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from trocar.errors import InputError
from trocar.simulation.organ import Organ
from trocar.tissues.layer import Layer
from trocar.tissues.tissue import Tissue
from trocar.waves.mesh.basis_cache import BasisCache
from trocar.waves.mesh.mesh_file import ENDINGS, read_file
from trocar.waves.mesh.organ import Liver
from trocar.waves.mesh.solid_mesh import SolidMesh
from trocar.waves.mesh.wave_mesh import WaveMesh

ORGANS = ("liver",)
MODES = 60  # the lowest; what they leave of a press its site's own modes carry


def live_organ(
    mesh: SolidMesh,
    *,
    name: str = "organ",
    cache: BasisCache | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Organ:
    """Return an organ that a scene can be made of; what takes long is kept for the next time.

    Args:
        mesh: of it.
        name: what it is called.
        cache: where; None takes the usual folder.
        progress: told how many systems of equations are solved, and of how many.

    Raises:
        InputError: nothing of it looks up, it is too large, or its materials damp differently or remember.
        SolverError: it is not held.
    """
    model = WaveMesh(mesh, modes=MODES, cache=BasisCache() if cache is None else cache)
    return Organ.of(model, name=name, progress=progress)


def organ_mesh(
    name: str,
    tissue: Tissue,
    *,
    unit: str = "mm",
    up: str = "+z",
    held: str = "below",
    touched: str = "above",
) -> SolidMesh:
    """Return the mesh that a name means.

    Args:
        name: one of `ORGANS`, or the path of a file.
        tissue: layers are given to the file's regions by their names; where no region has a layer's name, and in an
            organ that Trocar makes, all is of the lowest layer.
        unit: of a file's lengths, as in `SolidMesh.read`.
        up: which of its axes looks up.
        held: the group of its faces that does not move.
        touched: the group of its faces to press.

    Raises:
        InputError: there is no such organ, or the file does not hold a mesh that can be a tissue.
    """
    body = tissue.linearised.layers[-1]
    if name in ORGANS:
        return Liver().mesh(body)
    path = Path(name)
    if path.suffix.lower() not in ENDINGS:
        raise InputError("mesh", f"{' or '.join(ORGANS)}, or a file that ends in {' '.join(ENDINGS)}", name)
    layers = {layer.name: layer for layer in tissue.linearised.layers}
    named = [region for region in read_file(path).regions if region in layers]
    materials: Layer | dict[str, Layer] = {region: layers[region] for region in named} if named else body
    return SolidMesh.read(path, materials, unit=unit, up=up, held=held, touched=touched)
