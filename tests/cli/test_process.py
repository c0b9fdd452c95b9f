"""The command line as a process of its own."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

import trocar
from trocar.cli import main


def run(*arguments: str) -> subprocess.CompletedProcess[str]:
    """Run `python -m trocar` and keep what it prints."""
    return subprocess.run(
        [sys.executable, "-m", "trocar", *arguments], capture_output=True, text=True, check=False
    )


def test_the_module_runs_as_the_program() -> None:
    done = run("--version")
    assert (done.returncode, done.stdout, done.stderr) == (0, f"trocar {trocar.__version__}\n", "")


def test_a_mistake_ends_the_process_with_2_and_no_traceback() -> None:
    done = run("no-such-command")
    assert done.returncode == 2
    assert done.stderr.startswith("trocar: ")
    assert "Traceback" not in done.stderr


def test_a_reader_that_leaves_is_no_error_message() -> None:
    with subprocess.Popen(
        [sys.executable, "-m", "trocar", "--help"], stdout=subprocess.PIPE, stderr=subprocess.PIPE
    ) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        process.stdout.close()
        assert process.stderr.read() == b""
        assert process.wait() == 1


@pytest.mark.parametrize(("given", "used"), [(None, "1"), ("3", "3")])
def test_linear_algebra_takes_one_thread_unless_told_otherwise(
    monkeypatch: pytest.MonkeyPatch, given: str | None, used: str
) -> None:
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "")  # so that it is put back afterwards
    if given is None:
        monkeypatch.delenv("OPENBLAS_NUM_THREADS")
    else:
        monkeypatch.setenv("OPENBLAS_NUM_THREADS", given)
    assert main(["--version"]) == 0
    assert os.environ["OPENBLAS_NUM_THREADS"] == used
