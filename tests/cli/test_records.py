"""`trocar records`."""

import csv
import json

import numpy as np
import pytest

from score_cards import attempt
from trocar.cli import main
from trocar.records.questionnaire import ITEMS
from trocar.records.scripted import attempt_on_record
from trocar.records.store import Records
from trocar.simulation import POSE
from trocar.training.session import scene_of
from trocar.training.strip import Piece, header, recorded, write_piece
from trocar.training.tape import read_attempt
from trocar.training.tasks.catalogue import task


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


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("history", "Ana", "palpate"), "did you mean Anna?"),
        (("history", "Anna", "palpat"), "did you mean palpate?"),
        (("history", "Anna", "trace", "--level", "9"), "task: level: expected 1 to 3"),
        (("export", "--csv", "kept.csv", "--trainee", "Ana"), "did you mean Anna?"),
    ],
)
def test_a_name_mistyped_is_said_and_writes_nothing(kept, capsys, tmp_path, monkeypatch, arguments, said):
    monkeypatch.chdir(tmp_path)
    assert main(["records", "export", "--csv", "kept.csv"]) == 0
    before = (tmp_path / "kept.csv").read_text()
    capsys.readouterr()
    assert main(["records", *arguments]) == 2
    assert said in capsys.readouterr().err
    assert (tmp_path / "kept.csv").read_text() == before


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
        (["export"], "expected one of --csv, --xapi and --recording"),
        (["export", "--csv", "a", "--xapi", "b"], "expected one of --csv, --xapi and --recording"),
        (["export", "--recording", "a"], "--recording and --attempt go together"),
        (["export", "--csv", "a", "--attempt", "1"], "--recording and --attempt go together"),
        (["export", "--recording", "a", "--attempt", "1", "--pseudonymous"], "names nobody"),
        (["export", "--recording", "a", "--attempt", "1"], "header: dt_s: expected a number"),
        (["rename", "Ana", "Eve"], "did you mean Anna?"),
        (["rename", "Ben [red]", "Anna"], "a name that nobody has"),
        (["rename", "Ben [red]", " "], "1 to 80 characters"),
        (["rename", "Anna", "Eve"], "expected no attempt under way, got 'attempt 3'"),
        (["remove", "Ana", "--yes"], "did you mean Anna?"),
        (["remove", "Anna", "--yes"], "expected no attempt under way, got 'attempt 3'"),
        (["remove", "Ben [red]"], "expected --yes where nobody can be asked"),
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


def test_an_attempt_goes_into_a_file_and_comes_out_of_it_bit_by_bit(folder, capsys, tmp_path):
    with Records.open(folder) as records:
        card = attempt_on_record(records, "palpate", seed=2).card
        begun = records.begin(
            records.trainee("Ada"), task="palpate", level=1, device="web", header=header(1e-3, None), dt=1e-3
        )
        began = np.array([True, False, False, True])
        poses = np.zeros((4, 2, POSE))
        records.add(begun, write_piece(Piece(targets=poses, began=began, skipped=np.zeros(4, int))), 4)
        kept = recorded(*records.chunks(1))
    out = tmp_path / "attempt.csv"
    assert main(["records", "export", "--attempt", "1", "--recording", str(out)]) == 0
    assert capsys.readouterr().out == f"{out}: attempt 1, {card.duration:.1f} s, palpate, level 1\n"
    from_file = read_attempt(out)
    assert from_file.poses.tobytes() == kept.poses.tobytes()
    scene = scene_of(task("palpate"))
    assert from_file.played(scene).tobytes() == kept.played(scene).tobytes()
    cards = []
    for which in (["--attempt", "1"], [str(out), "--task", "palpate"]):
        assert main(["replay", *which, "--json"]) == 0
        cards.append(json.loads(capsys.readouterr().out))
    assert cards[0] == cards[1] == json.loads(json.dumps(card.as_dict()))
    assert main(["records", "export", "--attempt", "2", "--recording", str(tmp_path / "other.csv")]) == 2
    assert "'rest once more at 0.003 s'" in capsys.readouterr().err


def test_a_trainee_gets_another_name(kept, capsys):
    assert main(["records", "rename", "Ben [red]", " Eve "]) == 0
    assert capsys.readouterr().out == "Eve: 1 attempt\n"
    assert [row.trainee for row in kept.attempts()] == ["Anna", "Eve", "Anna", "Anna"]


def test_a_trainee_is_removed_after_a_question(kept, capsys, monkeypatch):
    monkeypatch.setattr("sys.stdin.isatty", lambda: True, raising=False)
    asked = []
    monkeypatch.setattr("typer.confirm", lambda words: asked.append(words) or len(asked) > 1)
    assert main(["records", "remove", "Ben [red]"]) == 0
    assert capsys.readouterr().out == "Nothing was removed.\n"
    assert len(kept.attempts()) == 4
    (kept.path.parent / "records.db.schema-0001").touch()
    assert main(["records", "remove", "Ben [red]"]) == 0
    said = capsys.readouterr().out
    assert said.startswith("Ben [red] was removed with 1 attempt.\n")
    assert "records.db.schema-0001 is from before" in said
    assert asked[0] == "Remove Ben [red] with 1 attempt, recordings and answers? It cannot be undone."
    assert [row.id for row in kept.attempts()] == [1, 3, 4]


def test_trouble_is_one_line(folder, capsys):
    folder.mkdir()
    (folder / "records.db").write_text("Dear diary, " * 100)
    assert main(["records", "--json"]) == 1
    said = capsys.readouterr()
    assert said.err.startswith(f"trocar: {folder / 'records.db'}: expected a database of records")
    assert said.err.count("\n") == 1
    assert said.out == ""
