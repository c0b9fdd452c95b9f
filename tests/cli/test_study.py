"""trocar study: parse, conduct, render; every mistake is refused before anything is computed."""

import json
from math import radians

import pytest
import typer
from typer.testing import CliRunner

from measured_sets import rough_platens, write_small_sets
from small_study import shared_folder, shared_small_study
from trocar.cli import main
from trocar.cli import study as command
from trocar.errors import InputError
from trocar.study import conduct as conducting
from trocar.study.measured import pressed
from trocar.study.plan import Plan
from trocar.study.writing.folder import is_study


@pytest.fixture
def app():
    made = typer.Typer()
    made.callback()(lambda: None)
    command.register(made)
    return made


@pytest.fixture
def asked(monkeypatch, tmp_path_factory):
    """Take the shared study for whatever is asked, and keep the plans."""
    plans = []
    made = shared_small_study(shared_folder(tmp_path_factory.getbasetemp()))

    def run(plan, watch):
        plans.append(plan)
        watch("press in the middle", 0.5)
        return made

    monkeypatch.setattr(conducting, "run_study", run)
    return plans


def invoke(app, *arguments):
    result = CliRunner().invoke(app, ["study", *map(str, arguments)], env={"COLUMNS": "100", "NO_COLOR": "1"})
    if result.exception is not None:
        raise result.exception
    return result


def test_a_study_prints_a_table_and_where_its_report_is(app, asked, tmp_path):
    out = tmp_path / "study"
    result = invoke(app, "--out", out)
    assert asked == [Plan()]
    assert is_study(out)
    assert result.stdout.splitlines()[-1] == str(out / "report.html")
    for words in ("epidermis", "finite elements, mm", "processor time", "compiling", "drawing and writing"):
        assert words in result.stdout


def test_data_add_the_third_leg(app, asked, tmp_path, monkeypatch):
    monkeypatch.setattr(pressed, "platens", rough_platens)
    written = []

    def write(_study, out, *, measured, **_origin):
        written.append(measured)
        return out / "report.html"

    monkeypatch.setattr(conducting, "write_study", write)
    data = write_small_sets(tmp_path / "sets")
    result = invoke(app, "--out", tmp_path / "study", "--data", data)
    assert len(asked) == 1
    assert [leg.phantoms is not None for leg in written] == [True]
    assert "measured tissue" in result.stdout
    assert "Silicones in tension are left out" in result.stdout
    said = json.loads(invoke(app, "--out", tmp_path / "study", "--data", data, "--json").stdout)
    assert said["measured"]["limbs"]["people"] == {"fitted": 10, "judged": 10}


def test_broken_data_are_refused_before_anything_is_computed(app, asked, tmp_path):
    data = write_small_sets(tmp_path / "sets")
    table = next(data.glob("beef*/*.csv"))
    table.write_text(table.read_text().replace("force_N", "force"))
    with pytest.raises(InputError, match="line 1: expected a column named 'force_N'"):
        invoke(app, "--out", tmp_path / "study", "--data", data)
    assert asked == []
    assert not (tmp_path / "study").exists()


@pytest.fixture
def unwritten(monkeypatch):
    """Write nothing."""
    monkeypatch.setattr(conducting, "write_study", lambda _study, out, **_origin: out / "report.html")


@pytest.mark.usefixtures("unwritten")
def test_flags_reach_the_plan(app, asked, tmp_path):
    invoke(
        app, "--out", tmp_path / "study", "--tissue", "liver", "--support", "edges+base", "--diameter-mm", 8,
        "--peak-n", 2, "--small-n", 0.02, "--quick",
    )  # fmt: skip
    (plan,) = asked
    assert plan == Plan(
        tissue="liver",
        support="edges+base",
        diameter=0.008,
        peak=2.0,
        small=0.02,
        quick=True,
        tilt=radians(30),
    )


@pytest.mark.usefixtures("unwritten")
def test_json_alone_on_stdout(app, asked, tmp_path):
    said = json.loads(invoke(app, "--out", tmp_path / "study", "--json").stdout)
    assert asked
    assert said["report"].endswith("report.html")
    assert set(said["max_deflection_mm"]) == {"epidermis", "dermis", "fat"}
    assert {"compile_s", "study_s", "writing_s", "nrmse", "largest_difference", "cpu_s"} <= set(said)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--diameter-mm", "50"], "diameter of the tool: expected from 0.06 to 42 mm"),
        (["--diameter-mm", "-1"], "finite number above 0, got -1.0"),
        (["--small-n", "nan"], "finite number above 0, got nan"),
        (["--small-n", "9"], "at most the peak"),
        (["--tissue", "skn"], "did you mean skin?"),
        (["--tissue", "skin-paper-2014"], "take 'skin' instead"),
        (["--support", "air"], "edges or edges+base or base, got 'air'"),
        (["--preset", "paper-2014", "--quick"], "leave out quick"),
        (["--preset", "paper-2014", "--data", "sets"], "leave out data"),
        (["--preset", "paper-2015"], "'paper-2015' is not"),
    ],
)
def test_a_mistake_is_one_line_and_leaves_no_folder(arguments, words, tmp_path, capsys, monkeypatch):
    def compute(*_arguments):
        raise AssertionError("computed before all was checked")

    monkeypatch.setattr(conducting, "run_study", compute)
    code = main(["study", "--out", str(tmp_path / "study"), *arguments])
    caught = capsys.readouterr()
    assert code == 2
    assert caught.out == ""
    assert len(caught.err.splitlines()) == 1
    assert words in caught.err
    assert list(tmp_path.iterdir()) == []


def test_a_folder_with_other_files_is_refused(tmp_path, capsys):
    (tmp_path / "thesis.docx").write_text("mine")
    assert main(["study", "--out", str(tmp_path)]) == 2
    assert "a folder with other files" in capsys.readouterr().err
    assert [entry.name for entry in tmp_path.iterdir()] == ["thesis.docx"]


def test_the_papers_preset(app, tmp_path):
    out = tmp_path / "paper"
    text = invoke(app, "--out", out, "--preset", "paper-2014").stdout
    assert "0.686" in text
    assert "288 rad/s" in text
    assert is_study(out)
    said = json.loads(invoke(app, "--out", out, "--preset", "paper-2014", "--json").stdout)
    assert said["printed"]["lambda11"] == pytest.approx(0.686, abs=5e-4)  # three printed digits
    assert said["corrected"]["modes"] == 1600


def test_help_has_an_example(app):
    assert "Example: trocar study --out" in invoke(app, "--help").stdout
