"""What answers say, against numbers from print and from hand."""

from datetime import UTC, datetime, timedelta
from math import erfc, sqrt

import numpy as np
import pytest

from trocar.errors import InputError
from trocar.records.opinions import (
    consistency,
    cronbach_alpha,
    differences,
    last_sheets,
    mann_whitney,
    middles,
    quartiles,
)
from trocar.records.questionnaire import GROUPS, ITEMS, SCALE, check_answers
from trocar.records.sheets import Sheet

BEGAN = datetime(2026, 1, 2, tzinfo=UTC)


def sheet(number, value=3, *, group="novice", name=None, items=ITEMS):
    values = value if isinstance(value, dict) else dict.fromkeys(items, value)
    return Sheet(
        trainee=name or f"{group} {number}",
        attempt=None,
        group=group,
        values=values,
        answered=BEGAN + timedelta(days=number),
    )


@pytest.mark.parametrize(
    ("values", "found"),
    [  # Hyndman and Fan 1996, definition 2: at p n whole, halfway to the next; otherwise the next
        ([1, 2, 3, 4], (1.5, 2.5, 3.5)),
        ([1, 2, 3, 4, 5], (2, 3, 4)),
        ([5, 4, 4, 1, 2, 2], (2, 3, 4)),
        ([4, 4, 4, 4], (4, 4, 4)),
    ],
)
def test_quartiles(values, found):
    assert quartiles(values) == found


def test_alpha_by_hand():
    # Variances of the items 1, 1 and 1, of the sums (3, 6, 9) 9: 3/2 (1 - 3/9) = 1. With the last item turned
    # round the sums are (5, 6, 7), of variance 1: 3/2 (1 - 3/1) = -3.
    same = np.array([[1, 1, 1], [2, 2, 2], [3, 3, 3]], dtype=float)
    assert cronbach_alpha(same) == pytest.approx(1)
    assert cronbach_alpha(np.array([[1, 1, 3], [2, 2, 2], [3, 3, 1]], dtype=float)) == pytest.approx(-3)
    # (1,2), (3,3), (4,3), (4,5): variances 2 and 19/12, sums 3, 6, 7, 9 with 25/4: 2 (1 - (43/12)/(25/4)) = 64/75.
    mixed = np.array([[1, 2], [3, 3], [4, 3], [4, 5]], dtype=float)
    assert cronbach_alpha(mixed) == pytest.approx(64 / 75)


def test_alpha_of_two_items_is_the_spearman_brown_of_their_correlation():
    # For two items of one variance alpha is 2r/(1 + r) (Cronbach 1951, section III).
    rng = np.random.default_rng(1)
    answers = rng.normal(size=(50, 2)) + rng.normal(size=(50, 1))
    answers = (answers - answers.mean(axis=0)) / answers.std(axis=0)
    r = np.corrcoef(answers.T)[0, 1]
    assert cronbach_alpha(answers) == pytest.approx(2 * r / (1 + r))


@pytest.mark.parametrize("answers", [[[1, 2]], [[1], [2]], [[1, 2], [2, 1]]])
def test_alpha_that_does_not_exist_is_refused(answers):
    with pytest.raises(InputError, match="alpha"):
        cronbach_alpha(np.array(answers, dtype=float))


@pytest.mark.parametrize(
    ("a", "b", "u", "p"),
    [
        # Mann and Whitney 1947, table I, n = m = 4: P(U <= 0) = 0.014, P(U <= 1) = 0.029, P(U <= 4) = 0.171.
        ([1, 2, 3, 4], [5, 6, 7, 8], 0, 2 / 70),
        ([1, 2, 3, 5], [4, 6, 7, 8], 1, 4 / 70),
        ([2, 3, 4, 5], [1, 6, 7, 8], 4, 24 / 70),
        # By hand, with ties: of the 70 divisions of 1 1 2 2 2 2 3 3 that have this U or one as far out.
        ([1, 1, 2, 2], [2, 2, 3, 3], 2, 12 / 70),
        ([2, 2, 2, 2], [2, 2, 2, 2], 8, 1),
    ],
)
def test_u_and_its_exact_p(a, b, u, p):
    found = mann_whitney(a, b)
    assert found == (u, pytest.approx(p), True)
    assert mann_whitney(b, a) == (16 - u, pytest.approx(p), True)


