"""Fixtures for what is kept."""

import os
import tempfile
from contextlib import contextmanager
from pathlib import Path
from shutil import rmtree

import pytest

from trocar.records.store import Records

NOBODY = 65534  # a user without rights, as every Linux has one


@pytest.fixture
def records(tmp_path):
    with Records.open(tmp_path) as opened:
        yield opened


@pytest.fixture
def reachable():
    """A folder whose parents everybody may enter, unlike those of tmp_path."""
    folder = Path(tempfile.mkdtemp(prefix="trocar-records-"))
    folder.chmod(0o755)
    yield folder
    folder.chmod(0o755)
    rmtree(folder)


@contextmanager
def _without_rights(folder):
    """Be somebody who may read a folder but not write into it: root is held back by no permission."""
    user = os.geteuid()
    folder.chmod(0o555)
    for file in folder.iterdir():
        file.chmod(0o444)
    try:
        if user == 0:
            os.seteuid(NOBODY)
        yield
    finally:
        if user == 0:
            os.seteuid(0)
        folder.chmod(0o755)
        for file in folder.iterdir():
            file.chmod(0o644)


@pytest.fixture
def without_rights():
    return _without_rights
