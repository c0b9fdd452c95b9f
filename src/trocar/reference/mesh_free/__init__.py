"""A rival without a mesh: element-free Galerkin, which can be cut anywhere and joined again."""

from trocar.reference.mesh_free.cut import Cut
from trocar.reference.mesh_free.mesh_free import MeshFree, Stepping
from trocar.reference.mesh_free.state import MeshFreeState

__all__ = ["Cut", "MeshFree", "MeshFreeState", "Stepping"]
