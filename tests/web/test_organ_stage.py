"""A stage of an organ: what the page is told of it, and what it is shown."""

import numpy as np
import pytest

from trocar.simulation import RECORD
from trocar.simulation.organ import Organ
from trocar.tissues.catalogue import tissue
from trocar.training.tasks.catalogue import task
from trocar.waves.mesh.organ import Liver
from trocar.waves.mesh.wave_mesh import WaveMesh
from trocar.web.messages import Hello
from trocar.web.source import Status
from trocar.web.stage import organ_stage, set_stage, stage_of
from trocar.web.wire import encode


@pytest.fixture(scope="module")
def stage():
    mesh = Liver().mesh(tissue("liver").layers[-1], spacing=0.03)
    return organ_stage(Organ.of(WaveMesh(mesh, modes=20), name="liver"))


def test_the_greeting_tells_an_organs_shape(stage):
    hello = stage.hello(by_page=True)
    shape = hello.shape
    assert hello.tissue.name == "liver"
    assert len(shape.rest_m) == hello.grid[0] * hello.grid[1]
    heights = [z for z in shape.rest_m if z is not None]
    assert 0.4 < len(heights) / len(shape.rest_m) < 0.9  # an outline in its rectangle
    assert max(heights) <= 0.0
    assert -hello.tissue.thickness <= min(heights)
    assert max(max(face) for face in shape.faces) == len(shape.corners_m) - 1
    assert Hello.model_validate_json(hello.model_dump_json()) == hello
    assert len(shape.rim) == len(shape.rim_m) > 50
    assert all(shape.rest_m[node] is not None for node in shape.rim)
    assert np.linalg.norm(shape.normals, axis=1) == pytest.approx(np.ones(len(shape.corners_m)), abs=2e-3)
    # The camera looks at the surface, not at the block's height.
    assert hello.camera.target_m[2] < -0.005
    assert set_stage("skin").hello(by_page=True).shape is None


def test_an_organ_is_drawn_in_frames_like_every_tissue(stage):
    picture = np.zeros((1, *stage.scene.modes))
    snapshot = stage.snapshot(np.zeros((2, RECORD)), picture, tick=1, time=1e-3, status=Status.ALIVE)
    assert snapshot.heights.shape == (1, *stage.grid[::-1])
    assert snapshot.in_plane.shape == (2, *stage.grid[::-1])
    assert len(encode(snapshot, 1)) > 2 * 3 * stage.grid[0] * stage.grid[1]


def test_both_tips_begin_over_the_organ_free_of_it(stage):
    for one in stage.instruments:
        x, y, z = one.reach_of(one.handle).tip
        height = stage.organ.model.elements.heights("surface", np.array([[x, y]]))[0]
        assert np.isfinite(height)
        assert z > height + 5e-3


def test_no_task_is_taken_for_one_on_this_organ(stage):
    assert not stage.suits(task("palpate", 1))


def test_the_task_on_an_organ_has_its_stage_at_every_level():
    phantom = stage_of(task("palpate-organ"))
    assert stage_of(task("palpate-organ", 2)) is phantom
    assert phantom.suits(task("palpate-organ", 3))
    assert not phantom.suits(task("palpate"))
    assert not set_stage("silicone-pad").suits(task("palpate-organ"))
    hello = phantom.hello(by_page=True)
    assert hello.tissue.size_m == pytest.approx(task("palpate-organ").size)
    assert hello.linear_force_n > task("palpate-organ").force_limit
