"""What a mesh's surface is like close by: the material it is made of, and a flat block of it as thick as the solid."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from trocar.tissues.layer import Layer
from trocar.tissues.tissue import Tissue
from trocar.waves.mesh.faces import among, outer_faces
from trocar.waves.mesh.solid_mesh import SolidMesh


def skin(mesh: SolidMesh, surface: str) -> Layer:
    """Return the material that most of a surface's faces are made of.

    Args:
        mesh: the solid.
        surface: its name.
    """
    faces, elements = outer_faces(mesh.cells)
    own = among(faces, mesh.surfaces[surface])
    return mesh.materials[int(np.bincount(mesh.region[elements[own]]).argmax())]


def block_of(mesh: SolidMesh, surface: str, name: str) -> Tissue:
    """Return a flat block of a surface's material as thick as the solid.

    Args:
        mesh: the solid.
        surface: its name.
        name: of the tissue.
    """
    return Tissue(layers=(replace(skin(mesh, surface), thickness=mesh.thickness),), name=name)
