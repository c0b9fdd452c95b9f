"""A scene of a mesh: as a flat block where it is one, along the normal where it slopes, and nothing beside it."""

import numpy as np
import pytest

from trocar.contact.instrument import TipKind, default_instruments
from trocar.model import Support
from trocar.simulation import (
    DEPTH,
    DIRECTION,
    DRAG,
    FORCE,
    HANDLE,
    HANDLE_FORCE,
    MOMENT,
    PLACE,
    TIP,
    TOUCH,
    TOUCH_HOLDING,
    at_rest,
    come_to_rest,
    line,
    make_scene,
    played,
    poses_along,
)
from trocar.simulation.organ import Organ, make_organ_scene
from trocar.study.contact.scenes import upright
from trocar.tissues import Layer, Tissue
from trocar.waves.mesh.block import block_mesh
from trocar.waves.mesh.organ import Liver
from trocar.waves.mesh.wave_mesh import WaveMesh
from trocar.waves.solid import WaveSolid

JELLY = Layer(
    name="liver", thickness=0.02, young_modulus=4.5e3, poisson_ratio=0.45, density=1060, loss_factor=0.4
)
NORMAL = FORCE + 2
PLACE_ON = (0.13, 0.03)  # [m] on the front of the right lobe, which slopes


class Bare:
    """A scene without friction and its instruments, from right above two places."""

    def __init__(self, organ, places, tips=(TipKind.GRASPER, TipKind.PROBE), **options):
        self.instruments = upright(tips, places)
        self.scene = make_organ_scene(organ, self.instruments, **options)

    def right(self, way, **options):
        return poses_along(self.instruments, (None, way), **options)


@pytest.fixture(scope="module")
def liver():
    return Organ.of(WaveMesh(Liver().mesh(JELLY, spacing=0.025), modes=60))


@pytest.fixture(scope="module")
def slope(liver):
    return Bare(liver, ((0.08, 0.05), PLACE_ON), friction=0.0)


def ground(organ, x, y):
    """Return the height of the rest surface and its normal at a place."""
    places, normals = organ.model.elements.seen(organ.grid.surface, np.array([[x, y]]))
    return places[0, 2], normals[0]


def press(organ, x, y, depth, ticks=600):
    """Down from 5 mm above the surface to a depth below, and held."""
    height, _ = ground(organ, x, y)
    down = line((x, y, height + 5e-3), (x, y, height - depth), ticks)
    return np.concatenate([down, np.repeat(down[-1:], 400, axis=0)])


@pytest.fixture(scope="module")
def flat():
    """A block as a mesh and as sine waves, and an upright probe over its middle."""
    layers, size = Tissue(layers=(JELLY,)), (0.06, 0.06)
    lines = np.linspace(0, 0.06, 13), np.linspace(0, 0.06, 13), np.linspace(-0.02, 0, 5)
    organ = Organ.of(WaveMesh(block_mesh(layers, lines, support=Support.BASE), modes=30))
    tools = upright((TipKind.GRASPER, TipKind.PROBE), ((0.018, 0.03), (0.03, 0.03)))
    waves = WaveSolid(layers, size=size, support=Support.BASE, modes=(52, 52), dynamic_modes=(52, 52))
    return organ, make_organ_scene(organ, tools), make_scene(waves, layers, tools), tools


def test_a_flat_mesh_answers_as_the_waves_of_a_flat_block(flat):
    """Elements of 5 mm under windows of 4 mm, free sides for simply supported ones: within 1 % of the largest force."""
    organ, mesh, waves, tools = flat
    way = press(organ, 0.03, 0.03, 3e-3)
    way = np.concatenate([way, line(way[-1], way[-1] + [4e-3, 2e-3, 0], 300)])
    ours, theirs = (played(scene, poses_along(tools, (None, way)))[:, 1] for scene in (mesh, waves))
    assert theirs[999, NORMAL] > 0.04
    for part in range(3):
        apart = np.abs(ours[:, FORCE + part] - theirs[:, FORCE + part]).max()
        assert apart < 0.01 * theirs[:, NORMAL].max()
    assert ours[:, PLACE : PLACE + 2] == pytest.approx(theirs[:, PLACE : PLACE + 2], abs=1e-5)
    assert mesh.give == pytest.approx(waves.give)


def test_two_tips_that_push_each_other_in_do_so_on_a_mesh_as_on_a_block(flat):
    organ, mesh, waves, tools = flat
    way = press(organ, 0.03, 0.03, 3e-3)
    ours, theirs = (
        played(scene, poses_along(tools, (way - [8e-3, 0, 0], way)))[-1] for scene in (mesh, waves)
    )
    alone = played(mesh, poses_along(tools, (None, way)))[-1, 1, NORMAL]
    assert ours[1, NORMAL] < 0.95 * alone
    assert ours[:, NORMAL] == pytest.approx(theirs[:, NORMAL], rel=0.02)


