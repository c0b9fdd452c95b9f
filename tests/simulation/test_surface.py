"""What is shown of a scene is what the model says, with the near field and the way along added."""

import numpy as np
import pytest

from trocar.contact.instrument import Instrument
from trocar.model import Press, Profile
from trocar.simulation import (
    DRAG,
    FORCE,
    HANDLE,
    JAW,
    PLACE,
    POSE,
    PRESENT,
    RECORD,
    advance,
    amplitudes,
    at_rest,
    make_scene,
)
from trocar.simulation.surface import Surface
from trocar.waves.membrane import WaveMembrane
from trocar.waves.solid import WaveSolid

SIZE = (0.06, 0.06)
GRID = (61, 41)


def upright(name, tip, x):
    return Instrument(
        name=name, port=(x, 0.03, 0.1), length=0.31, shaft_radius=2.5e-3, tip=tip, handle=(x, 0.03, 0.3)
    )


@pytest.fixture(scope="module")
def shown(skin):
    """Return scene, its surface, and waves and records under an upright probe in the middle, pressed and still."""
    instruments = upright("left", "grasper", 0.012), upright("right", "probe", 0.03)
    scene = make_scene(WaveMembrane.fitted(skin, size=SIZE, modes=(52, 52)), skin, instruments)
    state, poses, records = at_rest(scene), np.zeros((2, POSE)), np.zeros((2, RECORD))
    poses[1, [PRESENT, JAW]] = 1.0
    for z in np.concatenate([np.linspace(1e-3, -1e-3, 300), np.full(700, -1e-3)]):
        poses[1, HANDLE : HANDLE + 3] = 0.03, 0.03, z + 0.31
        assert advance(scene, state, poses, records)
    waves = np.zeros((scene.layers, *scene.modes))
    amplitudes(scene, state, waves)
    return scene, Surface(scene, skin, size=SIZE, grid=GRID), waves, records


def test_the_top_face_lies_under_the_tip_and_a_probe_never_sinks_through_it_far(shown):
    _, surface, waves, records = shown
    heights = surface.heights(waves, records)
    assert heights.shape == (3, GRID[1], GRID[0])
    assert heights.dtype == np.float32
    x, y = np.meshgrid(*(np.linspace(0, side, n) for side, n in zip(SIZE, GRID, strict=True)))
    away = np.hypot(x - 0.03, y - 0.03)
    ball = np.where(away < 2e-3, -1e-3 + 2e-3 - np.sqrt(np.maximum(4e-6 - away**2, 0)), np.inf)
    # One Gaussian stands for the patch's points: the picture follows the ball to a tenth of its depth.
    assert (heights[0] - ball).max() < 1e-4
    assert heights[0].min() == pytest.approx(-1e-3, abs=1e-4)


def test_far_from_the_tip_it_is_the_layered_solids_answer(shown, skin):
    _, surface, waves, records = shown
    x, y = (np.linspace(0, side, n) for side, n in zip(SIZE, GRID, strict=True))
    nodes = np.stack([*np.meshgrid(x, y), np.zeros((GRID[1], GRID[0]))], axis=-1).reshape(-1, 3)
    away = np.hypot(nodes[:, 0] - 0.03, nodes[:, 1] - 0.03)
    ring = (away > 3e-3) & (away < 12e-3)
    solid = WaveSolid(skin, size=SIZE)
    press = Press(x=0.03, y=0.03, radius=1.2e-3, force=records[1, FORCE + 2], profile=Profile.SPHERE)
    for layer, heights in zip(skin.layer_names, surface.heights(waves, records), strict=True):
        expected = solid.displacement(solid.static((press,)), nodes[ring], layer)[:, 2]
        # Sheets imitate the layers' profile beside a tool to a few per cent of the deepest place.
        assert heights.ravel()[ring] == pytest.approx(expected, abs=0.05 * 1e-3)


def test_dragged_it_goes_along_as_the_layered_solid_does(shown, skin):
    _, surface, _, records = shown
    dragged = records.copy()
    dragged[1, DRAG : DRAG + 2] = 0.006, -0.002
    in_plane = surface.in_plane(dragged)
    assert in_plane.shape == (2, GRID[1], GRID[0])
    x, y = (np.linspace(0, side, n) for side, n in zip(SIZE, GRID, strict=True))
    nodes = np.stack([*np.meshgrid(x, y), np.zeros((GRID[1], GRID[0]))], axis=-1).reshape(-1, 3)
    solid = WaveSolid(skin, size=SIZE, modes=(64, 64))
    force, azimuth = np.hypot(0.006, -0.002), np.arctan2(-0.002, 0.006)
    # At 60 degrees the footprint is twice as long as wide and the press drags by sin 60 of it; pressing alone also
    # moves the face, so it is taken away.
    tilted, upright_ = (
        solid.displacement(
            solid.static(
                (Press(x=px, y=py, radius=4e-3, force=f, tilt=t, azimuth=azimuth, profile=Profile.GAUSSIAN),)
            ),
            nodes,
        )
        for px, py in [records[1, PLACE : PLACE + 2]]
        for f, t in ((force / np.sin(0.1), 0.1), (force / np.tan(0.1), 0.0))
    )
    expected = (tilted - upright_)[:, :2].T.reshape(in_plane.shape)
    # A tilt of 0.1 rad lengthens the footprint by half a per cent.
    assert in_plane == pytest.approx(expected, abs=0.01 * np.abs(expected).max())


def test_nothing_touched_nothing_moved(shown):
    scene, surface, waves, records = shown
    assert not surface.heights(0 * waves, 0 * records).any()
    assert not surface.in_plane(0 * records).any()
    del scene
