"""The organ of a live scene, by the name of its mesh: one that Trocar makes, or a file."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from math import isfinite
from pathlib import Path

import numpy as np

from trocar.errors import InputError
from trocar.simulation.organ import Organ
from trocar.tissues.layer import Layer
from trocar.tissues.nodule import Nodule
from trocar.tissues.tissue import Tissue
from trocar.waves.mesh.basis_cache import BasisCache
from trocar.waves.mesh.elements import Elements
from trocar.waves.mesh.inclusion import with_inclusion
from trocar.waves.mesh.mesh_file import read_file
from trocar.waves.mesh.organ import EVEN_SPACING, Liver
from trocar.waves.mesh.organ_name import ORGANS, check_organ
from trocar.waves.mesh.reading import check_unit
from trocar.waves.mesh.solid_mesh import SolidMesh
from trocar.waves.mesh.wave_mesh import WaveMesh

_SPACING = (
    0.016  # [m] of a liver whose elements are a third as long about a place: as many as elsewhere in all
)
SHORTEST = 0.02  # [m] of an organ's longest side: four shafts of 5 mm, beside each other
MODES = 60  # the lowest; what they leave of a press its site's own modes carry


def live_organ(
    mesh: SolidMesh,
    *,
    name: str = "organ",
    cache: BasisCache | None = None,
    found: Callable[[int, int], None] | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Organ:
    """Return an organ that a scene can be made of; what takes long is kept for the next time.

    Args:
        mesh: of it.
        name: what it is called.
        cache: where; None takes the usual folder.
        found: told how many of its lowest modes are found, and of how many.
        progress: told how many systems of equations are solved, and of how many.

    Raises:
        InputError: nothing of it looks up, it is too large, or its materials damp differently or remember.
        SolverError: it is not held.
    """
    model = WaveMesh(mesh, modes=MODES, cache=BasisCache() if cache is None else cache, progress=found)
    return Organ.of(model, name=name, progress=progress)


def organ_mesh(
    name: str,
    tissue: Tissue,
    *,
    unit: str = "mm",
    up: str = "+z",
    held: str = "below",
    touched: str = "above",
    drop_unused: bool = False,
    spacing: float | None = None,
    around: tuple[float, float] | None = None,
    nodules: Sequence[Nodule] = (),
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
        drop_unused: leave out nodes that no element has.
        spacing: of the elements of an organ that Trocar makes, or that fill a surface [m]; None takes the usual one.
        around: x and y of a place where tools press [m]; the liver's elements are shorter there, those of a file not.
        nodules: balls of elements of another stiffness, as deep below the surface as they say. The liver's elements are
            shorter about the first, where no other place is given.

    Raises:
        InputError: there is no such organ, the file does not hold a mesh that can be a tissue, it is too small for the
            instruments, or a nodule lies beside it or is as small as its elements.
    """
    check_organ(name, unit=unit, up=up)
    body = tissue.linearised.layers[-1]
    if name in ORGANS:
        if around is None and nodules:
            around = nodules[0].x, nodules[0].y
        if spacing is None:
            spacing = EVEN_SPACING if around is None else _SPACING
        return _with_nodules(Liver().mesh(body, spacing=spacing, around=around), nodules)
    path = Path(name)
    layers = {layer.name: layer for layer in tissue.linearised.layers}
    file = read_file(path)
    check_unit(file, unit, path, shortest=SHORTEST)
    named = [region for region in file.regions if region in layers]
    materials: Layer | dict[str, Layer] = {region: layers[region] for region in named} if named else body
    mesh = SolidMesh.read(
        path,
        materials,
        unit=unit,
        up=up,
        held=held,
        touched=touched,
        drop_unused=drop_unused,
        spacing=spacing,
    )
    return _with_nodules(mesh, nodules)


def _with_nodules(mesh: SolidMesh, nodules: Sequence[Nodule]) -> SolidMesh:
    """Return a mesh with balls of another stiffness, each of the density and loss of what it lies in."""
    if not nodules:
        return mesh
    heights = Elements(mesh).heights(next(iter(mesh.surfaces)), np.array([[one.x, one.y] for one in nodules]))
    for number, (nodule, height) in enumerate(zip(nodules, heights.tolist(), strict=True)):
        if not isfinite(height):
            raise InputError(
                "nodule: x, y",
                "a place over the organ, as seen from above",
                f"{1e3 * nodule.x:g}, {1e3 * nodule.y:g} mm",
            )
        layer = replace(
            mesh.materials[0],
            name=f"nodule {number + 1}",
            young_modulus=nodule.young_modulus,
            poisson_ratio=nodule.poisson_ratio,
        )
        centre = (nodule.x, nodule.y, height - nodule.depth)
        mesh = with_inclusion(mesh, centre, (nodule.radius,) * 3, layer)
    return mesh
