"""Palpate an organ: marks lie where it can be pressed, players see how high it is, and what is pressed counts."""

import numpy as np
import pytest

from trocar.errors import InputError
from trocar.simulation.phantom import Phantom
from trocar.training.session import ground_of
from trocar.training.tasks.catalogue import LEVELS, task
from trocar.training.tasks.palpate_organ import PHANTOM


@pytest.fixture(scope="module", params=LEVELS)
def attempted(request):
    return task("palpate-organ", request.param)


def test_marks_lie_on_the_dome_and_on_its_slopes(attempted):
    elements = PHANTOM.organ.model.elements
    slopes = []
    for step in attempted.steps:
        (mark,) = step.marks
        ring = np.array(mark.place) + mark.radius * np.array([[0, 0], [1, 0], [-1, 0], [0, 1], [0, -1]])
        _, normals = elements.seen("surface", ring)
        assert normals.shape == (5, 3)  # all of it can be pressed
        slopes.append(np.degrees(np.arccos(normals[0, 2])))
    assert min(slopes) < 15
    assert max(slopes) > 15


def test_a_player_sees_how_high_the_organ_is(attempted):
    ground = ground_of(attempted)
    places = np.array([step.marks[0].place for step in attempted.steps])
    heights = PHANTOM.organ.model.elements.heights("surface", places)
    seen = [ground(x, y) for x, y in places.tolist()]
    assert seen == pytest.approx(
        heights, abs=0.3e-3
    )  # a smooth surface through the sites, against flat faces
    assert min(seen) < -2e-3
    assert ground_of(task("palpate"))(0.03, 0.03) == 0.0


def test_the_phantom_is_cast_of_one_layer_of_its_preset():
    assert PHANTOM.material.name == "skin"
    assert PHANTOM.stuff.layers == (PHANTOM.material,)
    assert PHANTOM.size == pytest.approx(PHANTOM.organ.size)
    wrong = Phantom(name="cast", tissue="silicone-pad", layer="bone", spacing=0.01)
    with pytest.raises(InputError, match=r"cast: layer: expected .*skin.*, got 'bone'"):
        _ = wrong.material
