"""The coupled tick of a sheet: pressing, gliding, holding and cutting it, by poses alone."""

from itertools import pairwise
from math import log, pi, sqrt

import numpy as np
import pytest

from trocar.contact.blades import SPLIT
from trocar.contact.instrument import TipKind
from trocar.contact.port_sets import instruments_through
from trocar.errors import InputError
from trocar.simulation import (
    CUT,
    FORCE,
    MOMENT,
    PLACE,
    RECORD,
    RECORD_JAW,
    TIP,
    TOUCH,
    TOUCH_HOLDING,
    TOUCH_TOUCHING,
    line,
    poses_along,
)
from trocar.simulation.kind import SHEET, kind_of
from trocar.simulation.sheet_scene import make_sheet_scene, sheet_at_rest
from trocar.simulation.sheet_step import TOLD, advance_sheet, renew_sheet, sheet_planes
from trocar.simulation.step import CLOSED
from trocar.study.contact.scenes import upright
from trocar.waves.sheet.lattice import moving, stored, taut
from trocar.waves.sheet.sheet import Sheet

FRAME = Sheet()


@pytest.fixture(scope="module")
def scissors():
    """Scissors through the trainer's ports, and the scene."""
    pair = instruments_through("scissors", FRAME.size)
    return pair, make_sheet_scene(FRAME, pair)


@pytest.fixture(scope="module")
def straight():
    """A grasper and a probe from right above."""
    pair = upright((TipKind.GRASPER, TipKind.PROBE), ((0.02, 0.03), (0.03, 0.03)))
    return pair, make_sheet_scene(FRAME, pair)


def go(setting, tip, state, jaw=1.0, hand=1):
    """Lead one hand's tip along a way from where the sheet stands; return the records."""
    pair, scene = setting
    tips, jaws = ((None, tip), (1.0, jaw)) if hand else ((tip, None), (jaw, 1.0))
    records = np.zeros((len(tip), 2, RECORD))
    assert SHEET.play(scene, state, poses_along(pair, tips, jaws=jaws), records)
    return records[:, hand]


def down(place, depth, ticks=400):
    return line((*place, 2e-3), (*place, -depth), ticks)


def still(place, depth, ticks):
    return np.tile((*place, -depth), (ticks, 1))


def snip(setting, place, depth, state):
    """Come down on a place, close the blades and open them; return the records of the latter."""
    go(setting, down(place, depth), state)
    jaw = np.concatenate([np.linspace(1, 0, 100), np.linspace(0, 1, 100)])
    return go(setting, still(place, depth, 200), state, jaw)


def pressed_membrane(depth, tip, frame):
    """Return the force of a ball on a round membrane [N]: where it leaves the ball at r, F = 2 pi r T times the slope.

    Args:
        depth: of the ball's lowest point [m].
        tip: radius of the ball [m].
        frame: radius of the membrane [m].
    """
    low, high = 0.0, tip
    for _ in range(60):
        r = (low + high) / 2
        up = sqrt(tip**2 - r**2)
        low, high = (r, high) if r**2 / up * log(frame / r) + tip - up < depth else (low, r)
    return 2 * pi * FRAME.tension * r**2 / up


@pytest.mark.parametrize(("depth", "cells"), [(2e-3, 40), (3e-3, 40), (1e-3, 80)])
def test_it_answers_as_a_membrane_does(straight, depth, cells):
    """Between round membranes in and around the frame; a ball that touches one node alone is felt a fifth too soft."""
    sheet = Sheet(cells=cells)
    setting = (straight[0], make_sheet_scene(sheet, straight[0]))
    state = sheet_at_rest(setting[1])
    go(setting, down((0.03, 0.03), depth), state)
    force = float(go(setting, still((0.03, 0.03), depth, 400), state)[-1, FORCE + 2])
    ball = float(setting[1].axes[1, 0]) + setting[1].wider
    around, inside = (pressed_membrane(depth, ball, radius) for radius in (0.03 * sqrt(2), 0.03))
    assert around < force < inside


def test_no_node_lies_above_the_underside(straight):
    """Of the ball that presses, half a spacing larger than the probe's and as low."""
    _, scene = straight
    state = sheet_at_rest(scene)
    path = np.concatenate([down((0.03, 0.03), 2e-3), line((0.03, 0.03, -2e-3), (0.034, 0.028, -2e-3), 200)])
    n, h = scene.lattice.columns, scene.lattice.spacing
    at = np.arange(len(scene.lattice.free))
    ball = float(scene.axes[1, 0]) + scene.wider
    worst = 0.0
    for tip in path:
        go(straight, tip[None], state)
        centre = state.centres[1]
        x, y = (
            at % n * h + state.lattice.places[0] - centre[0],
            at // n * h + state.lattice.places[1] - centre[1],
        )
        inside = x**2 + y**2 < ball**2
        underside = centre[2] - np.sqrt(ball**2 - x[inside] ** 2 - y[inside] ** 2)
        worst = max(worst, float((state.lattice.places[2][inside] - underside).max(initial=0.0)))
    assert worst < 1e-12


