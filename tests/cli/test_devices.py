"""`trocar devices`: list, test, record."""

import json
from pathlib import Path

import pytest

from trocar.cli import main
from trocar.devices.catalogue import DEVICES
from trocar.devices.recording import read_recording

EXAMPLE = Path(__file__).parents[2] / "examples" / "press-slide-lift.csv"


@pytest.fixture
def run(capsys, monkeypatch):
    monkeypatch.setenv("NO_COLOR", "1")
    monkeypatch.setenv("COLUMNS", "80")

    def _run(*arguments):
        code = main(["devices", *map(str, arguments)])
        out, err = capsys.readouterr()
        return code, out, err

    return _run


def test_the_list_says_what_each_is_and_whether_it_is_there(run):
    code, out, err = run()
    assert (code, err) == (0, "")
    for entry in DEVICES.values():
        (line,) = [line for line in out.splitlines() if line.startswith(entry.name)]
        assert line.split()[-1] == "yes"
    assert max(map(len, out.splitlines())) <= 80


def test_the_list_as_json(run):
    code, out, _ = run("--json")
    assert code == 0
    assert json.loads(out) == [entry.as_dict() for entry in DEVICES.values()]


def test_a_device_that_keeps_its_word_passes(run):
    code, out, err = run("test", "simulated", "--script", "lift", "--seed", 3, "--seconds", 4)
    assert (code, err) == (0, "")
    assert "fastest tip, mm/s" in out
    code, out, _ = run("test", "recorded", "--recording", EXAMPLE, "--seconds", 2, "--json")
    found = json.loads(out)
    assert (code, found["passed"], found["seconds"]) == (0, True, 2.0)
    assert [each["instrument"] for each in found["instruments"]] == ["left", "right"]
    assert found["instruments"][0]["fastest_tip_m_s"] < 0.1


def test_more_tremor_is_a_faster_tip(run):
    speeds = []
    for tremor in (0, 1):
        _, out, _ = run("test", "simulated", "--seconds", 1, "--tremor-mm", tremor, "--noise-mm", 0, "--json")
        speeds.append(json.loads(out)["instruments"][1]["fastest_tip_m_s"])
    assert speeds[1] > speeds[0] + 0.02  # 1 mm rms at 8 Hz and more, times the lever


def test_a_device_that_nobody_holds_passes_and_says_so(run):
    code, out, err = run("test", "web", "--seconds", 1)
    assert (code, err) == (0, "")
    assert "waits for a page" in out


def test_a_device_that_breaks_its_word_ends_with_1(run, tmp_path):
    jumping = tmp_path / "jump.csv"
    lines = EXAMPLE.read_text().splitlines()
    head, left = lines[:2], [line for line in lines[2:] if ",left," in line]
    jumping.write_text("\n".join([*head, left[0], left[400].replace("8.0,", "0.001,", 1)]) + "\n")
    code, out, err = run("test", "recorded", "--recording", jumping, "--seconds", 0.1)
    assert code == 1
    assert "left at 0.001 s: a tip faster than 1 m/s" in out
    assert err.startswith(
        "trocar: the recorded device gives poses that the trainer cannot use: left at 0.001 s"
    )
    assert err.count("\n") == 1
    code, out, _ = run("test", "recorded", "--recording", jumping, "--seconds", 0.1, "--json")
    assert (code, json.loads(out)["passed"]) == (1, False)


def test_a_recorded_script_can_be_played_back(run, tmp_path):
    out_file = tmp_path / "new" / "press.csv"
    code, out, err = run("record", "press", "--out", out_file, "--seed", 4, "--rate-hz", 10)
    assert (code, err) == (0, "")
    assert "of press" in out
    left, right = read_recording(out_file)
    assert len(left) == len(right) == 130
    assert run("test", "recorded", "--recording", out_file, "--seconds", 0.5)[0] == 0


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("test", "simulatd"), "did you mean simulated?"),
        (("test", "recorded"), "recorded device: expected the option --recording"),
        (("test", "recorded", "--recording", "no-such.csv"), "no-such.csv"),
        (("test", "web", "--script", "press"), "script: expected no such option"),
        (("test", "simulated", "--seed", "-1"), "--seed"),
        (("test", "simulated", "--tremor-mm", "-1"), "tremor"),
        (("test", "simulated", "--seconds", "0"), "seconds"),
        (("--json", "test", "web"), "--json stands behind test"),
        (("record", "dance", "--out", "dance.csv"), "script: expected one of press"),
        (("record", "press"), "--out"),
        (("record", "press", "--out", "press.csv", "--rate-hz", "0"), "rate"),
    ],
)
def test_a_mistake_ends_with_2_and_one_line(run, arguments, said, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code, out, err = run(*arguments)
    assert (code, out) == (2, "")
    assert err.count("\n") == 1
    assert said in err
    assert list(tmp_path.iterdir()) == []


def test_another_file_is_not_overwritten(run, tmp_path):
    (tmp_path / "thesis.csv").write_text("mine")
    code, _, err = run("record", "press", "--out", tmp_path / "thesis.csv")
    assert code == 2
    assert "choose another name" in err


@pytest.mark.parametrize("command", [(), ("test",), ("record",)])
def test_help_has_an_example(run, command):
    code, out, _ = run(*command, "--help")
    assert code == 0
    assert f"Example: {' '.join(['trocar devices', *command])}" in out
