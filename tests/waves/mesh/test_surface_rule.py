"""Integrals over a mesh's surface."""

import numpy as np
import pytest

from trocar.waves.mesh.elements import Elements
from trocar.waves.mesh.surface_rule import surface_rule
from waves.mesh.meshes import COARSE, tetrahedra


@pytest.mark.parametrize("mesh", [COARSE, tetrahedra(COARSE)], ids=["hexahedra", "tetrahedra"])
def test_areas_normals_and_shapes_are_those_of_the_surface(mesh):
    elements = Elements(mesh)
    rule = surface_rule(elements, "cover")
    assert rule.areas.sum() == pytest.approx(0.02**2)
    assert rule.normals == pytest.approx(np.tile([0.0, 0.0, 1.0], (len(rule.areas), 1)), abs=1e-12)
    assert rule.shapes @ elements.nodes.T == pytest.approx(rule.places, abs=1e-12)  # straight elements
    x = rule.places[:, 0]
    assert rule.areas @ x**10 == pytest.approx(0.02 * 0.02**11 / 11)  # the order that it is exact to