def test_force_and_moment_balance_what_the_links_pull_with(straight):
    """At rest the force on the tip is that of the rim: nothing else holds the sheet."""
    _, scene = straight
    state = sheet_at_rest(scene)
    go(straight, down((0.027, 0.033), 2e-3), state)
    record = go(straight, still((0.027, 0.033), 2e-3, 1500), state)[-1]
    n = scene.lattice.columns
    z, pulled = state.lattice.places[2].reshape(-1, n), 0.0
    k1, e = scene.lattice.side, scene.lattice.stretch
    for rim, inner in ((z[0], z[1]), (z[-1], z[-2]), (z[:, 0], z[:, 1]), (z[:, -1], z[:, -2])):
        pulled += float(k1 * e * (rim - inner).sum() + 0.5 * k1 * e * (2 * rim - inner).sum())
        pulled += -float(0.5 * k1 * e * inner.sum())
    assert record[FORCE + 2] == pytest.approx(pulled, rel=2e-3)  # creep of the last dampings
    assert abs(record[MOMENT + 2]) < 1e-6


def test_what_is_first_seen_below_touches_nothing(straight):
    state = sheet_at_rest(straight[1])
    records = go(straight, still((0.03, 0.03), 2e-3, 50), state)
    assert not records[:, FORCE : FORCE + 3].any()
    assert not (records[:, TOUCH].astype(int) & TOUCH_TOUCHING).any()
    go(straight, line((0.03, 0.03, -2e-3), (0.03, 0.03, 1e-3), 50), state)
    assert go(straight, down((0.03, 0.03), 1e-3), state)[-1, FORCE + 2] > 0


def test_friction_draws_the_sheet_along_and_no_further_than_it_can(straight):
    state = sheet_at_rest(straight[1])
    go(straight, down((0.025, 0.03), 1e-3), state)
    records = go(straight, line((0.025, 0.03, -1e-3), (0.035, 0.03, -1e-3), 1000), state)[200:]
    assert (records[:, FORCE] < 0).mean() > 0.9
    # Coulomb's limit, and what the slope under the tip adds where it runs up a node: a spacing's over the tip's radius.
    assert np.abs(records[:, FORCE]).mean() < 2.5 * straight[1].friction * records[:, FORCE + 2].mean()


def test_a_jaw_takes_the_sheet_with_it_and_lets_go(straight):
    place = (0.03, 0.03)
    pair = upright((TipKind.GRASPER, TipKind.PROBE), (place, (0.05, 0.03)))
    setting = (pair, make_sheet_scene(FRAME, pair))
    state = sheet_at_rest(setting[1])
    go(setting, down(place, 1e-3), state, hand=0)
    closed = go(setting, still(place, 1e-3, 100), state, np.linspace(1, 0, 100), hand=0)
    assert int(closed[-1, TOUCH]) & TOUCH_HOLDING
    up = go(setting, line((*place, -1e-3), (*place, 3e-3), 400), state, 0.0, hand=0)
    assert up[-1, FORCE + 2] < -0.02
    assert state.lattice.places[2].max() > 2.5e-3
    off = go(setting, np.tile((*place, 3e-3), (100, 1)), state, np.linspace(0, 1, 100), hand=0)
    assert not int(off[-1, TOUCH]) & (TOUCH_HOLDING | TOUCH_TOUCHING)
    assert not off[-1, FORCE : FORCE + 3].any()


def test_blades_cut_what_lies_between_them(scissors):
    pair, scene = scissors
    state = sheet_at_rest(scene)
    place = (0.03, 0.03)
    records = snip(scissors, place, 1e-3, state)
    at = int(np.flatnonzero(records[:, CUT])[0])
    assert records[at, RECORD_JAW] < CLOSED <= records[at - 1, RECORD_JAW]
    links, x0, y0, x1, y1 = records[at, CUT : CUT + 5]
    assert links == (taut(scene.lattice).whole - state.lattice.whole).sum() > 0
    # From a little before the tip, along the shaft as seen from above, by a bite of one to three millimetres.
    assert np.hypot(x0 - place[0], y0 - place[1]) == pytest.approx(SPLIT, abs=2e-4)
    towards = np.subtract(pair[1].port[:2], place)
    bite = np.array([x1 - x0, y1 - y0])
    assert bite @ towards / np.linalg.norm(towards) == pytest.approx(np.linalg.norm(bite), rel=0.02)
    assert 1e-3 < np.linalg.norm(bite) - 2 * SPLIT < 3e-3
    assert records[at, PLACE : PLACE + 2] == pytest.approx(place, abs=1.5e-3)
    told = go(scissors, still(place, 1e-3, TOLD), state)[:, CUT : CUT + 5]
    assert told[0].any()
    assert not told[-1].any()


