"""WaveMesh against closed forms, against other elements, and against finite elements that it shares no code with."""

from dataclasses import replace
from math import pi, sin, sqrt

import numpy as np
import pytest

from trocar import tissue
from trocar.errors import InputError
from trocar.model import Press, Profile
from trocar.reference.block import MeshSize
from trocar.reference.fea import FEASolid
from trocar.tissues import Layer, Tissue
from trocar.waves.mesh.block import block_mesh
from trocar.waves.mesh.solid_mesh import Held
from trocar.waves.mesh.wave_mesh import WaveMesh
from waves.mesh.meshes import ACROSS, BLOCK, LAYERS, THROUGH, tetrahedra

PRESS = Press(x=0.01, y=0.01, radius=2e-3, force=0.05)
COARSE = MeshSize(per_radius=1.0, growth=1.0, top=0.8, deepening=1.0, side=0.8)


def test_a_standing_wave_has_the_frequency_of_the_closed_form():
    # Walls on rollers: a pressure wave goes straight up and down, a quarter of it in the height.
    layer = Layer(name="jelly", thickness=0.02, young_modulus=2e4, poisson_ratio=0.3, density=1000)
    x = np.linspace(0.0, 0.01, 3)
    mesh = block_mesh(Tissue(layers=(layer,)), (x, x, np.linspace(-0.02, 0.0, 7)), support="base")
    walls = [
        Held(faces=one.faces, along=(axis == 0, axis == 1, False)) for axis, one in enumerate(mesh.held[1:])
    ]
    model = WaveMesh(replace(mesh, held=(mesh.held[0], *walls)), modes=8)
    speed = sqrt((layer.lame_lambda + 2 * layer.shear_modulus) / layer.density)
    assert np.abs(model.frequencies / (speed / (4 * layer.thickness)) - 1).min() < 1e-5


def test_tetrahedra_and_hexahedra_agree():
    bricks, tets = WaveMesh(BLOCK, modes=10), WaveMesh(tetrahedra(BLOCK), modes=10)
    assert tets.frequencies == pytest.approx(bricks.frequencies, rel=0.02)
    points = np.array([[0.01, 0.01, 0.0], [0.013, 0.009, 0.0]])
    for name in LAYERS.layer_names:
        one, other = (model.displacement(model.static((PRESS,)), points, name) for model in (bricks, tets))
        assert other[:, 2] == pytest.approx(one[:, 2], abs=0.02 * np.abs(one).max())


@pytest.mark.parametrize("profile", list(Profile))
def test_a_press_is_a_force_and_a_moment(profile):
    model = WaveMesh(BLOCK, modes=1)
    press = replace(PRESS, x=0.011, y=0.008, profile=profile, tilt=0.5, azimuth=0.7, radius=1.5e-3)
    nodal = model.nodal_forces(press).reshape(3, -1)
    assert nodal.sum(axis=1) == pytest.approx(press.force_vector, rel=1e-12)
    assert nodal[2] @ model.elements.nodes[:2].T == pytest.approx(
        press.force_vector[2] * np.array([press.x, press.y]), rel=1e-6
    )


def test_clamped_sides_as_finite_elements_say_at_rest_and_in_motion():
    size, press, duration, dt = (0.06, 0.06), Press(x=0.03, y=0.03, radius=4e-3, force=0.1), 0.02, 2.5e-4
    reference = FEASolid(tissue("skin"), size=size, support="edges", around=(press,), mesh=COARSE)
    x, y = (
        np.concatenate([lines, side - lines[-2::-1]])
        for lines, side in zip((reference.bricks.x, reference.bricks.y), size, strict=True)
    )
    model = WaveMesh(block_mesh(tissue("skin"), (x, y, reference.bricks.z), support="edges"))
    points = np.array([[0.03, 0.03, 0.0], [0.036, 0.03, 0.0], [0.02, 0.04, 0.0]])
    waves, elements = model.static((press,)), reference.static((press,))
    for name in model.layer_names:
        still = reference.displacement(elements, points, name)
        assert model.displacement(waves, points, name) == pytest.approx(still, abs=1e-3 * np.abs(still).max())

    def pushed(time):
        return (press.with_force(0.1 * sin(pi * time / duration) if time < duration else 0.0),)

    waves, elements, found = model.init(), reference.init(), []
    for tick in range(160):  # the tap, and as long again
        loads = pushed(tick * dt), pushed((tick + 1) * dt)
        waves, elements = model.step(waves, *loads, dt), reference.step(elements, *loads, dt)
        found.append(
            (model.displacement(waves, points)[:, 2], reference.displacement(elements, points)[:, 2])
        )
    one, other = np.array(found).transpose(1, 0, 2)
    assert np.abs(one - other).max() < 0.01 * np.abs(other).max()


def test_a_press_that_moves_on_leaves_what_it_did():
    model = WaveMesh(BLOCK, modes=20)
    there = replace(PRESS, x=0.012)
    state = model.static((PRESS,))
    moved = model.step(state, (PRESS,), (there,), 1e-6)
    points = np.array([[0.01, 0.01, 0.0], [0.012, 0.01, 0.0]])
    before, after = model.displacement(state, points), model.displacement(moved, points)
    assert after == pytest.approx(before, abs=1e-3 * np.abs(before).max())
    assert moved.presses == (PRESS.with_force(1.0), there.with_force(1.0))


def test_what_is_beside_the_mesh_is_refused():
    model = WaveMesh(BLOCK, modes=1)
    with pytest.raises(InputError, match="over the surface"):
        model.static((replace(PRESS, x=0.001),))
    with pytest.raises(InputError, match="one of cover, middle, fat"):
        model.displacement(model.init(), np.zeros((1, 3)), "bone")
    with pytest.raises(InputError, match="modes: expected 1 to"):
        WaveMesh(BLOCK, modes=0)
    with pytest.raises(InputError, match="a layer's face"):
        block_mesh(LAYERS, (ACROSS, ACROSS, THROUGH[[0, 1, 2, 3, 5]]))
