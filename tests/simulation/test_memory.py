"""The trainer's sheets on a tissue that remembers: a tip that is held still feels the tissue give way."""

from dataclasses import replace

import numpy as np
import pytest

from trocar.simulation import FORCE, line, played, poses_along
from trocar.simulation.live import live_model
from trocar.simulation.scene import make_scene
from trocar.study.contact.scenes import setting, upright
from trocar.tissues import Tissue
from trocar.tissues.catalogue import tissue

OVER, DEEP = 2e-3, 0.8e-3


def held(layers, seconds, scene=None):
    """Return the force along the normal of the right tip, down from above and then held [N]."""
    one = setting(layers, instruments=upright())
    if scene is not None:
        one = replace(one, scene=scene(layers, one.instruments))
    down = line((0.03, 0.03, OVER), (0.03, 0.03, -DEEP), 150)
    way = np.concatenate([down, np.repeat(down[-1:], round(1000 * seconds), axis=0)])
    return np.array([r[1, FORCE + 2] for r in played(one.scene, poses_along(one.instruments, (None, way)))])


def test_under_a_tip_held_still_the_force_relaxes_to_that_of_the_long_term_tissue():
    skin = tissue("skin")
    series = ((0.5, 0.1),), ((0.8, 0.2),), ((1.0, 0.05), (0.5, 0.3))
    remembers = Tissue(
        layers=tuple(replace(layer, prony=own) for layer, own in zip(skin.layers, series, strict=True))
    )
    force, elastic = held(remembers, 2.5), held(skin, 0.5)
    assert np.isfinite(force).all()
    assert abs(force[160]) > 1.2 * abs(force[-1])
    late = np.abs(force[300:])
    assert (np.diff(late) <= 1e-3 * late[-1]).all()
    assert force[-1] == pytest.approx(elastic[-1], rel=0.01)


def test_all_waves_relax_likewise():
    """`WaveSolid` in the trainer's place: layers that relax alike end where those that do not relax are."""

    def scene(layers, instruments):
        return make_scene(live_model(layers, "wave-solid"), layers, instruments)

    skin = tissue("skin")
    remembers = replace(skin, layers=tuple(replace(layer, prony=((1.0, 0.05),)) for layer in skin.layers))
    force, elastic = held(remembers, 0.5, scene), held(skin, 0.4, scene)
    assert force[-1] == pytest.approx(elastic[-1], rel=0.005)  # tolerance: what is left of it after 0.5 s
    assert 1.1 * elastic[-1] < force[160] < 2.0 * elastic[-1]