def test_blades_that_are_shut_or_lie_flat_or_are_away_cut_nothing(scissors):
    pair, scene = scissors
    place = (0.03, 0.03)
    for height, jaw, roll in ((-1e-3, np.zeros(200), 0.0), (4e-3, None, 0.0), (-1e-3, None, pi / 2)):
        state = sheet_at_rest(scene)
        close = np.concatenate([np.linspace(1, 0, 100), np.linspace(0, 1, 100)]) if jaw is None else jaw
        way = np.concatenate(
            [line((*place, 5e-3), (*place, height), 400), np.tile((*place, height), (200, 1))]
        )
        jaws = np.concatenate([np.full(400, close[0]), close])
        records = np.zeros((600, 2, RECORD))
        SHEET.play(scene, state, poses_along(pair, (None, way), jaws=(1.0, jaws), rolls=(0.0, roll)), records)
        assert not records[:, :, CUT : CUT + 5].any()
        assert state.lattice.whole.sum() == taut(scene.lattice).whole.sum()


def test_a_slit_opens_and_a_new_sheet_is_whole(scissors):
    _, scene = scissors
    state = sheet_at_rest(scene)
    for share in np.linspace(0, 1, 12):
        place = (0.038 - 0.016 * share, 0.026 + 0.008 * share)
        snip(scissors, place, 1e-3, state)
        go(scissors, line((*place, -1e-3), (*place, 2e-3), 60), state)
    go(scissors, np.tile((0.03, 0.03, 0.015), (600, 1)), state)
    planes = np.zeros((scene.layers, *scene.modes))
    sheet_planes(scene, state, planes)
    assert np.ptp(planes[2, 18:23, 20]) > 1e-3  # the flanks' way apart, across the slit
    inside = planes[3:, 1:-2, 1:-2]
    assert inside.reshape(3, -1).any(axis=1).all()
    assert 0 <= inside.min() < 0.1
    assert 0.9 < inside.max() <= 1
    assert stored(scene.lattice, state.lattice) < stored(scene.lattice, taut(scene.lattice))
    renew_sheet(scene, state)
    fresh = np.zeros_like(planes)
    sheet_planes(scene, state, fresh)
    sheet_planes(scene, sheet_at_rest(scene), planes)
    assert np.array_equal(fresh, planes)


def test_the_same_poses_give_the_same_bits_and_the_sheet_comes_to_rest(scissors):
    pair, scene = scissors
    rng = np.random.default_rng(3)
    ways = []
    for x in (0.02, 0.04):
        knots = np.stack(
            [
                x + rng.uniform(-4e-3, 4e-3, 9),
                0.03 + rng.uniform(-8e-3, 8e-3, 9),
                rng.uniform(-2e-3, 2e-3, 9),
            ],
            1,
        )
        knots[0, 2] = 3e-3
        ways.append(np.concatenate([line(a, b, 100) for a, b in pairwise(knots)]))
    jaws = 0.5 + 0.5 * np.cos(np.arange(800) / 40)
    poses = poses_along(pair, tuple(ways), jaws=(jaws, jaws))
    first, again = (SHEET.played(scene, poses) for _ in range(2))
    assert first.tobytes() == again.tobytes()
    assert np.isfinite(first).all()
    assert (first[:, :, CUT] > 0).any()
    state = sheet_at_rest(scene)
    SHEET.play(scene, state, poses, np.zeros_like(first))
    whole = stored(scene.lattice, taut(scene.lattice))
    poses[:, :, 0] = 0.0  # out of the hands
    SHEET.play(scene, state, np.tile(poses[-1:], (1500, 1, 1)), np.zeros((1500, 2, RECORD)))
    assert moving(scene.lattice, state.lattice) < 1e-7 * whole
    assert stored(scene.lattice, state.lattice) < whole


def test_a_number_that_is_not_finite_is_told(scissors):
    pair, scene = scissors
    state = sheet_at_rest(scene)
    state.lattice.places[2, 800] = np.nan
    records = np.ones((2, RECORD))
    pose = poses_along(pair, (None, np.array([[0.03, 0.03, 1e-3]])))[0]
    assert not advance_sheet(scene, state, pose, records)
    assert not records[:, FORCE : FORCE + 3].any()
    renew_sheet(scene, state)
    assert advance_sheet(scene, state, pose, records)
    assert records[1, TIP] == pytest.approx(0.03)


def test_a_kind_is_known_by_its_scene_and_friction_by_its_bounds(scissors):
    assert kind_of(scissors[1]) is SHEET
    with pytest.raises(InputError, match="friction"):
        make_sheet_scene(FRAME, scissors[0], friction=-0.1)
