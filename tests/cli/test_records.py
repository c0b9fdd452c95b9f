"""`trocar records`."""

import csv
import json

import pytest

from score_cards import attempt
from trocar.cli import main
from trocar.records.questionnaire import ITEMS
from trocar.records.store import Records


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv("TROCAR_DATA", str(tmp_path / "records"))
    monkeypatch.setenv("COLUMNS", "160")
    return tmp_path / "records"


@pytest.fixture
def kept(folder):
    with Records.open(folder) as records:
        attempt(records)
        attempt(records, "Ben [red]", task="lift", passed=False, score=40.0)
        running = records.begin(
            records.trainee("Anna"), task="palpate", level=1, device="web", header={}, dt=1e-3
        )
        records.add(running, b"x", 1500)
        closed = records.begin(
            records.trainee("Anna"), task="palpate", level=1, device="web", header={}, dt=1e-3
        )
        records.interrupt(closed, "the page was closed")
        yield records


def listed(capsys, *options):
    assert main(["records", *options, "--json"]) == 0
    said = capsys.readouterr()
    assert said.err == ""
    return json.loads(said.out)


def test_attempts_are_listed_while_one_runs(kept, capsys):
    rows = listed(capsys)
    assert [(row["id"], row["status"]) for row in rows] == [
        (1, "finished"),
        (2, "finished"),
        (3, "running"),
        (4, "interrupted"),
    ]
    assert rows[0] == rows[0] | {
        "task": "palpate",
        "level": 1,
        "trainee": "Anna",
        "duration_s": 25.5,
        "score": 80.0,
        "passed": True,
        "device": "web",
    }
    assert (rows[2]["duration_s"], rows[2]["score"], rows[2]["passed"]) == (1.5, None, None)
    assert all(row["began"].endswith("Z") for row in rows)
    assert [row["id"] for row in listed(capsys, "--trainee", " Anna")] == [1, 3, 4]
    assert [row["id"] for row in listed(capsys, "--task", "lift")] == [2]
    assert listed(capsys, "--trainee", "Nobody") == []


def test_the_list_for_people(kept, capsys):
    assert main(["records"]) == 0
    out = capsys.readouterr().out
    for words in ("Ben [red]", "not passed", "running", "interrupted", "25.5 s", "80.0"):
        assert words in out
    assert main(["records", "--task", "palp"]) == 0
    out = capsys.readouterr().out
    assert "No attempts of task palp." in out
    assert "trainees Anna, Ben [red] and tasks palpate, lift" in out


def test_where_there_is_nothing_it_says_what_to_do(folder, capsys):
    assert listed(capsys) == []
    assert main(["records"]) == 0
    assert capsys.readouterr().out == f"No attempts yet in {folder}.\nStart one: trocar train\n"
    assert main(["records", "opinions"]) == 0
    assert capsys.readouterr().out.startswith("Nobody has answered yet.")
    assert not folder.exists()


def test_an_attempt_is_shown_with_its_card(kept, capsys):
    assert main(["records", "show", "1"]) == 0
    out = capsys.readouterr().out
    for words in ("palpate, level 1, Anna", "80.0 of 100, passed", "at 3.2 s, step 2: used too much force"):
        assert words in out
    assert "not yet validated on people" in out
    assert main(["records", "show", "4"]) == 0
    assert "interrupted: the page was closed; there is no score card" in capsys.readouterr().out
    assert main(["records", "show", "1", "--json"]) == 0
    shown = json.loads(capsys.readouterr().out)
    assert (shown["id"], shown["card"]["metrics"]["path_length"]) == (1, {"value": 0.5, "unit": "m"})
    assert shown["card"]["mistakes"][0]["words"] == "used too much force"


def test_a_learning_curve(kept, capsys):
    assert main(["records", "history", "Anna", "palpate"]) == 0
    out = capsys.readouterr().out
    assert "Anna: palpate, level 1" in out
    assert "-0.092" in out
    assert "What remains: one more pass in a row." in out
    assert main(["records", "history", "Anna", "palpate", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["remains"] == "one more pass in a row"
    assert main(["records", "history", "Anna", "lift", "--level", "2"]) == 0
    assert "no attempt was finished; what remains: two passes in a row." in capsys.readouterr().out


def test_attempts_are_exported(kept, capsys, tmp_path):
    out = tmp_path / "attempts.csv"
    assert main(["records", "export", "--csv", str(out)]) == 0
    assert capsys.readouterr().out == f"{out}: 4 attempts\n"
    with out.open(newline="") as stream:
        assert [row["id"] for row in csv.DictReader(stream)] == ["1", "2", "3", "4"]
    told = tmp_path / "attempts.json"
    options = [
        "--xapi",
        str(told),
        "--trainee",
        "Anna",
        "--pseudonymous",
        "--home-page",
        "https://one.example/",
    ]
    for _ in range(2):
        assert main(["records", "export", *options]) == 0
        assert capsys.readouterr().out == f"{told}: 2 statements\n"
    made = json.loads(told.read_text())
    assert {one["actor"]["account"]["homePage"] for one in made} == {"https://one.example/"}
    assert {one["actor"]["account"]["name"] for one in made} == {"trainee 1"}
    assert main(["records", "export", "--xapi", "-"]) == 0
    assert len(json.loads(capsys.readouterr().out)) == 3
    assert main(["records", "export", "--csv", str(told)]) == 2
    assert "another file" in capsys.readouterr().err


def test_opinions(kept, capsys):
    for group, value in (("novice", 2), ("expert", 4)):
        for number in range(5):
            kept.answer(
                kept.trainee(f"{group} {number}"), None, group, dict.fromkeys(ITEMS, value + number % 2)
            )
    assert main(["records", "opinions", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["items"] == dict(ITEMS)
    assert found["answers"][0] == found["answers"][0] | {"group": "novice", "n": 5, "median": 2.0}
    assert found["differences"][0]["u"] == 0
    assert found["cronbach_alpha"]["alpha"] == pytest.approx(1)
    assert main(["records", "opinions", "--group-b", "resident"]) == 0
    out = capsys.readouterr().out
    assert "I would use this trainer" in out
    assert "too few answers: 0, 4 are needed" in out
    assert "Cronbach's alpha: 1.00 (10 complete answers)" in out


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["show", "9"], "attempt: expected the number of an attempt, at most 4, got 9"),
        (["show", "x"], "x"),
        (["history", "Ana", "palpate"], "did you mean Anna?"),
        (["export"], "expected one of --csv and --xapi"),
        (["export", "--csv", "a", "--xapi", "b"], "expected one of --csv and --xapi"),
        (["export", "--csv", "a", "--home-page", "b"], "--home-page is for --xapi"),
        (["opinions", "--group-a", "expert"], "two that differ"),
        (["opinions", "--group-a", "beginner"], "novice or resident or expert"),
        (["--json", "show", "1"], "--json stands behind show"),
        (["--trainee", "Anna", "export", "--csv", "a"], "--trainee stands behind export"),
    ],
)
def test_what_cannot_be_asked_is_refused(kept, capsys, options, words):
    assert main(["records", *options]) == 2
    said = capsys.readouterr()
    assert words in " ".join(said.err.split())
    assert said.out == ""


def test_trouble_is_one_line(folder, capsys):
    folder.mkdir()
    (folder / "records.db").write_text("Dear diary, " * 100)
    assert main(["records", "--json"]) == 1
    said = capsys.readouterr()
    assert said.err.startswith(f"trocar: {folder / 'records.db'}: expected a database of records")
    assert said.err.count("\n") == 1
    assert said.out == ""
