"""`trocar bench` prints tables or JSON; the figures themselves are tested where they are measured."""

import json

import pytest
from typer.testing import CliRunner

from trocar.cli import application
from trocar.errors import InputError
from trocar.study.cost import equal_error, tick_cost

ARGUMENTS = ["bench", "step", "--tissue", "uterus", "--diameter-mm", "8", "--tolerance", "0.01"]


@pytest.fixture(autouse=True)
def _small(monkeypatch):
    monkeypatch.setattr(tick_cost, "_RELEASED_TICKS", 400)
    monkeypatch.setattr(tick_cost, "_SINGLE_TICKS", 100)
    monkeypatch.setattr(equal_error, "WAVE_LADDER", ((64, 16, 3),))
    monkeypatch.setattr(equal_error, "STATIC_LADDER", (64,))
    monkeypatch.setattr(equal_error, "FEA_LADDER", ((3.0, 0.5, 0.2, 0.5),))
    monkeypatch.setattr(equal_error, "_FEA_STEP_LENGTHS", (0.5e-3,))
    monkeypatch.setattr(equal_error, "_QUICK", (96, 16, 3, 1))


def run(*arguments):
    result = CliRunner().invoke(application(), list(arguments), env={"COLUMNS": "120", "NO_COLOR": "1"})
    if result.exception is not None:
        raise result.exception
    return result.stdout


def test_step_prints_a_tick_and_its_floor():
    text = run(*ARGUMENTS)
    assert "memory floor" in text
    assert "8 mm" in text


def test_step_as_json():
    content = json.loads(run(*ARGUMENTS, "--json"))
    assert content["ticks"][0]["diameter_mm"] == 8
    assert content["compile_s"] > 0


def test_cost_names_both_models():
    arguments = ("bench", "cost", "--tissue", "uterus", "--diameter-mm", "12", "--quick")
    text = run(*arguments)
    assert "waves" in text
    assert "fea" in text
    assert "superlu" in text or "pardiso" in text
    content = json.loads(run(*arguments, "--json"))
    assert content["dynamic"][0]["wave"]["model"] == "wave-solid"
    assert len(content["static"][0]["tried"]) == 2


def test_servo_counts_an_empty_loop_alone():
    arguments = ("bench", "servo", "--empty", "--seconds", "1", "--rounds", "1", "--tissue", "uterus")
    content = json.loads(run(*arguments, "--json"))
    assert [one["loop"] for one in content["rounds"]] == ["empty", "empty"]
    assert content["servo"] is None
    text = run(*arguments)
    assert "late, 99.9 %, us" in text
    assert "Real-time class" in text or "real-time class" in text


def test_servo_refuses_no_rounds():
    with pytest.raises(InputError, match="rounds: expected"):
        CliRunner().invoke(application(), ["bench", "servo", "--rounds", "0"], catch_exceptions=False)


@pytest.mark.parametrize("command", ["step", "cost", "servo", "models"])
def test_help_has_an_example(command):
    assert f"Example: trocar bench {command}" in run("bench", command, "--help")


def test_models_refuses_what_it_cannot_be_asked():
    for flag, value, words in (
        ("--case", "slow", "static, dynamic, large force"),
        ("--diameter-mm", "30", "a number from 5 to 12"),
        ("--figure", "models.txt", ".svg"),
    ):
        with pytest.raises(InputError, match=words):
            CliRunner().invoke(application(), ["bench", "models", flag, value], catch_exceptions=False)
