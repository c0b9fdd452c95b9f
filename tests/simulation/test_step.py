"""One coupled tick: what the records say, touch and no touch, grip, symmetry, and poses that make no sense."""

import numpy as np
import pytest

from trocar.errors import InputError
from trocar.model import Support
from trocar.simulation import (
    DEPTH,
    DIRECTION,
    DRAG,
    FORCE,
    HANDLE,
    HANDLE_FORCE,
    OUTSIDE,
    PLACE,
    RECORD,
    TIP,
    TOUCH,
    TOUCH_HOLDING,
    TOUCH_PRESENT,
    TOUCH_TOUCHING,
    advance,
    amplitudes,
    at_rest,
    come_to_rest,
    line,
    make_scene,
    played,
    poses_along,
)
from trocar.study.contact.scenes import SIZE, setting, upright
from trocar.study.cost.tick_cost import two_circles, two_probes
from trocar.tissues.catalogue import tissue
from trocar.waves.membrane import WaveMembrane
from trocar.waves.solid import WaveSolid

MIDDLE = (0.03, 0.03)
OVER, DEEP = 2e-3, 0.8e-3
NORMAL = FORCE + 2
TOUCHES, HOLDS = TOUCH_PRESENT + TOUCH_TOUCHING, TOUCH_PRESENT + TOUCH_TOUCHING + TOUCH_HOLDING


def dip(x=MIDDLE[0], y=MIDDLE[1], depth=DEEP, rest=200):
    """Down from above and held."""
    down = line((x, y, OVER), (x, y, -depth), 150)
    return np.concatenate([down, np.repeat(down[-1:], rest, axis=0)])


def right(one, way, **options):
    return poses_along(one.instruments, (None, way), **options)


def test_a_record_says_where_the_instrument_is(usual):
    instrument = usual.instruments[0]
    way = line((0.02, 0.03, 0.004), (0.025, 0.028, 0.003), 3)
    poses = poses_along(usual.instruments, (way, None), jaws=(0.4, 1.0), rolls=(0.3, 0.0))
    record = played(usual.scene, poses)[-1]
    reach = instrument.reach_of(poses[-1, 0, HANDLE : HANDLE + 3].tolist())
    assert record[0, TIP : TIP + 3] == pytest.approx(way[-1], abs=1e-15)
    assert record[0, DIRECTION : DIRECTION + 3] == pytest.approx(reach.direction)
    assert record[0, OUTSIDE] == pytest.approx(reach.outside)
    assert record[0, 6:8].tolist() == [0.3, 0.4]
    assert record[0, TOUCH] == TOUCH_PRESENT
    assert record[1].any() == np.bool_(True)  # its direction alone: it is not there
    assert np.delete(record[1], DIRECTION + 2).tolist() == [0.0] * (RECORD - 1)


def test_a_tip_feels_nothing_above_the_surface_and_a_push_below(straight):
    records = played(straight.scene, right(straight, dip()))[:, 1]
    above = records[:, TIP + 2] > 0
    assert not records[above, FORCE : HANDLE_FORCE + 3].any()
    assert (records[above, TOUCH] == TOUCH_PRESENT).all()
    assert records[-1, TOUCH] == TOUCHES
    assert records[-1, NORMAL] > 0.01
    assert records[-1, DEPTH] == pytest.approx(DEEP)
    assert records[:, NORMAL].min() >= 0
    assert records[-1, PLACE : PLACE + 2] == pytest.approx(MIDDLE, abs=1e-6)


def test_the_hand_gets_the_power_of_the_tip(usual):
    """Force and moment at the handle do the work that the force on the tip does, to first order in a small turn."""
    way = np.concatenate([dip(0.04), line((0.04, 0.03, -DEEP), (0.041, 0.029, -DEEP), 100)])
    poses = right(usual, way)
    records = played(usual.scene, poses)[:, 1]
    hand = np.diff(poses[-3:, 1, HANDLE : HANDLE + 3], axis=0)[-1]
    end = np.diff(records[-3:, TIP : TIP + 3], axis=0)[-1]
    turn = np.diff(records[-3:, DIRECTION : DIRECTION + 3], axis=0)[-1]
    along = records[-1, DIRECTION : DIRECTION + 3]
    moment = records[-1, 21:24]
    expected = records[-1, FORCE : FORCE + 3] @ end + moment @ np.cross(along, turn)
    # A tick's 14 um change the lever and the direction by some 1e-4, and friction works where the two nearly cancel.
    assert records[-1, HANDLE_FORCE : HANDLE_FORCE + 3] @ hand == pytest.approx(expected, rel=5e-3)


def test_first_seen_inside_the_tissue_it_touches_nothing_until_it_was_outside(straight):
    held = np.repeat(np.array([[*MIDDLE, -DEEP]]), 50, axis=0)
    out_and_in = np.concatenate([held, line((*MIDDLE, -DEEP), (*MIDDLE, 1e-3), 50), dip()])
    records = played(straight.scene, right(straight, out_and_in))[:, 1]
    assert not records[:100, FORCE : FORCE + 3].any()
    assert records[-1, NORMAL] > 0.01
    assert records[20, DEPTH] == pytest.approx(DEEP)  # it is seen all the same


