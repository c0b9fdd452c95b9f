"""Presses on surfaces that slope."""

from dataclasses import replace

import numpy as np
import pytest

from trocar.errors import InputError
from trocar.model import Press
from trocar.waves.mesh.block import block_mesh
from trocar.waves.mesh.footprint import turn_to
from trocar.waves.mesh.layered import layered_mesh
from trocar.waves.mesh.wave_mesh import WaveMesh
from waves.mesh.meshes import ACROSS, BLOCK, LAYERS, THROUGH

SLOPE = 0.3
SMALL = block_mesh(LAYERS, (ACROSS[::2], ACROSS[::2], THROUGH))
WEDGE = layered_mesh(LAYERS, (ACROSS, ACROSS, THROUGH), {"fat": lambda x, y: 4e-3 + SLOPE * x})
PRESS = Press(x=0.011, y=0.009, radius=2e-3, force=0.05, tilt=0.4, azimuth=0.7)
NORMAL = np.array([-SLOPE, 0.0, 1.0]) / np.hypot(SLOPE, 1.0)


def test_on_a_level_surface_both_ways_are_one():
    normal, vertical = (
        WaveMesh(BLOCK, modes=1, approach=way).nodal_forces(PRESS) for way in ("normal", "vertical")
    )
    assert normal == pytest.approx(vertical, abs=1e-12 * np.abs(vertical).max())


def test_on_a_slope_force_and_footprint_are_turned():
    model = WaveMesh(WEDGE, modes=1)
    straight = replace(PRESS, tilt=0.0)
    nodal = model.nodal_forces(straight).reshape(3, -1)
    assert nodal.sum(axis=1) == pytest.approx(-0.05 * NORMAL, abs=1e-9)
    # a moment about the footprint's middle, on the surface, is none
    places, normals = model.elements.seen("cover", np.array([[PRESS.x, PRESS.y]]))
    assert normals[0] == pytest.approx(NORMAL, abs=1e-9)
    arms = model.elements.nodes.T - places[0]
    assert np.cross(arms, nodal.T).sum(axis=0) == pytest.approx([0, 0, 0], abs=1e-9 * 0.05)
    tilted = model.nodal_forces(PRESS).reshape(3, -1).sum(axis=1)
    assert tilted @ NORMAL == pytest.approx(-0.05 * np.cos(0.4))
    assert np.linalg.norm(tilted) == pytest.approx(0.05)


def test_another_approach_is_refused():
    with pytest.raises(InputError, match="approach: expected one of normal, vertical, got 'sideways'"):
        WaveMesh(BLOCK, approach="sideways")


def test_straight_down_stays_straight_down():
    model = WaveMesh(WEDGE, modes=1, approach="vertical")
    nodal = model.nodal_forces(PRESS).reshape(3, -1)
    assert nodal.sum(axis=1) == pytest.approx(PRESS.force_vector, rel=1e-9)


def test_the_shortest_turn_takes_z_to_the_normal():
    turn = turn_to(NORMAL)
    assert turn @ [0, 0, 1] == pytest.approx(NORMAL)
    assert turn @ turn.T == pytest.approx(np.eye(3))
    assert turn @ [0, 1, 0] == pytest.approx([0, 1, 0])  # the axis it turns about


def test_a_press_turned_with_its_block_does_the_same():
    # A block tilted as a whole: what it does about its own axes is what the level block does.
    turn = turn_to(NORMAL)
    corners = SMALL.corners @ turn.T
    tilted = replace(
        SMALL, corners=corners - np.array([corners[:, 0].min(), corners[:, 1].min(), corners[:, 2].max()])
    )
    shift = tilted.corners[0] - turn @ SMALL.corners[0]
    # its walls would slide along x and y, which a tilted block's do not: hold both below alone
    level = WaveMesh(replace(SMALL, held=SMALL.held[:1]), modes=4)
    sloping = WaveMesh(replace(tilted, held=tilted.held[:1]), modes=4)
    here = np.array([[0.011, 0.009, 0.0], [0.014, 0.009, 0.0]])
    there = here @ turn.T + shift
    one = level.displacement(level.static((PRESS,)), here)
    press = replace(PRESS, x=there[0, 0], y=there[0, 1])
    other = sloping.displacement(sloping.static((press,)), there)
    # the footprint's rim cuts elements at other places of the polar rule
    assert other == pytest.approx(one @ turn.T, abs=1e-3 * np.abs(one).max())


def test_where_the_surface_hardly_looks_up_nothing_can_press():
    steep = layered_mesh(LAYERS, (ACROSS, ACROSS, THROUGH), {"fat": lambda x, y: 4e-3 + 4.5 * x})
    with pytest.raises(InputError, match="at most 75 degrees from it, got '77 degrees"):
        WaveMesh(steep, modes=1).nodal_forces(PRESS)
