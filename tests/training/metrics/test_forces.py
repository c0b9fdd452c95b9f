"""What the tips did to the tissue: closed forms, and the work against the energy that the scene keeps."""

from math import isnan, nan, pi

import numpy as np
import pytest

from trocar.contact.tips import largest_sections
from trocar.simulation import (
    DIRECTION,
    FORCE,
    MOMENT,
    RECORD,
    RECORD_ROLL,
    TIP,
    TOUCH,
    TOUCH_PRESENT,
    TOUCH_TOUCHING,
    line,
    played,
    poses_along,
)
from trocar.study.contact.energy import energies_along, energy_forms
from trocar.study.contact.scenes import setting
from trocar.tissues.catalogue import tissue
from trocar.training.metrics.attempt import Attempt
from trocar.training.metrics.forces import peak_stress_ratio, work, work_on_tissue

STIFFNESS = 40.0  # [N/m]
DEPTH, TICKS = 1e-3, 1000  # [m]


def records(depths, hand=0):
    """A spring that is pressed by one hand; the other is there and does nothing."""
    made = np.zeros((len(depths), 2, RECORD))
    made[:, :, DIRECTION + 2] = -1.0
    made[:, :, TOUCH] = TOUCH_PRESENT
    made[:, hand, TIP + 2] = -np.asarray(depths)
    made[:, hand, FORCE + 2] = STIFFNESS * np.clip(depths, 0.0, None)
    made[:, hand, TOUCH] += TOUCH_TOUCHING * (np.asarray(depths) > 0)
    return made


def attempt(made, **options):
    return Attempt(times=1e-3 * np.arange(1, len(made) + 1), records=made, **options)


def press(depth):
    return np.concatenate([np.linspace(-1e-4, depth, TICKS), np.linspace(depth, -1e-4, TICKS)])


def test_a_spring_takes_half_of_force_times_way():
    # The force of a tick's end over its whole way is too much by one part in the number of ticks.
    found = work_on_tissue(attempt(records(press(DEPTH))))
    assert found == pytest.approx(0.5 * STIFFNESS * DEPTH**2, rel=2 / TICKS)


def test_the_deepest_touch_counts_and_touches_do_not_add_up():
    two = attempt(records(np.concatenate([press(DEPTH), press(2 * DEPTH), press(DEPTH)])))
    assert work_on_tissue(two) == pytest.approx(0.5 * STIFFNESS * (2 * DEPTH) ** 2, rel=2 / TICKS)


def test_both_hands_add_up_while_either_touches():
    down = np.linspace(-1e-4, DEPTH, TICKS)
    both = records(np.concatenate([down, np.full(TICKS, DEPTH)]))
    both[:, 1] = records(np.concatenate([np.full(TICKS, -1e-4), down]), hand=1)[:, 1]
    assert work_on_tissue(attempt(both)) == pytest.approx(2 * 0.5 * STIFFNESS * DEPTH**2, rel=2 / TICKS)


def test_turning_works_by_its_moment():
    made = records(np.full(TICKS, DEPTH))
    made[:, 0, FORCE + 2] = 0.0
    angles = np.linspace(0.0, 0.1, TICKS)
    made[:, 0, DIRECTION], made[:, 0, DIRECTION + 2] = np.sin(angles), -np.cos(angles)  # about -y
    made[:, 0, MOMENT + 1] = 3e-3
    assert work(attempt(made))[:, 0].sum() == pytest.approx(0.1 * 3e-3, rel=1e-6)
    made[:, 0, DIRECTION], made[:, 0, DIRECTION + 2] = 0.0, -1.0
    made[:, 0, RECORD_ROLL] = angles  # about -z
    made[:, 0, MOMENT + 2] = 2e-3
    assert work(attempt(made))[:, 0].sum() == pytest.approx(0.1 * 2e-3, rel=1e-12)


def test_nobody_works_without_touching_or_between_two_places_where_they_were_not_there():
    assert work_on_tissue(attempt(records(np.full(TICKS, -1e-3)))) == 0.0
    made = records(np.full(TICKS, DEPTH))
    made[500:, 0, TIP + 2] = -3 * DEPTH
    assert work_on_tissue(attempt(made)) > 0
    made[500, 0, TOUCH] = 0.0
    assert work_on_tissue(attempt(made)) == 0.0


def test_the_work_is_that_of_the_scene_and_no_less_than_what_it_stores():
    skin = setting(tissue("skin"), undamped=True)
    above, in_it = (0.020, 0.030, 5e-4), (0.021, 0.030, -8e-4)
    aside, out = (0.026, 0.034, -6e-4), (0.026, 0.034, 4e-3)
    way = np.concatenate([line(above, in_it, 400), line(in_it, aside, 400), line(aside, out, 200)])
    poses = poses_along(skin.instruments, (way, None))
    stored, done, well = energies_along(skin.scene, energy_forms(skin.model, skin.scene), poses)
    assert well
    tried = attempt(played(skin.scene, poses))
    # To the roll's own reference, which turns a little as the shaft swings, and the square of a tick's turn.
    assert np.abs(np.cumsum(work(tried).sum(axis=1)) - done).max() < 0.01 * done.max()
    assert work_on_tissue(tried) == pytest.approx(done.max(), rel=0.01)
    assert 0.3 * work_on_tissue(tried) < stored.max() < 1.01 * work_on_tissue(tried)


def test_the_stress_is_the_force_over_the_largest_section_and_the_strength():
    sections = largest_sections(np.array([[2e-3, 2e-3, 2e-3], [1e-3, 4e-3, 2e-3]]))
    assert sections == pytest.approx([pi * 4e-6, pi * 8e-6])
    made = records([DEPTH] * 200)
    made[:, 1, FORCE] = 2 * STIFFNESS * DEPTH  # twice the force on twice the section
    found = peak_stress_ratio(attempt(made, strength=1e4, sections=sections))
    assert found == pytest.approx(STIFFNESS * DEPTH / (pi * 4e-6) / 1e4)
    made[:, 1, FORCE] *= 1.5
    assert peak_stress_ratio(attempt(made, strength=1e4, sections=sections)) == pytest.approx(1.5 * found)
    assert isnan(peak_stress_ratio(attempt(made, strength=nan, sections=sections)))


def test_a_shadow_is_never_larger_than_the_largest_section():
    rng = np.random.default_rng(0)
    axes = np.array([0.26, 0.96, 0.5])
    for normal in rng.normal(size=(200, 3)):
        unit = normal / np.linalg.norm(normal)
        # Shadow of an ellipsoid along a unit vector: pi sqrt(sum of (product of the other two axes x component)^2).
        shadow = pi * np.linalg.norm(unit * np.prod(axes) / axes)
        assert shadow <= largest_sections(axes[None])[0]