def test_coming_to_rest_throws_nothing(straight):
    state = at_rest(straight.scene)
    poses = right(straight, dip())
    pressed = played(straight.scene, poses, state)[-1, 1, NORMAL]
    come_to_rest(straight.scene, state)
    after = played(straight.scene, np.repeat(poses[-1:], 20, axis=0), state)
    assert pressed > 0.01
    assert not after[:, 1, NORMAL].any()
    waves = np.ones((straight.scene.layers, *straight.scene.modes))
    amplitudes(straight.scene, state, waves)
    assert not waves.any()


def test_off_the_block_there_is_nothing_and_beside_it_less(straight):
    """A tip slides off over the side; near it the block is as soft as its simply supported side lets it be."""
    way = np.concatenate([dip(0.012, 0.03), line((0.012, 0.03, -DEEP), (-0.004, 0.03, -DEEP), 400)])
    one = straight.with_instruments(upright(places=((0.045, 0.03), (0.012, 0.03))))
    records = played(one.scene, right(one, way))[:, 1]
    assert np.isfinite(records).all()
    off = records[:, TIP] < -0.5e-3  # the shaft leans, and its lowest point is a little further in
    assert off.any()
    assert not records[off, FORCE : FORCE + 3].any()
    assert records[350, NORMAL] > 0.01


@pytest.mark.parametrize("wrong", [np.nan, np.inf, 1e300])
def test_a_pose_that_makes_no_sense_gives_no_force_and_no_lasting_harm(straight, wrong):
    state, records = at_rest(straight.scene), np.zeros((2, RECORD))
    poses = right(straight, dip())
    played(straight.scene, poses, state)
    bad = poses[-1].copy()
    bad[1, HANDLE + 1] = wrong
    well = advance(straight.scene, state, bad, records)
    assert np.isfinite(records).all()
    assert not records[:, FORCE : HANDLE_FORCE + 3].any()
    assert not records[1, TOUCH] or not well
    again = played(straight.scene, right(straight, dip()), state)[-1, 1]
    assert again[NORMAL] == pytest.approx(
        played(straight.scene, poses)[-1, 1, NORMAL], rel=1e-2
    )  # waves still settle


def test_a_tissue_that_is_not_finite_is_told_and_gives_no_force(straight):
    state, records = at_rest(straight.scene), np.zeros((2, RECORD))
    poses = right(straight, dip())
    played(straight.scene, poses, state)
    state.tick.blocks[0, 0] = np.inf
    assert not advance(straight.scene, state, poses[-1], records)
    assert not records[:, FORCE : HANDLE_FORCE + 3].any()
    assert not records[:, DRAG : DRAG + 2].any()


def test_the_same_input_gives_the_same_bits(usual):
    ways = dip(0.025), dip(0.033)
    poses = poses_along(usual.instruments, ways, jaws=(np.linspace(1, 0, 350), 1.0))
    assert played(usual.scene, poses).tobytes() == played(usual.scene, poses).tobytes()


@pytest.mark.parametrize("apart", [3e-3, 8e-3, 24e-3])
def test_symmetric_instruments_feel_symmetric_forces(usual, apart):
    """Mirror images in x, close enough to be solved together and far enough not to be."""
    x = np.array([0.03 - apart / 2, 0.03 + apart / 2])
    pair = upright(tuple(i.tip for i in upright())[:1] * 2, ((x[0], 0.03), (x[1], 0.03)))
    one = usual.with_instruments(pair)
    records = played(one.scene, poses_along(pair, (dip(x[0]), dip(x[1]))))[-1]
    mirrored = records[1, FORCE : FORCE + 3] * [-1, 1, 1]
    # A side's `FAR` where each is solved alone, and rounding.
    assert records[0, FORCE : FORCE + 3] == pytest.approx(mirrored, rel=1e-5, abs=1e-7)
    assert records[0, NORMAL] > 0.01


def test_two_tips_close_together_share_the_load(graspers):
    alone = played(graspers.scene, poses_along(graspers.instruments, (dip(0.028), None)))[-1, 0, NORMAL]
    both = played(graspers.scene, poses_along(graspers.instruments, (dip(0.028), dip(0.032))))[-1, :, NORMAL]
    assert (both > 0).all()
    assert both[0] < 0.9 * alone
    assert both.sum() > alone


def test_a_closed_jaw_holds_lifts_and_lets_go_when_it_opens(graspers):
    pressed = dip(0.026)
    lift = line((0.026, 0.03, -DEEP), (0.026, 0.03, 1.5e-3), 300)
    way = np.concatenate(
        [pressed, np.repeat(pressed[-1:], 50, axis=0), lift, np.repeat(lift[-1:], 100, axis=0)]
    )
    jaw = np.ones(len(way))
    jaw[370:] = 0.0
    jaw[-50:] = 1.0
    records = played(graspers.scene, poses_along(graspers.instruments, (way, None), jaws=(jaw, 1.0)))[:, 0]
    assert records[365, TOUCH] == TOUCHES
    assert records[380, TOUCH] == HOLDS
    assert records[-60, TOUCH] == HOLDS
    assert records[-60, NORMAL] < -5e-3  # the tissue pulls down on what lifts it
    assert not records[-49:, FORCE : FORCE + 3].any()
    assert records[-1, TOUCH] == TOUCH_PRESENT


