import json
from pathlib import Path

import pytest
import typer
from typer.testing import CliRunner

from trocar.cli.tissues import register
from trocar.errors import InputError
from trocar.tissues import catalogue
from trocar.tissues.page import page
from trocar.tissues.record import Status

PAGE = Path(__file__).parents[2] / "docs" / "reference" / "tissue-presets.md"


@pytest.fixture
def app() -> typer.Typer:
    made = typer.Typer()
    register(made)
    return made


def run(app: typer.Typer, *arguments: str, columns: int = 80) -> str:
    result = CliRunner().invoke(app, ["tissues", *arguments], env={"COLUMNS": str(columns), "NO_COLOR": "1"})
    if result.exception is not None:
        raise result.exception
    return result.stdout


@pytest.mark.parametrize("columns", [80, 120])
def test_list_names_every_preset_within_the_width(app: typer.Typer, columns: int) -> None:
    lines = run(app, "list", columns=columns).splitlines()
    assert max(map(len, lines)) <= columns
    first_words = {line.split()[0] for line in lines if line.strip()}
    assert set(catalogue.names()) <= first_words


def test_list_says_which_preset_models_cannot_use(app: typer.Typer) -> None:
    assert "FORMULA ONLY" in " ".join(run(app, "list", columns=160).split())


def test_list_as_json(app: typer.Typer) -> None:
    listed = {item["name"]: item for item in json.loads(run(app, "list", "--json"))}
    assert tuple(listed) == catalogue.names()
    assert listed["skin"]["layers"] == ["epidermis", "dermis", "fat"]
    assert listed["skin"]["thickness_mm"] == 13.6
    assert listed["skin-paper-2014"]["usable"] == "paper formula only"
    assert set(listed["skin"]["values"]) == {status.value for status in Status}


@pytest.mark.parametrize("columns", [80, 120])
@pytest.mark.parametrize("name", catalogue.names())
def test_show_prints_every_value_within_the_width(app: typer.Typer, name: str, columns: int) -> None:
    text = run(app, "show", name, columns=columns)
    assert max(map(len, text.splitlines())) <= columns
    for item in catalogue.record(name).stated:
        assert f"{item.value:g}" in text
        assert item.unit in text


def test_remembered_values_stand_out_without_colour(app: typer.Typer) -> None:
    text = " ".join(run(app, "show", "skin").split())
    assert (
        text.count("REMEMBERED") == catalogue.record("skin").count(Status.REMEMBERED) + 1
    )  # and the last line
    assert "REMEMBERED, verify before citing: loss factor of fat, tensile strength of fat." in text


def test_full_adds_reasons_and_rival_values(app: typer.Typer) -> None:
    brief, full = run(app, "show", "liver"), run(app, "show", "liver", "--full")
    assert "why this loss factor" not in brief
    assert "why this loss factor" in full
    assert "0.27 MPa, right lobe" in full


def test_show_as_json_holds_everything(app: typer.Typer) -> None:
    assert json.loads(run(app, "show", "skin", "--json")) == catalogue.record("skin").as_dict()
    everything = json.loads(run(app, "show", "--all", "--json"))
    assert [item["name"] for item in everything] == list(catalogue.names())


def test_the_paper_preset_can_be_shown(app: typer.Typer) -> None:
    text = run(app, "show", "skin-paper-2014")
    assert "PAPER FORMULA ONLY" in text
    assert "1.8e-08 g/mm2" in text


def test_a_tissue_file_can_be_shown(app: typer.Typer, tmp_path: Path) -> None:
    source = Path(catalogue.__file__).parent / "presets" / "uterus.toml"
    (tmp_path / "mine.toml").write_text(source.read_text(encoding="utf-8"), encoding="utf-8")
    assert run(app, "show", str(tmp_path / "mine.toml")).startswith("mine: Human uterine wall")


def test_an_unknown_preset_is_bad_input(app: typer.Typer) -> None:
    with pytest.raises(InputError, match="did you mean liver"):
        run(app, "show", "livr")


@pytest.mark.parametrize(
    "arguments", [("show",), ("show", "skin", "--all"), ("show", "skin", "--json", "--markdown")]
)
def test_wrong_usage_exits_with_2(app: typer.Typer, arguments: tuple[str, ...]) -> None:
    assert CliRunner().invoke(app, ["tissues", *arguments]).exit_code == 2


@pytest.mark.parametrize("command", ["list", "show"])
def test_help_has_an_example(app: typer.Typer, command: str) -> None:
    assert f"Example: trocar tissues {command}" in run(app, command, "--help")


def test_the_reference_page_is_what_the_command_prints(app: typer.Typer) -> None:
    printed = run(app, "show", "--all", "--markdown")
    assert printed == page(catalogue.record(name) for name in catalogue.names())
    assert PAGE.read_text(encoding="utf-8") == printed, "write it anew: trocar tissues show --all --markdown"


def test_the_tissue_file_in_the_docs_is_read(tmp_path: Path) -> None:
    text = (PAGE.parents[1] / "explanation" / "tissues.md").read_text(encoding="utf-8")
    example = text.split("```toml\n")[1].split("```")[0]
    path = tmp_path / "example.toml"
    path.write_text(example, encoding="utf-8")
    assert catalogue.read_tissue(path).tissue().layers[0].density == pytest.approx(
        1070, rel=1e-14
    )  # rounding
