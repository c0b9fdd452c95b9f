"""WaveMesh against CalculiX: a wedge of three layers with a nodule, clamped at its sides, pressed on its slope.

Mesh and nodal forces are ours, the elements CalculiX's own (C3D20R). It integrates everything with 2 x 2 x 2 points,
ours only lambda and nine tenths of mu, so they differ a little on one mesh.
"""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from reference.calculix import LOCAL_NODES, Job
from trocar.model import Press
from trocar.tissues import Layer
from trocar.waves.mesh.inclusion import with_inclusion
from trocar.waves.mesh.layered import layered_mesh
from trocar.waves.mesh.wave_mesh import WaveMesh
from waves.mesh.meshes import ACROSS, LAYERS, THROUGH

TARGET = 5e-3  # of the largest deflection, as for FEASolid
NODULE = Layer(name="nodule", thickness=1e-3, young_modulus=8e4, poisson_ratio=0.45, density=1050)
PRESS = Press(x=0.012, y=0.0095, radius=2.5e-3, force=0.02)


def twenty_nodes(mesh, places):
    """Return the numbers of each hexahedron's corners and middles of edges among places, in C3D20's order."""
    corners = mesh.corners[mesh.cells]
    r, s, t = np.moveaxis(LOCAL_NODES / 2.0, 1, 0)
    ring = ((0, 0), (1, 0), (1, 1), (0, 1))
    weights = np.stack(
        [(r if i else 1 - r) * (s if j else 1 - s) * (t if k else 1 - t) for k in (0, 1) for i, j in ring],
        axis=1,
    )
    distance, number = cKDTree(places).query(np.einsum("nw,mwc->mnc", weights, corners))
    assert distance.max() < 1e-12
    return number


def test_a_wedge_with_a_nodule(tmp_path):
    wedge = layered_mesh(
        LAYERS, (ACROSS, ACROSS, THROUGH), {"fat": lambda x, y: 3e-3 + 0.25 * x}, support="edges"
    )
    mesh = with_inclusion(wedge, (0.012, 0.01, -3.5e-3), (4e-3, 4e-3, 2e-3), NODULE)
    model = WaveMesh(mesh, modes=3)
    places = model.elements.nodes.T
    job = Job(
        nodes=places,
        elements=twenty_nodes(mesh, places),
        element_layer=mesh.region,
        layers=mesh.materials,
        held=model.elements.held.T,
        forces=model.nodal_forces(PRESS).reshape(3, -1).T,
    )
    theirs = job.solve(tmp_path)
    ours = model.field(model.static((PRESS,))).T
    largest = np.abs(theirs[:, 2]).max()
    assert np.abs(ours[:, 2]).max() == pytest.approx(largest, rel=TARGET)
    assert np.sqrt(np.mean((ours - theirs) ** 2)) < TARGET * largest
