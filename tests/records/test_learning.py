"""A learning curve: what counts, what the chart says, and what remains."""

import pytest

from score_cards import attempt
from trocar.training.practice import Cusum


def after(records, passed, name="Anna"):
    for one in passed:
        attempt(records, name, passed=one, score=80.0 if one else 40.0)
    return records.history(name, "palpate")


@pytest.mark.parametrize(
    ("passed", "after_attempt", "remains"),
    [
        ([], None, "two passes in a row"),
        ([False], None, "two passes in a row"),
        ([True], None, "one more pass in a row"),
        ([True, False], None, "two passes in a row"),
        ([False, True], None, "one more pass in a row"),
        ([True, True], 2, "nothing: proficient after attempt 2"),
        ([True, True, False], 2, "nothing: proficient after attempt 2"),
    ],
)
def test_what_remains(records, passed, after_attempt, remains):
    found = after(records, passed)
    assert (found.proficient_after, found.remains) == (after_attempt, remains)


def test_the_chart_is_that_of_finished_attempts_at_one_task_and_level(records):
    attempt(records, "Ben")
    attempt(records, level=2)
    attempt(records, task="lift")
    number = records.begin(records.trainee("Anna"), task="palpate", level=1, device="web", header={}, dt=1e-3)
    records.interrupt(number, "the page was closed")
    found = after(records, [False, True, False])
    cusum = Cusum()
    assert found.passed == (False, True, False)
    steps = [1 - cusum.step, 1 - 2 * cusum.step, 2 - 3 * cusum.step]
    assert found.chart.tolist() == pytest.approx(steps)
    # The step and both limits as published for 5 % and 15 % (Bolsin and Colson 2000): 0.0919 and 1.816.
    assert steps[-1] == pytest.approx(2 - 3 * 0.0919, abs=2e-4)
    assert found.alarm_after is None
    assert found.proof_after is None


def test_failures_raise_an_alarm_and_passes_prove_the_contrary(records):
    assert after(records, [False, False]).alarm_after == 2  # 2 ln 3 = ln 9: just reached
    found = after(records, [True] * 20, "Ben")
    assert (found.alarm_after, found.proof_after) == (None, 20)  # 19 x 0.0919 is 1.746


def test_a_history_as_json(records):
    found = after(records, [True]).as_dict()
    assert found["attempts"][0]["cusum"] == pytest.approx(-0.0919, abs=1e-4)
    assert (found["cusum"]["alarm"], found["cusum"]["proof"]) == (pytest.approx(1.816, abs=1e-3),) * 2
    assert found["remains"] == "one more pass in a row"
