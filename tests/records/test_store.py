"""What is kept comes back, and only what happened is kept."""

import sqlite3
from concurrent.futures import ThreadPoolExecutor
from math import inf, isfinite

import pytest

from score_cards import attempt, card
from trocar.errors import InputError
from trocar.records.rows import Status
from trocar.records.store import Records
from trocar.records.trouble import RecordsError
from trocar.training.metrics.measures import MEASURES
from trocar.training.players import Skill


def begin(records, name="Anna", task="palpate", level=1):
    return records.begin(
        records.trainee(name), task=task, level=level, device="web", header={"form": 1}, dt=1e-3
    )


def test_a_trainee_is_known_by_name(records):
    anna = records.trainee("  Anna ")
    assert (anna.name, anna.attempts) == ("Anna", 0)
    assert records.trainee("Anna").id == anna.id
    assert records.trainee("Zoë").id == records.trainee("Zoe\u0308").id
    begin(records)
    assert [(one.name, one.attempts) for one in records.trainees()] == [("Anna", 1), ("Zoë", 0)]


@pytest.mark.parametrize("name", ["", "  ", "x" * 81, "a\nb", "a\tb", "a\0b", "a\u200bb", "a\u202eb"])
def test_a_name_that_cannot_be_shown_is_refused(records, name):
    with pytest.raises(InputError, match="trainee: name"):
        records.trainee(name)
    assert records.trainees() == []


@pytest.mark.parametrize("skill", list(Skill))
def test_a_program_has_its_name_for_itself(records, skill):
    name = f"scripted {skill}"
    assert records.scripted_trainee(skill).name == name
    for taken in (name, f"  {name.title()} ", name.replace(" ", "  ")):
        with pytest.raises(InputError, match="programs that do tasks are called so"):
            records.trainee(taken)
    records.trainee("Ada")
    with pytest.raises(InputError, match="programs that do tasks are called so"):
        records.rename("Ada", name)
    assert records.trainee(f"not {name}").name == f"not {name}"


def test_an_attempt_from_beginning_to_end(records):
    number = begin(records)
    assert records.attempts()[0].status is Status.RUNNING
    records.add(number, b"one", 1000)
    records.add(number, b"two", 500)
    assert records.attempts()[0].duration == pytest.approx(1.5)
    records.finish(number, card())
    (row,) = records.attempts()
    assert (row.status, row.score, row.passed, row.completed) == (Status.FINISHED, 80.0, True, True)
    assert (row.duration, row.trainee, row.task, row.level, row.device) == (25.5, "Anna", "palpate", 1, "web")
    assert records.chunks(number) == ({"form": 1}, [b"one", b"two"])


def test_the_card_and_its_finite_metrics_are_kept(records):
    number = attempt(records)
    kept = records.attempt(number)
    assert kept.card == card().as_dict()
    assert kept.mistakes == [{"time_s": 3.25, "step": 2, "words": "used too much force"}]
    metrics = {one.name: (one.value, one.unit) for one in records.metrics()[number]}
    units = {measure.name: measure.unit for measure in MEASURES}
    assert metrics == {
        name: (value, units[name]) for name, value in card().metrics.items() if isfinite(value)
    }


def test_attempts_are_listed_oldest_first_and_by_what_is_asked(records):
    one, other = attempt(records), attempt(records, "Ben", task="lift")
    third = attempt(records, level=2)
    assert [row.id for row in records.attempts()] == [one, other, third]
    assert [row.id for row in records.attempts(trainee="Anna")] == [one, third]
    assert [row.id for row in records.attempts(task="lift")] == [other]
    assert [row.id for row in records.attempts("Anna", "palpate", 2)] == [third]
    assert records.attempts(trainee="Nobody") == []


def test_an_interrupted_attempt_keeps_what_there_is_and_why(records):
    number = begin(records)
    records.add(number, b"one", 2500)
    records.interrupt(number, "the page was closed")
    (row,) = records.attempts()
    assert (row.status, row.reason) == (Status.INTERRUPTED, "the page was closed")
    assert (row.duration, row.score, row.passed) == (pytest.approx(2.5), None, None)
    assert records.attempt(number).card is None
    assert records.attempt(number).mistakes == ()