def test_many_answers_take_the_normal_approximation_corrected_for_ties():
    a, b = [1] * 6 + [2] * 4, [1] * 2 + [2] * 8
    # U = 6 x 2 / 2 + 4 x 2 + 4 x 8 / 2 = 30; ties of 8 and 12 leave the variance
    # 100/12 (21 - (8^3 - 8 + 12^3 - 12)/(20 x 19)) = 480/19, so z = (50 - 30 - 1/2)/sqrt(480/19).
    z = 19.5 / sqrt(100 / 12 * (21 - (8**3 - 8 + 12**3 - 12) / 380))
    assert mann_whitney(a, b) == (30, pytest.approx(erfc(z / sqrt(2))), False)


def test_each_trainee_counts_once_with_the_last_answers():
    sheets = [sheet(2, 5, name="Anna"), sheet(1, 1, name="Anna"), sheet(1, 4, name="Ben")]
    assert {one.trainee: one.values["picture"] for one in last_sheets(sheets)} == {"Anna": 5, "Ben": 4}


def test_where_answers_lie():
    sheets = [sheet(number, value) for number, value in enumerate((1, 2, 4, 5))]
    sheets += [sheet(number, 5, group="expert") for number in range(3)]
    found = {(one.item, one.group): one for one in middles(sheets)}
    assert len(found) == 2 * len(ITEMS)
    assert found["picture", "novice"].quartiles == (1.5, 3, 4.5)
    few = found["picture", "expert"]
    assert (few.n, few.quartiles, few.note) == (3, None, "too few answers: 3, 4 are needed")
    assert few.as_dict()["median"] is None


def test_consistency_is_of_complete_answers():
    sheets = [sheet(number, 1 + number % 5) for number in range(9)]
    partly = sheet(9, 4, items=["picture"])
    found = consistency([*sheets, partly])
    assert (found.n, found.alpha, found.note) == (9, None, "too few answers: 9, 10 are needed")
    assert consistency([*sheets, sheet(9, 4)]).alpha == pytest.approx(1)
    assert consistency([sheet(number) for number in range(10)]).note == "everyone's answers have the same sum"


def test_how_two_groups_differ():
    sheets = [sheet(number, 1 + number % 2) for number in range(4)]
    sheets += [sheet(number, 4 + number % 2, group="expert") for number in range(4)]
    found = {one.item: one for one in differences(sheets, "novice", "expert")}["picture"]
    assert (found.u, found.p, found.chance, found.exact) == (0, pytest.approx(2 / 70), 0, True)
    few = differences(sheets[1:], "novice", "expert")[0]
    assert (few.u, few.p, few.chance, few.note) == (None, None, None, "too few answers: 3, 4 are needed")
    with pytest.raises(InputError, match="novice or resident or expert"):
        differences(sheets, "novice", "beginner")
    with pytest.raises(InputError, match="two that differ"):
        differences(sheets, "novice", "novice")


@pytest.mark.parametrize(
    ("group", "values", "words"),
    [
        ("beginner", {"picture": 3}, "group"),
        ("novice", {}, "at least one item"),
        ("novice", {"colour": 3}, "item"),
        ("novice", {"picture": 0}, "from 1, disagree, to 5"),
        ("novice", {"picture": 6}, "from 1, disagree, to 5"),
        ("novice", {"picture": True}, "from 1, disagree, to 5"),
        ("novice", {"picture": 2.0}, "from 1, disagree, to 5"),
    ],
)
def test_what_was_not_asked_is_no_answer(group, values, words):
    with pytest.raises(InputError, match=words):
        check_answers(group, values)


def test_the_items_are_those_that_were_always_asked():
    # Answers are kept under these names: to take one away or give it another meaning would change what people said.
    assert list(ITEMS) == [
        "tissue-looks",
        "force-feel",
        "instrument-motion",
        "picture",
        "tasks-useful",
        "guidance-clear",
        "score-fair",
        "would-use",
    ]
    assert list(SCALE) == [1, 2, 3, 4, 5]
    assert GROUPS == ("novice", "resident", "expert")
