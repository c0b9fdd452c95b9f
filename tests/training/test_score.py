"""Scores of the FLS pattern."""

import pytest

from trocar.errors import InputError
from trocar.training.score import Marking, score

MARKING = Marking(cutoff=300.0, expert_time=48.0, pass_score=80.0)


@pytest.mark.parametrize(
    ("time", "errors", "over_limit", "found"),
    [
        (48.0, 0, 0.0, 100.0),
        (174.0, 0, 0.0, 50.0),
        (48.0, 5, 2.0, 100 * (252 - 60) / 252),
        (300.0, 0, 0.0, 0.0),
        (290.0, 1, 0.0, 0.0),
        (400.0, 9, 50.0, 0.0),
    ],
)
def test_the_pattern(time, errors, over_limit, found):
    assert score(MARKING, time=time, errors=errors, over_limit=over_limit) == pytest.approx(found)


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"expert_time": 300.0}, "expert_time"),
        ({"expert_time": 0.0}, "expert_time"),
        ({"pass_score": 0.0}, "pass_score"),
        ({"pass_score": 101.0}, "pass_score"),
        ({"per_error": -1.0}, "per_error"),
        ({"per_second_over_limit": float("nan")}, "per_second_over_limit"),
    ],
)
def test_impossible_markings_are_refused(values, words):
    with pytest.raises(InputError, match=words):
        Marking(**{"cutoff": 300.0, "expert_time": 48.0, "pass_score": 80.0} | values)