def test_what_moved_the_instruments_may_turn_out_at_the_end(records):
    finished, interrupted = begin(records), begin(records)
    records.finish(finished, card(), device="headset")
    records.interrupt(interrupted, "the page was closed", device="headset")
    assert [row.device for row in records.attempts()] == ["headset", "headset"]


def test_an_attempt_that_is_closed_takes_nothing_more(records):
    number = attempt(records)
    for change in (
        lambda: records.add(number, b"more", 1),
        lambda: records.finish(number, card()),
        lambda: records.interrupt(number, "again"),
    ):
        with pytest.raises(InputError, match="expected one that runs, got 'finished'"):
            change()
    assert records.chunks(number)[1] == [b"recorded"]


def test_what_cannot_be_kept_is_refused(records):
    number = begin(records)
    with pytest.raises(InputError, match="at least one byte"):
        records.add(number, b"", 1)
    with pytest.raises(InputError, match="one tick"):
        records.add(number, b"x", 0)
    with pytest.raises(InputError, match="one of palpate, level 1"):
        records.finish(number, card(task="lift"))
    with pytest.raises(InputError, match=r"at most 1.*trocar records lists them"):
        records.attempt(7)
    anna = records.trainee("Anna")
    with pytest.raises(InputError, match="header"):
        records.begin(anna, task="lift", level=1, device="web", header={"x": inf}, dt=1e-3)
    with pytest.raises(InputError, match="dt"):
        records.begin(anna, task="lift", level=1, device="web", header={}, dt=0.0)
    assert [row.id for row in records.attempts()] == [number]


def test_what_is_opened_for_reading_is_not_written(tmp_path, records):
    with Records.open(tmp_path, writing=False) as reader, pytest.raises(RecordsError, match="for reading"):
        reader.trainee("Anna")


def test_many_threads_write_at_once(records):
    anna = records.trainee("Anna")

    def one(_):
        number = records.begin(anna, task="lift", level=1, device="web", header={}, dt=1e-3)
        for piece in range(5):
            records.add(number, bytes([piece]), 1)
            records.attempts()
        return number

    with ThreadPoolExecutor(6) as pool:
        numbers = list(pool.map(one, range(12)))
    assert sorted(numbers) == [row.id for row in records.attempts()]
    assert all(records.chunks(number)[1] == [bytes([piece]) for piece in range(5)] for number in numbers)


def test_answers_are_kept_together(records):
    anna, ben = records.trainee("Anna"), records.trainee("Ben")
    number = attempt(records)
    records.answer(anna, number, "resident", {"picture": 4, "would-use": 5})
    records.answer(ben, None, "expert", {"picture": 1})
    first, second = records.answers()
    assert (first.trainee, first.attempt, first.group) == ("Anna", number, "resident")
    assert first.values == {"picture": 4, "would-use": 5}
    assert (second.trainee, second.attempt, second.values) == ("Ben", None, {"picture": 1})
    with pytest.raises(InputError, match="one of Ben's"):
        records.answer(ben, number, "expert", {"picture": 1})


def test_a_list_reads_no_recording(records, tmp_path):
    for _ in range(3):
        attempt(records)
    records.close()
    with sqlite3.connect(tmp_path / "records.db") as connection:
        plan = " ".join(
            row[3]
            for row in connection.execute(
                "EXPLAIN QUERY PLAN SELECT a.id FROM attempt a JOIN trainee t ON t.id = a.trainee_id "
                "WHERE t.name = 'Anna' AND a.task = 'palpate' AND a.level = 1"
            )
        )
        connection.execute("DROP TABLE chunk")
    connection.close()
    assert "USING INDEX attempt_of_trainee" in plan or "USING COVERING INDEX attempt_of_trainee" in plan
    with Records.open(tmp_path, writing=False) as reader:
        assert len(reader.attempts()) == 3
        assert len(reader.history("Anna", "palpate").rows) == 3