def test_a_jaw_that_closes_on_nothing_holds_nothing(graspers):
    jaw = np.linspace(1, 0, 350)
    jaw[:120] = 0.0  # closed before it touches
    jaw[120:] = 0.0
    records = played(graspers.scene, poses_along(graspers.instruments, (dip(0.026), None), jaws=(jaw, 1.0)))[
        :, 0
    ]
    assert records[-1, TOUCH] == TOUCHES
    probe = played(graspers.scene, poses_along(graspers.instruments, (dip(0.026), None)))[-1, 0]
    assert records[-1, NORMAL] == probe[NORMAL]


def test_tissue_pulled_too_hard_slips_out_of_the_jaw(hard):
    one = hard.with_instruments(upright(places=((0.03, 0.03), (0.05, 0.03))))
    lift = line((*MIDDLE, -0.3e-3), (*MIDDLE, 12e-3), 600)
    way = np.concatenate([dip(depth=0.3e-3), np.repeat([[*MIDDLE, -0.3e-3]], 20, axis=0), lift])
    jaw = np.ones(len(way))
    jaw[355:] = 0.0
    records = played(one.scene, poses_along(one.instruments, (way, None), jaws=(jaw, 1.0)))[:, 0]
    assert records[365, TOUCH] == HOLDS
    assert -5.0 < records[:, NORMAL].min() < -2.0  # GRIP is 4 N; one tick later it is gone
    assert not records[-1, FORCE : FORCE + 3].any()


def test_friction_keeps_to_coulombs_limit_and_meets_it_when_it_slides(straight):
    slide = line((*MIDDLE, -DEEP), (0.04, 0.03, -DEEP), 300)
    way = np.concatenate([dip(), slide])
    records = played(straight.scene, right(straight, way))[:, 1]
    normal = records[:, NORMAL]
    aside = np.linalg.norm(records[:, DRAG : DRAG + 2], axis=1)
    # The slopes under a ball that leans a little add a per cent or two of the normal force.
    assert (aside <= (straight.scene.friction + 0.03) * normal + 1e-9).all()
    assert records[-1, FORCE] == pytest.approx(-straight.scene.friction * normal[-1], rel=0.25)
    assert records[-1, FORCE] < 0 < normal[-1]


def test_without_friction_a_still_tip_feels_no_drag(straight):
    records = played(straight.scene._replace(friction=0.0), right(straight, dip(rest=600)))[-1, 1]
    assert records[DRAG : DRAG + 2] == pytest.approx(
        [0, 0], abs=1e-6 * records[NORMAL]
    )  # waves that still ring


@pytest.mark.parametrize("friction", [0.0, 0.1])
def test_a_slide_over_very_soft_tissue_is_quiet(friction):
    """Uterus gives way sideways by as much as a 12 mm tip's radius: if it followed the slopes at once it would ring."""
    soft = setting(tissue("uterus"))
    pair = two_probes(SIZE, 6e-3)
    scene = make_scene(soft.model, soft.tissue, pair, friction=friction)
    forces = played(scene, poses_along(pair, two_circles(SIZE, 6e-3, 0.03)))[150:, 1, FORCE : FORCE + 3]
    normal = forces[:, 2].mean()
    assert scene.give[1] * normal > 6e-3
    # Second differences of a smooth circle of 400 ticks are (2 pi/400)^2, 2.5e-4, of its amplitude.
    assert np.abs(np.diff(forces, 2, axis=0)).max() < 3e-4 * normal


def test_a_solid_can_be_the_tissue_and_agrees_with_its_membrane(straight):
    solid = WaveSolid(
        straight.tissue, size=SIZE, modes=(48, 48), dynamic_modes=(48, 48), support=Support.BASE
    )
    scene = make_scene(solid, straight.tissue, straight.instruments)
    poses = right(straight, dip(rest=500))
    found, expected = (played(which, poses)[-1, 1, NORMAL] for which in (scene, straight.scene))
    assert found == pytest.approx(expected, rel=0.05)  # what the fit is held to


@pytest.mark.parametrize(
    ("model", "options", "words"),
    [
        ({"support": "edges"}, {}, "clamped sides"),
        ({"modes": (8, 8)}, {}, "cut-off"),
        ({}, {"friction": -0.1}, "friction"),
        ({}, {"friction": float("nan")}, "friction"),
        ({}, {"window": 0.0}, "cut-off"),
        ({}, {"dt": 0.0}, "dt"),
    ],
)
def test_a_scene_that_cannot_be_is_refused(straight, model, options, words):
    sheets = WaveMembrane(
        straight.model.stack,
        size=SIZE,
        **{"modes": (48, 48), "support": "base", **model},
        tissue=straight.tissue,
    )
    with pytest.raises(InputError, match=words):
        make_scene(sheets, straight.tissue, straight.instruments, **options)
