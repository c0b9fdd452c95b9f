"""The whole loop with nobody present: a scripted trainee, a recording, and a score that follows from it alone."""

import numpy as np
import pytest

from trocar.errors import InputError
from trocar.simulation import POSE
from trocar.training.headless import attempt
from trocar.training.players import Skill
from trocar.training.session import Recording, assess
from trocar.training.tasks.catalogue import TASKS, task


@pytest.fixture(scope="module", params=list(TASKS))
def pair(request):
    return tuple(attempt(request.param, skill=skill, seed=1) for skill in (Skill.EXPERT, Skill.NOVICE))


def test_the_expert_passes_and_outscores_the_novice(pair):
    expert, novice = pair
    assert expert.card.passed
    assert expert.card.score > novice.card.score
    assert expert.card.mistakes == ()
    assert expert.card.duration >= 20.0
    assert expert.card.metrics["peak_force"] < expert.task.force_limit


def test_the_score_is_a_function_of_the_recording_alone(pair):
    for done in pair:
        again = assess(done.task, Recording(poses=done.recording.poses.copy()))
        assert again.as_dict() == done.card.as_dict()


def test_a_slower_hand_has_a_lower_score(pair):
    expert, _ = pair
    slow = np.repeat(expert.recording.poses, 2, axis=0)
    card = assess(expert.task, Recording(poses=slow))
    assert card.completed
    assert card.score < expert.card.score
    assert card.advice[0].startswith("Time cost you much")


def test_what_comes_after_the_last_step_changes_nothing(pair):
    expert, _ = pair
    poses = expert.recording.poses
    longer = np.concatenate([poses, np.repeat(poses[-1:], 3000, axis=0)])
    assert assess(expert.task, Recording(poses=longer)).as_dict() == expert.card.as_dict()


def test_the_same_seed_does_the_same_and_another_does_not():
    first, again, other = (attempt("palpate", seed=seed).recording.poses for seed in (3, 3, 4))
    assert first.tobytes() == again.tobytes()
    assert first.tobytes() != other.tobytes()


def test_half_an_attempt_scores_nothing_and_says_where_it_ended():
    done = attempt("palpate", seed=3)
    half = assess(done.task, Recording(poses=done.recording.poses[: len(done.recording.poses) // 2]))
    assert half.score == 0.0
    assert not half.passed
    assert half.advice[0].startswith("Go on to the end, or there are no points. What was left: ")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [({"skill": "master"}, "expert or novice"), ({"seed": -1}, "seed"), ({"level": 9}, "level")],
)
def test_what_there_is_not_is_refused(arguments, words):
    with pytest.raises(InputError, match=words):
        attempt("palpate", **arguments)


def test_impossible_recordings_are_refused():
    with pytest.raises(InputError, match="shape"):
        Recording(poses=np.zeros((10, 2, 3)))
    poses = np.zeros((10, 2, POSE))
    poses[3, 0, 4] = np.nan
    with pytest.raises(InputError, match="finite"):
        Recording(poses=poses)
    with pytest.raises(InputError, match="dt"):
        assess(task("palpate"), Recording(poses=np.zeros((10, 2, POSE)), dt=4e-3))
