"""The build hook builds the browser client when it has to, and only then."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import pytest

SPEC = importlib.util.spec_from_file_location("hatch_build", Path(__file__).parents[1] / "hatch_build.py")
HOOK = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(HOOK)


@pytest.fixture
def root(tmp_path):
    (tmp_path / "client" / "src").mkdir(parents=True)
    (tmp_path / "client" / "src" / "main.ts").write_text("start();\n")
    return tmp_path


@pytest.fixture
def ran(root, monkeypatch):
    """Stand in for npm: note what is run and leave what a build leaves."""
    calls = []

    def npm(client, *arguments):
        calls.append(arguments)
        HOOK.static(root).mkdir(parents=True, exist_ok=True)
        (HOOK.static(root) / "index.html").write_text("built\n")

    monkeypatch.setattr(HOOK, "npm", npm)
    return calls


def test_a_missing_client_is_built_once(root, ran):
    assert not HOOK.is_current(root)
    HOOK.build(root)
    assert ran == [("ci", "--ignore-scripts"), ("run", "build")]
    assert HOOK.is_current(root)
    HOOK.build(root)
    assert len(ran) == 2


def test_a_changed_renamed_or_new_source_makes_it_stale(root, ran):
    main = root / "client" / "src" / "main.ts"
    for change in (
        lambda: main.write_text("stop();\n"),
        lambda: main.rename(main.with_name("start.ts")),
        lambda: (root / "client" / "index.html").write_text("<p>\n"),
    ):
        HOOK.build(root)
        assert HOOK.is_current(root)
        change()
        assert not HOOK.is_current(root)


def test_tests_and_installed_packages_are_no_source(root, ran):
    HOOK.build(root)
    for folder in ("tests", "node_modules"):
        (root / "client" / folder).mkdir()
        (root / "client" / folder / "new.ts").write_text("x\n")
    assert HOOK.is_current(root)


def test_a_distribution_without_the_source_takes_what_it_carries(root, ran):
    HOOK.build(root)
    (root / "client" / "src" / "main.ts").unlink()
    (root / "client" / "src").rmdir()
    (root / "client").rmdir()
    assert HOOK.is_current(root)


def test_what_npm_says_is_in_the_error(tmp_path):
    with pytest.raises(RuntimeError, match="npm run nothing failed"):
        HOOK.npm(tmp_path, "run", "nothing")
