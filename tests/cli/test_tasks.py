"""`trocar tasks`, and a scripted trainee on the command line."""

import json

import pytest

from trocar.cli import main
from trocar.training.tasks.catalogue import LEVELS, TASKS


def test_tasks_are_listed(capsys):
    assert main(["tasks", "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)
    assert [(row["name"], row["level"]) for row in rows] == [
        (name, level) for name in TASKS for level in LEVELS
    ]
    assert all(row["title"] and row["pass_source"] for row in rows)
    assert main(["tasks"]) == 0
    out = capsys.readouterr().out
    assert all(name in out for name in TASKS)


def test_a_scripted_trainee_prints_a_score_card(capsys):
    command = [
        "train",
        "--headless",
        "--device",
        "simulated",
        "--skill",
        "expert",
        "--task",
        "palpate",
        "--seed",
        "1",
    ]
    assert main([*command, "--json"]) == 0
    card = json.loads(capsys.readouterr().out)
    assert (card["task"], card["skill"], card["seed"], card["passed"]) == ("palpate", "expert", 1, True)
    assert card["duration_s"] >= 20
    assert card["metrics"]["time"] == {"value": card["duration_s"], "unit": "s"}
    assert card["advice"]
    assert main(command) == 0
    out = capsys.readouterr().out
    assert f"palpate, level 1: {card['score']:.1f} of 100, passed" in out
    assert "not yet validated on people" in out


def test_an_attempt_that_is_replayed_has_the_same_card(capsys, tmp_path):
    out = tmp_path / "attempt.csv"
    command = [
        "train",
        "--headless",
        "--device",
        "simulated",
        "--task",
        "trace",
        "--skill",
        "novice",
        "--json",
    ]
    assert main([*command, "--out", str(out)]) == 0
    card = json.loads(capsys.readouterr().out)
    assert main(["replay", str(out), "--task", "trace", "--json"]) == 0
    again = json.loads(capsys.readouterr().out)
    assert again == {key: value for key, value in card.items() if key not in {"skill", "seed"}}
    assert main(["replay", str(out), "--task", "palpate"]) == 0
    assert "Go on to the end" in " ".join(capsys.readouterr().out.split())


def test_what_cannot_be_replayed_is_refused(capsys, tmp_path):
    (tmp_path / "none.csv").write_text("hello\n")
    for file in ("none.csv", "missing.csv"):
        assert main(["replay", str(tmp_path / file), "--task", "lift"]) == 2
        assert file in capsys.readouterr().err


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--headless"], "--headless needs --task"),
        (["--headless", "--device", "recorded", "--task", "lift"], "--device simulated alone, not recorded"),
        (["--headless", "--device", "simulated"], "--headless needs --task"),
        (["--headless", "--device", "simulated", "--task", "palp"], "did you mean palpate"),
        (["--headless", "--device", "simulated", "--task", "lift", "--skill", "good"], "expert or novice"),
        (
            ["--headless", "--device", "simulated", "--task", "lift", "--tissue", "liver"],
            "--tissue does not go with",
        ),
        (["--headless", "--device", "simulated", "--task", "lift", "--level", "0"], "level"),
        (["--task", "lift"], "--task is for --headless"),
        (["--json"], "--json is for --headless"),
        (["--out", "attempt.csv"], "--out is for --headless"),
    ],
)
def test_what_does_not_go_together_is_refused(options, words, capsys):
    assert main(["train", "--no-browser", *options]) == 2
    said = capsys.readouterr()
    assert words in " ".join(said.err.split())
    assert said.out == ""
