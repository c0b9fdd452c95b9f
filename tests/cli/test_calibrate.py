"""trocar calibrate, as a user calls it."""

import json
import re
import shlex
import tomllib
from pathlib import Path

import pytest

from trocar.cli import main
from trocar.tissues import catalogue

EXAMPLES = Path(__file__).parent.parent.parent / "examples"
DATA, CASE = str(EXAMPLES / "phantom.csv"), str(EXAMPLES / "phantom.toml")
CALL = ["calibrate", DATA, "--case", CASE, "--fit", "body.young_modulus"]


def test_json_is_alone_on_stdout_and_files_are_named(capsys, tmp_path):
    out, report = tmp_path / "pad.toml", tmp_path / "report"
    markers = str(EXAMPLES / "phantom-markers.csv")
    call = [
        *CALL,
        "--fit",
        "skin.young_modulus",
        "--markers",
        markers,
        "--out",
        str(out),
        "--report",
        str(report),
    ]
    assert main([*call, "--noise-n", "3e-4", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    for name, truth in (("body.young_modulus", 12.0), ("skin.young_modulus", 60.0)):
        assert found["parameters"][name]["low"] < truth < found["parameters"][name]["high"]
    assert found["held_out"]["holds"] is True
    assert found["tissue"] == str(out)
    assert catalogue.tissue(str(out)).layers[1].young_modulus == pytest.approx(
        1e3 * found["parameters"]["body.young_modulus"]["value"], rel=1e-5
    )
    page = (report / "report.html").read_text()
    assert found["report"] == str(report / "report.html")
    assert "<svg" in page
    assert not re.findall(r'(?:src|href)="(?!#|data:)', page)  # nothing outside it is asked for
    assert {entry.name for entry in report.iterdir()} == {
        "report.html",
        "fit.svg",
        "knowledge.svg",
        "markers.svg",
    }


def test_a_ramp_that_is_held_gives_modulus_weight_and_time(capsys):
    names = {"body.young_modulus": 12.0, "body.prony[0].g": 0.6, "body.prony[0].tau": 4.0}
    case = str(EXAMPLES / "phantom-hold.toml")
    fits = [word for name in names for word in ("--fit", name)]
    assert main(["calibrate", str(EXAMPLES / "phantom-hold.csv"), "--case", case, *fits, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)["parameters"]
    for name, truth in names.items():
        assert found[name]["low"] < truth < found[name]["high"]


def test_a_table_says_what_the_data_tell(capsys, tmp_path):
    again, page = str(EXAMPLES / "phantom-again.csv"), tmp_path / "page.html"
    assert main([*CALL, "--fit", "skin.young_modulus", "--check", again, "--report", str(page)]) == 0
    shown = " ".join(capsys.readouterr().out.split())
    assert "cannot tell body.young_modulus and skin.young_modulus apart" in shown
    assert "In phantom-again.csv, which the fit did not see" in shown
    assert page.read_text().startswith("<!DOCTYPE html>")


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (["calibrate", DATA, "--case", CASE], "--fit"),
        (["calibrate", DATA, "--fit", "body.young_modulus"], "--case"),
        ([*CALL, "--fit", "bodi.young_modulus"], "did you mean body.young_modulus"),
        ([*CALL, "--setting", "in vitro"], "in vivo or ex vivo or material test"),
        ([*CALL, "--check", DATA, "--hold-out", "0.1"], "one of them"),
        ([*CALL, "--out", "tissue.txt"], "ends with .toml"),
        ([*CALL, "--out", CASE], "another file"),
        ([*CALL, "--report", CASE], "another file"),
        (["calibrate", CASE, "--case", CASE, "--fit", "body.young_modulus"], "phantom.toml: line"),
        (["calibrate", "none.csv", "--case", CASE, "--fit", "body.young_modulus"], "none.csv"),
    ],
)
def test_a_mistake_is_one_line_and_exit_2(capsys, arguments, word):
    assert main(arguments) == 2
    told = capsys.readouterr().err
    assert word in told
    assert "Traceback" not in told
    assert told.count("\n") == 1


def test_the_examples_say_that_they_are_synthetic_and_their_cases_do_not_know_the_truth():
    for place in EXAMPLES.glob("phantom*.csv"):
        assert place.read_text().startswith("# SYNTHETIC"), place.name
    start = tomllib.loads((EXAMPLES / "phantom.toml").read_text())["layer"]
    assert [layer["young_modulus_kpa"] for layer in start] == [100, 10]


def commands(page):
    """Yield the console lines of a how-to."""
    text = (EXAMPLES.parent / "docs" / "how-to" / page).read_text(encoding="utf-8")
    return [shlex.split(line)[2:] for line in text.splitlines() if line.startswith("$ trocar ")]


@pytest.mark.parametrize("arguments", commands("calibrate-a-tissue.md"), ids=lambda one: " ".join(one[1:7]))
def test_the_commands_of_the_how_to_work(monkeypatch, tmp_path, capsys, arguments):
    (tmp_path / "examples").symlink_to(EXAMPLES)
    monkeypatch.chdir(tmp_path)
    assert main(arguments) == 0
    shown = " ".join(capsys.readouterr().out.split())
    page = (EXAMPLES.parent / "docs" / "how-to" / "calibrate-a-tissue.md").read_text(encoding="utf-8")
    if "skin.young_modulus" in arguments:  # the page quotes what both of these say
        told = [
            " ".join(block.split())
            for block in re.findall(r"```text\n(The data.*?)```", page, flags=re.DOTALL)
        ]
        assert any(one in shown for one in told), shown


def test_every_flag_is_in_the_reference(capsys):
    assert main(["calibrate", "--help"]) == 0
    flags = set(re.findall(r"--[a-z-]+", capsys.readouterr().out)) - {"--help"}
    reference = (EXAMPLES.parent / "docs" / "reference" / "command-line.md").read_text(encoding="utf-8")
    section = reference.split("## `trocar calibrate", 1)[1].split("\n## ", 1)[0]
    assert len(flags) > 10
    assert {flag for flag in flags if f"`{flag}" not in section} == set()
