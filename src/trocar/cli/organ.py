"""The organ of `trocar train --mesh`: read, laid out, and what is said on the way."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.console import Console

    from trocar.cli.doing import Doing
    from trocar.tissues.nodule import Nodule
    from trocar.tissues.tissue import Tissue
    from trocar.waves.mesh.solid_mesh import SolidMesh
    from trocar.web.stage import Stage


def organ_stage(
    mesh: str,
    tissue: str,
    ports: str,
    nodules: tuple[Nodule, ...],
    reading: dict[str, Any],
    log: Console,
    doing: Doing,
) -> Stage:
    """Read an organ's mesh and find what answers a press anywhere on it.

    Args:
        mesh: name of an organ, or the path of a file.
        tissue: name of a preset, or the path of a tissue file.
        ports: name of a port set, or a file.
        nodules: in it.
        reading: how the file is read, as `organ_mesh` takes it.
        log: where notices go.
        doing: told what is being done.

    Raises:
        InputError: something named is not there or does not go together.
        SolverError: the organ is not held.
    """
    from trocar.contact.port_sets import instruments_over
    from trocar.simulation.live import LIVE_SIZE
    from trocar.simulation.live_organ import live_organ, organ_mesh
    from trocar.tissues.catalogue import tissue as preset
    from trocar.web.stage import organ_stage as stage_of_organ

    doing.at("reading the mesh")
    layers = preset(tissue)
    organ = organ_mesh(mesh, layers, nodules=nodules, **reading)
    notice = left_out(mesh, organ, layers)
    if notice:
        log.print(notice, markup=False)
    instruments_over(ports, organ.size, LIVE_SIZE)  # a mistake in them is told before the long work
    modes = "finding the mesh's modes (kept for the next time)"
    answers = "finding how the surface answers (kept for the next time)"
    doing.at(modes)
    prepared = live_organ(
        organ,
        name=name_of(mesh, layers),
        found=lambda done, total: doing.at(modes, done / total),
        progress=lambda done, total: doing.at(answers, done / total),
    )
    return stage_of_organ(prepared, ports=ports)


def name_of(mesh: str, tissue: Tissue) -> str:
    """Return what the page calls an organ: its own name, and the tissue's where that is another.

    Args:
        mesh: the organ's name, or its file's.
        tissue: it is made of.
    """
    own = Path(mesh).stem
    return own if own == tissue.name else f"{own} of {tissue.name}"


def left_out(mesh: str, organ: SolidMesh, tissue: Tissue) -> str:
    """Return a sentence on the layers of a tissue that an organ is not made of; an empty one where there are none.

    Args:
        mesh: the organ's name, or its file's.
        organ: made of the tissue.
        tissue: whose layers were asked for.
    """
    from trocar.waves.mesh.organ_name import ORGANS

    taken = {material.name for material in organ.materials}
    lost = [layer.name for layer in tissue.layers if layer.name not in taken]
    if not lost:
        return ""
    names = " and ".join(lost)
    if mesh in ORGANS:
        why = f"the {mesh} that Trocar makes is of one material, a tissue's lowest layer"
        return f"The organ is of {tissue.layers[-1].name} alone, without {names}: {why}."
    if len(lost) == len(tissue.layers) - 1 and tissue.layers[-1].name in taken:
        return (
            f"The organ is of {tissue.layers[-1].name} alone, the lowest layer of the tissue, without {names}: "
            f"{mesh} has no regions of these names. Regions of a mesh file take the layers that are named as they are."
        )
    return f"The organ is without {names}: {mesh} has no region of that name."
