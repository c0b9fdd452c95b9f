"""Trocar: a laparoscopy trainer whose soft tissue is a wave equation, and the laboratory that judges it.

The public names below are imported on first use (PEP 562), so `import trocar` itself costs next to nothing
and a command that only lists tissues never loads a solver. `trocar.tissue("skin")` returns a preset; the
package it lives in is `trocar.tissues`.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:  # the same names for type checkers and editors
    from trocar.model import Press as Press
    from trocar.model import Support as Support
    from trocar.reference.fea import FEASolid as FEASolid
    from trocar.reference.mesh_free.cut import Cut as Cut
    from trocar.reference.mesh_free.mesh_free import MeshFree as MeshFree
    from trocar.reference.springs.mass_spring import MassSpring as MassSpring
    from trocar.study.cases.reading import load_case as load_case
    from trocar.study.compare import compare as compare
    from trocar.tissues.catalogue import tissue as tissue
    from trocar.tissues.layer import Layer as Layer
    from trocar.tissues.tissue import Tissue as Tissue
    from trocar.waves.membrane import WaveMembrane as WaveMembrane
    from trocar.waves.mesh.basis_cache import BasisCache as BasisCache
    from trocar.waves.mesh.inclusion import with_inclusion as with_inclusion
    from trocar.waves.mesh.layered import layered_mesh as layered_mesh
    from trocar.waves.mesh.organ import Liver as Liver
    from trocar.waves.mesh.solid_mesh import SolidMesh as SolidMesh
    from trocar.waves.mesh.thickness_map import thickness_map as thickness_map
    from trocar.waves.mesh.wave_mesh import WaveMesh as WaveMesh
    from trocar.waves.solid import WaveSolid as WaveSolid
    from trocar.waves.stretch.stretching_waves import StretchingWaves as StretchingWaves

__version__ = "0.1.0"

_HOME = {  # public name: the module it lives in
    "BasisCache": "trocar.waves.mesh.basis_cache",
    "Cut": "trocar.reference.mesh_free.cut",
    "FEASolid": "trocar.reference.fea",
    "Layer": "trocar.tissues.layer",
    "Liver": "trocar.waves.mesh.organ",
    "MassSpring": "trocar.reference.springs.mass_spring",
    "MeshFree": "trocar.reference.mesh_free.mesh_free",
    "Press": "trocar.model",
    "SolidMesh": "trocar.waves.mesh.solid_mesh",
    "StretchingWaves": "trocar.waves.stretch.stretching_waves",
    "Support": "trocar.model",
    "Tissue": "trocar.tissues.tissue",
    "WaveMembrane": "trocar.waves.membrane",
    "WaveMesh": "trocar.waves.mesh.wave_mesh",
    "WaveSolid": "trocar.waves.solid",
    "compare": "trocar.study.compare",
    "layered_mesh": "trocar.waves.mesh.layered",
    "load_case": "trocar.study.cases.reading",
    "thickness_map": "trocar.waves.mesh.thickness_map",
    "tissue": "trocar.tissues.catalogue",
    "with_inclusion": "trocar.waves.mesh.inclusion",
}


def __getattr__(name: str) -> object:
    """Import a public name on first use.

    Raises:
        AttributeError: there is no such name.
    """
    if name not in _HOME:
        raise AttributeError(f"module 'trocar' has no attribute {name!r}")
    value = getattr(import_module(_HOME[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """Return the public names, imported yet or not."""
    return sorted({*globals(), *_HOME})
