"""The stage of a sheet: what the servo moves it with, and how a state of it is shown."""

import numpy as np
import pytest

from trocar.simulation import RECORD
from trocar.simulation.kind import SHEET
from trocar.simulation.sheet_step import advance_sheet, renew_sheet
from trocar.training.tasks.catalogue import task
from trocar.waves.sheet.cut import cut_along
from trocar.web.source import Status
from trocar.web.stage import stage_of
from trocar.web.wire import decode_frame, encode


@pytest.fixture(scope="module")
def stage():
    return stage_of(task("cut-along-the-line"))


def test_the_servo_moves_a_sheet_as_one(stage):
    assert (stage.physics.advance, stage.physics.come_to_rest) == (advance_sheet, renew_sheet)
    assert stage.suits(task("cut-along-the-line", 3))
    assert not stage.suits(task("palpate"))
    assert stage_of(task("cut-along-the-line", 2)) is stage


def test_it_greets_with_its_grid_and_scissors(stage):
    hello = stage.hello(by_page=True)
    assert hello.grid == (41, 41)
    assert [one.tip for one in hello.instruments] == ["grasper", "scissors"]
    assert hello.tissue.name == "silicone-sheet"
    assert hello.tissue.thickness == pytest.approx(1.5e-3)
    assert 0 < hello.linear_force_n < task("cut-along-the-line").force_limit


def test_a_frame_of_it_shows_where_it_is_and_what_is_cut(stage):
    state = SHEET.at_rest(stage.scene)
    planes = np.zeros((stage.scene.layers, *stage.scene.modes))
    SHEET.amplitudes(stage.scene, state, planes)
    whole = stage.snapshot(np.zeros((2, RECORD)), planes, tick=1, time=1e-3, status=Status.ALIVE)
    cut_along(stage.scene.lattice, state.lattice, 0.02, 0.0292, 0.04, 0.0292)
    state.lattice.places[:, 800] = (1e-3, -5e-4, 2e-3)
    SHEET.amplitudes(stage.scene, state, planes)
    shown = stage.snapshot(np.zeros((2, RECORD)), planes, tick=2, time=2e-3, status=Status.ALIVE)
    _, seen = decode_frame(encode(shown, 1))
    assert seen.heights.reshape(-1)[800] == pytest.approx(2e-3, rel=1e-3)  # float16
    assert seen.in_plane.reshape(2, -1)[:, 800] == pytest.approx((1e-3, -5e-4), rel=1e-3)
    parted = seen.cut != whole.cut
    assert parted.any()
    assert set(np.nonzero(parted)[1]) == {19}  # links ahead of the nodes just below y = 29.2 mm
    assert not parted[0].any()
    assert set(seen.cut[1:][parted[1:]]) == {round(255 * (0.0292 / 1.5e-3 - 19))}
