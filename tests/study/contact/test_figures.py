"""The figures contact is held to: a fiftieth of `bench/contact.py`'s trajectories, and all of its single motions."""

from dataclasses import replace

import numpy as np
import pytest

from trocar.simulation import RECORD, advance, at_rest
from trocar.study.contact.energy import energies_along, energy_forms
from trocar.study.contact.figures import (
    Figure,
    contact_table,
    energy_figures,
    motion_figures,
    undamped_settings,
    weakened,
)
from trocar.study.contact.passivity import ROUNDING, passivity, rise
from trocar.study.contact.scenes import SIZE
from trocar.study.contact.trajectories import KINDS, random_poses
from trocar.waves.state import WaveState
from trocar.waves.tick import oscillators_of

SHARE = 200  # of 10 000
SEED = 0


@pytest.fixture(scope="module")
def undamped():
    return undamped_settings()


def test_contact_generates_no_energy(undamped):
    figures = energy_figures(undamped, SHARE, seed=SEED)
    missed = [figure for figure in figures if not figure.kept]
    assert not missed, contact_table(figures)
    assert sum(figure.control for figure in figures) == 1


def test_single_motions_keep_to_their_bounds():
    figures = motion_figures()
    assert len(figures) == 22
    assert all(figure.kept for figure in figures), contact_table(figures)


def test_a_weakened_contact_is_noticed_on_every_smooth_way(undamped):
    for found in passivity([weakened(undamped[0])], 8, seed=SEED):
        if found.kind == "sine":
            assert found.rise > 1e4 * ROUNDING
            assert found.rising == 1.0


def test_a_propagator_off_by_a_thousandth_is_noticed(undamped):
    one = undamped[0]
    planes = one.scene.tick.planes.copy()
    planes[0, 0] *= 1.001  # one entry of the longest wave's step
    off = replace(one, scene=one.scene._replace(tick=one.scene.tick._replace(planes=planes)))
    (found,) = (kind for kind in passivity([off], 8, seed=1) if kind.kind == "sine")
    assert found.rise > 10 * ROUNDING
    assert found.rising == 1.0


def test_the_waves_energy_is_the_models_own(undamped):
    one = undamped[0]
    forms = energy_forms(one.model, one.scene)
    poses = random_poses("sine", np.random.default_rng(3), one.instruments, SIZE)
    state, records = at_rest(one.scene), np.zeros((2, RECORD))
    for pose in poses[:300]:
        advance(one.scene, state, pose, records)
    stored, _, well = energies_along(one.scene, forms, poses[:300])
    near = sum(
        0.5 * state.forces.reshape(2, -1)[t] @ one.scene.near[t] @ state.forces.reshape(2, -1)[t]
        for t in (0, 1)
    )
    aside = 0.5 * float((one.scene.give[:, None] * state.drag**2).sum())
    waves = one.model.modal_energy(WaveState(0.0, (oscillators_of(one.scene.tick, state.tick),))).sum()
    assert well
    assert near > 0
    assert stored[-1] == pytest.approx(
        waves + near + aside, rel=1e-9
    )  # two ways to add up thousands of terms


@pytest.mark.parametrize("kind", list(KINDS))
def test_trajectories_repeat_by_their_seed_and_touch(undamped, kind):
    one = undamped[0]
    first, again = (random_poses(kind, np.random.default_rng(7), one.instruments, SIZE) for _ in range(2))
    assert first.tobytes() == again.tobytes()
    assert np.isfinite(first).all()


def test_a_rise_is_counted_from_the_lowest_moment_before():
    assert rise(np.array([-1.0, -3.0, -2.5, -4.0])) == 0.5
    assert rise(np.array([0.25, -1.0])) == 0.25
    assert rise(np.array([-1.0, -2.0])) == 0.0


def test_a_control_is_kept_when_it_exceeds_its_bound():
    weak = Figure(name="weak", value=0.1, bound=0.01, control=True)
    missed = Figure(name="missed", value=0.1, bound=0.01)
    assert weak.kept
    assert not missed.kept
    assert contact_table([weak, missed]).splitlines()[1].endswith("MISSED")
