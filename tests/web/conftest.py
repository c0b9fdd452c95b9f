"""One server for the tests that only knock at its doors, a fresh one for those that change it."""

import pytest

from trocar.web.conversation import StreamLimits
from web.scripted_source import ScriptedSource
from web.visitor import Visitor, served


@pytest.fixture(scope="package")
def page(tmp_path_factory):
    folder = tmp_path_factory.mktemp("client")
    (folder / "index.html").write_text("<!doctype html><title>Trocar</title>")
    (folder / "scene.js").write_text("export {};\n")
    (folder.parent / "secret.txt").write_text("secret")
    return folder


@pytest.fixture(scope="package")
def visitor(page):
    with served(ScriptedSource(), client=page) as made:
        yield Visitor(made)


@pytest.fixture
def source():
    return ScriptedSource()


@pytest.fixture
def impatient(source):
    """Visit a server of the test's own source that waits half a second where ours waits ten."""
    with served(source, limits=StreamLimits(idle=0.5, send=0.5)) as made:
        yield Visitor(made)


@pytest.fixture
def guest(source):
    """Visit a server of the test's own source."""
    with served(source) as made:
        yield Visitor(made)
