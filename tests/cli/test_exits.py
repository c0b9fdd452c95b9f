"""Every way a command can end: its exit code, its one line, and never a traceback for a user's mistake."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

import trocar
from trocar.cli import main

# A command file as anyone would write it: register(app), and errors raised, not caught.
COMMAND = '''
from typing import Annotated

import typer

from trocar.errors import InputError, SolverError, TrocarError


def register(app: typer.Typer) -> None:
    app.command()(press)


def press(how: str, force_n: Annotated[float, typer.Option("--force-n")] = 1.0) -> None:
    """Press a tissue, or fail to."""
    if how == "well":
        typer.echo('{"force_n": %g}' % force_n)
        return
    raise {
        "input": InputError("case.toml: poisson_ratio", "a number below 0.5", 0.5, "use\\n0.499"),
        "solver": SolverError("the factorisation failed"),
        "root": TrocarError("it could not be done"),
        "file": PermissionError(13, "Permission denied", "study/report.html"),
        "memory": MemoryError(),
        "pipe": BrokenPipeError(32, "Broken pipe"),
        "interrupt": KeyboardInterrupt(),
        "bug": ZeroDivisionError("ours"),
    }[how]
'''


@pytest.fixture
def press_command(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Put one more command file into the package, for the length of a test."""
    (tmp_path / "press_for_test.py").write_text(COMMAND)
    monkeypatch.setattr("trocar.cli.__path__", [*sys.modules["trocar.cli"].__path__, str(tmp_path)])
    yield
    sys.modules.pop("trocar.cli.press_for_test", None)


@pytest.mark.usefixtures("press_command")
@pytest.mark.parametrize(
    ("how", "code", "line"),
    [
        (
            "input",
            2,
            "trocar: case.toml: poisson_ratio: expected a number below 0.5, got 0.5; use 0.499",
        ),
        ("solver", 1, "trocar: the factorisation failed"),
        ("root", 1, "trocar: it could not be done"),
        ("file", 1, "trocar: study/report.html: Permission denied"),
        ("memory", 1, "trocar: not enough memory"),
        ("interrupt", 130, "trocar: interrupted"),
    ],
)
def test_an_error_is_one_line_and_a_code(
    how: str, code: int, line: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["press", how]) == code
    out, err = capsys.readouterr()
    assert out == ""
    assert err == f"{line}\n"


@pytest.mark.usefixtures("press_command")
def test_a_command_that_does_its_work_ends_with_0(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["press", "well", "--force-n", "0.25"]) == 0
    out, err = capsys.readouterr()
    assert json.loads(out) == {"force_n": 0.25}
    assert err == ""


@pytest.mark.usefixtures("press_command")
def test_a_mistake_of_ours_keeps_its_traceback() -> None:
    with pytest.raises(ZeroDivisionError):
        main(["press", "bug"])


@pytest.mark.usefixtures("press_command")
@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--nope"], "--nope"),
        (["nope"], "nope"),
        (["press"], "trocar press --help"),
        (["press", "well", "--force-n", "strong"], "strong"),
        (["press", "well", "--depth-mm", "3"], "--depth-mm"),
    ],
)
def test_wrong_usage_ends_with_2_and_one_line_that_names_it(
    arguments: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(arguments) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("trocar: ")
    assert err.count("\n") == 1
    assert said in err


@pytest.mark.usefixtures("press_command")
def test_a_command_file_is_found_without_being_listed(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--help"]) == 0
    assert "Press a tissue, or fail to." in capsys.readouterr().out


def test_no_arguments_show_the_help(capsys: pytest.CaptureFixture[str]) -> None:
    assert main([]) == 2
    out, err = capsys.readouterr()
    assert "Usage: trocar" in out + err


def test_version(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--version"]) == 0
    assert capsys.readouterr().out == f"trocar {trocar.__version__}\n"
