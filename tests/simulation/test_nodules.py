"""A nodule in a live scene: felt where it lies, nowhere else, and giving no energy."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from trocar.simulation import FORCE, at_rest, line, make_scene, played, poses_along
from trocar.simulation.live import LIVE_SIZE, live_model
from trocar.simulation.step import POSE, RECORD, advance, amplitudes
from trocar.study.contact.scenes import setting, upright
from trocar.tissues.catalogue import tissue
from trocar.tissues.nodule import Nodule

NODULE = Nodule(x=0.03, y=0.03, depth=8e-3, radius=5e-3, young_modulus=3e5)
OVER, DEEP = 1e-3, 0.5e-3


@cache
def scene_with(*nodules):
    pad = tissue("silicone-pad")
    one = setting(pad, instruments=upright())
    model = live_model(pad)
    assert model.size == LIVE_SIZE
    return replace(one, scene=make_scene(model, pad, one.instruments, nodules=nodules))


def held(one, x, y=0.03):
    """Return the right tip's force, down from above and then held [N]."""
    down = line((x, y, OVER), (x, y, -DEEP), 150)
    way = np.concatenate([down, np.repeat(down[-1:], 400, axis=0)])
    return np.array([r[1, FORCE + 2] for r in played(one.scene, poses_along(one.instruments, (None, way)))])


def test_over_a_nodule_less_gives_way_and_far_from_it_nothing_is_felt():
    plain, lump = scene_with(), scene_with(NODULE)
    ratios = [held(lump, x)[-1] / held(plain, x)[-1] for x in (0.03, 0.036, 0.05)]
    assert ratios[0] > 1.4  # of a tool of 8 mm finite elements say 1.9 (bench/nodule.py), of a tip less
    assert ratios[0] > ratios[1] > ratios[2]
    assert ratios[2] == pytest.approx(1.0, abs=0.05)


def test_the_force_settles_and_does_not_tremble():
    force = held(scene_with(NODULE), 0.033)
    still = force[-100:]
    assert np.isfinite(force).all()
    assert np.ptp(still) < 1e-3 * still[-1]


def test_it_is_as_stiff_wherever_it_lies():
    elsewhere = replace(NODULE, x=0.024, y=0.036)
    there = held(scene_with(elsewhere), 0.024, 0.036)[-1] / held(scene_with(), 0.024, 0.036)[-1]
    here = held(scene_with(NODULE), 0.03)[-1] / held(scene_with(), 0.03)[-1]
    assert there == pytest.approx(here, rel=0.01)  # the sides are 24 mm away, and a shaft leans by its place


def test_two_tips_over_one_nodule_feel_each_other_through_it():
    one = scene_with(NODULE)
    down = line((0.033, 0.03, OVER), (0.033, 0.03, -DEEP), 150)
    right = np.concatenate([down, np.repeat(down[-1:], 400, axis=0)])
    alone = played(one.scene, poses_along(one.instruments, (None, right)))[-1, 1, FORCE + 2]
    left = right * (-1, 1, 1) + (0.06, 0, 0)
    both = played(one.scene, poses_along(one.instruments, (left, right)))[-1]
    assert both[1, FORCE + 2] < 0.95 * alone
    assert both[0, FORCE + 2] > 0.5 * both[1, FORCE + 2]  # it has another tip


def test_left_alone_the_tissue_comes_to_rest():
    """No energy comes out of the springs: a dent that is let go dies away, as it does without a nodule."""
    one = scene_with(NODULE)
    state, records = at_rest(one.scene), np.zeros((2, RECORD))
    down = line((0.03, 0.03, OVER), (0.03, 0.03, -DEEP), 150)
    for pose in poses_along(one.instruments, (None, down)):
        assert advance(one.scene, state, pose, records)
    largest, out = [], np.zeros((one.scene.layers, *one.scene.modes))
    for _ in range(600):
        assert advance(one.scene, state, np.zeros((2, POSE)), records)
        amplitudes(one.scene, state, out)
        largest.append(float(np.abs(out).max()))
    assert largest[0] > 1e-6
    assert max(largest[300:]) < 1e-2 * largest[0]
