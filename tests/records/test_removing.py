"""A trainee who is removed leaves nothing behind, and a number that is never given again."""

import sqlite3

import pytest

from score_cards import attempt
from trocar.errors import InputError
from trocar.records.questionnaire import ITEMS

SECRET = b"a hand that nobody else has " * 400


@pytest.fixture
def course(records):
    for name in ("Ada", "Ben"):
        number = attempt(records, name)
        trainee = records.trainee(name)
        records.answer(trainee, number, "novice", dict.fromkeys(ITEMS, 3))
        records.answer(trainee, None, "novice", dict.fromkeys(ITEMS, 4))
        left = records.begin(trainee, task="palpate", level=1, device="web", header={}, dt=1e-3)
        records.add(left, SECRET if name == "Ben" else b"x", 500)
        records.interrupt(left, "the page was closed")
    return records


def counted(records):
    with sqlite3.connect(records.path) as connection:
        tables = ("trainee", "attempt", "metric", "chunk", "answer")
        found = {name: connection.execute(f"SELECT count(*) FROM {name}").fetchone()[0] for name in tables}
    connection.close()
    return found


def test_nothing_of_a_removed_trainee_is_left(course):
    before = counted(course)
    course.give_back_space()  # out of the companion file, so that sizes compare
    large = course.path.stat().st_size
    assert course.remove(" Ben ") == 2
    assert counted(course) == {name: count / 2 for name, count in before.items()}
    assert [row.trainee for row in course.attempts()] == ["Ada", "Ada"]
    course.give_back_space()
    assert course.path.stat().st_size < large
    for file in course.path.parent.iterdir():
        left = file.read_bytes()
        assert SECRET[:28] not in left
        assert b"Ben" not in left


def test_a_number_is_never_given_again(course):
    was = course.trainee("Ben").id
    course.remove("Ben")
    course.give_back_space()
    assert course.trainee("Cleo").id == was + 1
    course.remove("Ada")
    assert course.trainee("Ben").id == was + 2


def test_who_has_an_attempt_under_way_stays_whole(course):
    course.begin(course.trainee("Ben"), task="palpate", level=1, device="web", header={}, dt=1e-3)
    before = counted(course)
    with pytest.raises(InputError, match="expected no attempt under way, got 'attempt 5'"):
        course.remove("Ben")
    assert counted(course) == before


def test_a_removal_that_fails_midway_removes_nothing(course):
    before = counted(course)
    with sqlite3.connect(course.path) as connection:
        connection.execute(
            "CREATE TRIGGER stop BEFORE DELETE ON trainee BEGIN SELECT raise(ABORT, 'no'); END"
        )
    connection.close()
    with pytest.raises(Exception, match="no"):
        course.remove("Ben")
    assert counted(course) == before


def test_a_name_is_changed_everywhere(course):
    assert course.rename("Ben", "Benjamin").attempts == 2
    assert {row.trainee for row in course.attempts()} == {"Ada", "Benjamin"}
    assert {sheet.trainee for sheet in course.answers()} == {"Ada", "Benjamin"}
    with pytest.raises(InputError, match="cannot be joined"):
        course.rename("Ada", "Benjamin")