def test_a_press_on_a_slope_is_felt_along_the_normal_there(liver, slope):
    record = played(slope.scene, slope.right(press(liver, *PLACE_ON, 3e-3)))[-1, 1]
    force, (_, normal) = record[FORCE : FORCE + 3], ground(liver, *PLACE_ON)
    assert np.degrees(np.arccos(normal[2])) > 20
    # The faces' normals jump from one to the next by some degrees, the sites' are means about 12 mm.
    assert force @ normal > np.cos(np.radians(3)) * np.linalg.norm(force)
    # A ball of 2 mm that comes from above reaches a slope on its flank: its lowest point is less deep than its end.
    assert 3e-3 * normal[2] - 2e-3 < record[DEPTH] < 3e-3
    assert np.linalg.norm(record[DRAG : DRAG + 2]) < 0.1 * np.linalg.norm(force)


def test_the_hand_gets_the_power_of_the_tip_on_a_slope(liver, slope):
    tools = default_instruments(liver.size)
    scene = make_organ_scene(liver, tools, friction=0.0)
    down = press(liver, *PLACE_ON, 3e-3)
    poses = poses_along(
        tools, (None, np.concatenate([down, line(down[-1], down[-1] + [1e-3, -1e-3, 0], 100)]))
    )
    records = played(scene, poses)[:, 1]
    hand = np.diff(poses[-3:, 1, HANDLE : HANDLE + 3], axis=0)[-1]
    end = np.diff(records[-3:, TIP : TIP + 3], axis=0)[-1]
    turn = np.diff(records[-3:, DIRECTION : DIRECTION + 3], axis=0)[-1]
    moment, along = records[-1, MOMENT : MOMENT + 3], records[-1, DIRECTION : DIRECTION + 3]
    expected = records[-1, FORCE : FORCE + 3] @ end + moment @ np.cross(along, turn)
    assert records[-1, HANDLE_FORCE : HANDLE_FORCE + 3] @ hand == pytest.approx(expected, rel=5e-3)


def test_no_work_comes_out_of_a_way_round_on_a_slope(liver):
    rubbing = Bare(liver, ((0.08, 0.05), PLACE_ON))
    down = press(liver, *PLACE_ON, 3e-3)
    turn = np.linspace(0, 4 * np.pi, 1200)[:, None]
    ring = down[-1] + 4e-3 * np.hstack([1 - np.cos(turn), np.sin(turn), 0 * turn])
    way = np.concatenate([down, ring, ring[-1] + [0, 0, 8e-3] * np.linspace(0, 1, 600)[:, None]])
    records = played(rubbing.scene, rubbing.right(way))[:, 1]
    work = -np.sum(records[1:, FORCE : FORCE + 3] * np.diff(records[:, TIP : TIP + 3], axis=0))
    most = np.abs(records[:, FORCE : FORCE + 3]).max() * 3e-3
    assert records[-1, TOUCH] == 1
    assert work > 0.1 * most


def test_a_grasper_lifts_what_it_holds_and_loses_it_when_it_opens(liver):
    one = Bare(liver, ((0.08, 0.05), PLACE_ON), (TipKind.PROBE, TipKind.GRASPER))
    down = press(liver, *PLACE_ON, 2e-3)
    way = np.concatenate(
        [down, line(down[-1], down[-1] + [0, 0, 4e-3], 400), np.repeat(down[-1:], 200, axis=0)]
    )
    jaws = np.ones(len(way))
    jaws[len(down) - 100 : -200] = 0.0
    records = played(one.scene, one.right(way, jaws=(1.0, jaws)))[:, 1]
    assert int(records[-201, TOUCH]) & TOUCH_HOLDING
    assert records[-201, NORMAL] < -0.01  # it pulls
    assert not int(records[-1, TOUCH]) & TOUCH_HOLDING


def test_beside_the_organ_there_is_nothing_and_what_comes_from_below_touches_nothing(liver, slope):
    low = -0.99 * liver.thickness
    beside = line((0.005, 0.005, 0.01), (0.005, 0.005, low), 200)
    under = line((0.005, 0.005, low), (*PLACE_ON, low), 400)
    out = line((*PLACE_ON, low), (*PLACE_ON, 0.01), 300)
    records = played(slope.scene, slope.right(np.concatenate([beside, under, out])))[:, 1]
    assert not records[:, FORCE : HANDLE_FORCE + 3].any()
    assert records[599, DEPTH] > 5e-3  # it is seen all the same


def test_rest_is_rest(liver, slope):
    state, poses = at_rest(slope.scene), slope.right(press(liver, *PLACE_ON, 3e-3))
    assert played(slope.scene, poses, state)[-1, 1, NORMAL] > 0.01
    come_to_rest(slope.scene, state)
    assert not played(slope.scene, np.repeat(poses[-1:], 20, axis=0), state)[
        :, 1, FORCE : HANDLE_FORCE + 3
    ].any()
    assert not state.tick.blocks.any()


def test_a_history_is_the_same_when_it_is_played_again(liver, slope):
    poses = slope.right(press(liver, *PLACE_ON, 3e-3))
    assert np.array_equal(played(slope.scene, poses), played(slope.scene, poses))
