"""Small meshes."""

from dataclasses import replace

import numpy as np

from trocar.tissues import Layer, Tissue
from trocar.waves.mesh.block import block_mesh
from trocar.waves.mesh.solid_mesh import Held

LAYERS = Tissue(
    layers=(
        Layer(name="cover", thickness=2e-4, young_modulus=1e5, poisson_ratio=0.45, density=1100),
        Layer(name="middle", thickness=1e-3, young_modulus=4e4, poisson_ratio=0.45, density=1100),
        Layer(name="fat", thickness=5e-3, young_modulus=8e3, poisson_ratio=0.45, density=950),
    )
)
ACROSS = np.linspace(0.0, 0.02, 13)
THROUGH = np.array([-6.2e-3, -4.2e-3, -2.4e-3, -1.2e-3, -2e-4, 0.0])
BLOCK = block_mesh(LAYERS, (ACROSS, ACROSS, THROUGH), support="base")
COARSE = block_mesh(LAYERS, (ACROSS[::2], ACROSS[::2], THROUGH), support="base")

# A brick as six tetrahedra around one of its diagonals.
_SIX = ((0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6))


def tetrahedra(mesh):
    """The same solid in tetrahedra, its faces cut as their elements are."""
    cells = mesh.cells[:, np.array(_SIX)].reshape(-1, 4)
    faces = cells[:, np.array([(0, 1, 2), (0, 1, 3), (0, 2, 3), (1, 2, 3)])].reshape(-1, 3)

    def cut(quads):
        """Return the triangles whose three corners lie on one of the quadrilaterals."""
        lookup = {frozenset(three) for quad in quads.tolist() for three in _threes(quad)}
        found = {tuple(sorted(face)) for face in faces.tolist() if frozenset(face) in lookup}
        return np.array(sorted(found))

    return replace(
        mesh,
        cells=cells,
        region=np.repeat(mesh.region, 6),
        held=tuple(Held(faces=cut(one.faces), along=one.along) for one in mesh.held),
        surfaces={name: cut(quads) for name, quads in mesh.surfaces.items()},
    )


def _threes(quad):
    return [[quad[i] for i in range(4) if i != left] for left in range(4)]
