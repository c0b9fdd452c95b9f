"""Whatever a case file holds, the loader accepts something possible or refuses it in one clear line."""

from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import example, given, settings

from study.cases.broken_cases import BROKEN, VALID, document, outcome


@settings(max_examples=300, derandomize=True, deadline=None, database=None)
@given(BROKEN)
@example(b"a = " + b"[" * 5000)
@example(b"a = 0x" + b"f" * 6000)
@example(b"a = " + b"9" * 6000)
def test_loader_accepts_or_refuses(content):
    with TemporaryDirectory() as folder:
        assert outcome(content, Path(folder)) in {"accepted", "refused"}


@pytest.mark.parametrize("content", VALID, ids=lambda content: content["title"])
def test_generator_starts_from_what_the_loader_accepts(content, tmp_path):
    assert outcome(document(content).encode(), tmp_path) == "accepted"
