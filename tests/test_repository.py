"""Rules of the repository that no other tool holds."""

from __future__ import annotations

import json
import re
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())
LOCKS = sorted((ROOT / "requirements").glob("*.txt"))
NAME = re.compile(r"^[A-Za-z0-9._-]+")


def pinned(lock: Path) -> set[str]:
    """Return the names a lock file pins."""
    return {line.split("==")[0] for line in lock.read_text().splitlines() if "==" in line}


def names(requirements: list[str]) -> set[str]:
    """Return the names of requirements as the index spells them."""
    found = (NAME.match(requirement) for requirement in requirements)
    return {match.group().lower().replace("_", "-") for match in found if match}


def test_locks_pin_all_that_is_asked_for() -> None:
    runtime = names(PROJECT["project"]["dependencies"])
    dev = names(PROJECT["dependency-groups"]["dev"])
    assert runtime <= pinned(ROOT / "requirements/runtime.txt")
    assert runtime | dev <= pinned(ROOT / "requirements/dev.txt")


def test_both_locks_pin_the_same_versions() -> None:
    lines = [{line for line in lock.read_text().splitlines() if "==" in line} for lock in LOCKS]
    assert lines[1] <= lines[0]  # runtime.txt within dev.txt


@pytest.mark.parametrize("lock", LOCKS, ids=lambda lock: lock.name)
def test_a_lock_names_no_index_and_hashes_every_package(lock: Path) -> None:
    text = lock.read_text()
    assert "://" not in text
    assert not re.search(r"^\s*--(?!hash)", text, flags=re.MULTILINE)
    for block in re.split(r"\n(?=[a-z])", text):
        assert "--hash=sha256:" in block, block.splitlines()[0]


def test_the_clients_lock_names_no_address_and_hashes_every_package() -> None:
    packages = json.loads((ROOT / "client/package-lock.json").read_text())["packages"]
    locked = {name: package for name, package in packages.items() if name}
    assert len(locked) > 20
    assert [name for name, package in locked.items() if "resolved" in package] == []
    assert [name for name, package in locked.items() if "integrity" not in package] == []


def test_the_lock_keeps_to_numpy_that_runs_on_the_oldest_python() -> None:
    # NumPy 2.5 needs Python 3.12; the range begins at 3.11.
    assert PROJECT["project"]["requires-python"].startswith(">=3.11")
    assert re.search(r"^numpy==2\.4\.", (ROOT / "requirements/runtime.txt").read_text(), flags=re.MULTILINE)


def test_a_source_file_is_at_most_400_lines() -> None:
    lengths = {path: len(path.read_text().splitlines()) for path in (ROOT / "src").rglob("*.py")}
    assert {path: length for path, length in lengths.items() if length > 400} == {}


def test_a_change_is_one_sentence_of_a_known_kind() -> None:
    for fragment in (ROOT / "changelog.d").iterdir():
        assert re.fullmatch(r"[a-z0-9-]+\.(added|changed|fixed|removed)\.md", fragment.name), fragment.name
        assert re.fullmatch(r"\S[^\n]*\.\n", fragment.read_text()), fragment.name
