"""The table for spreadsheets, and files that are whole or not there."""

import csv
from io import StringIO

import pytest

from score_cards import attempt
from trocar import whole_file
from trocar.errors import InputError
from trocar.records.export import write_export
from trocar.records.tidy import ABOUT, table


def read(text):
    return list(csv.DictReader(StringIO(text, newline="")))


def test_one_row_for_each_attempt_with_units_in_the_columns(records):
    attempt(records, 'Zoë, "Z"')
    number = records.begin(records.trainee("Ben"), task="lift", level=2, device="web", header={}, dt=1e-3)
    records.interrupt(number, "the page\nwas closed")
    one, other = read(table(records.attempts(), records.metrics()))
    assert list(one)[: len(ABOUT)] == list(ABOUT)
    assert (one["trainee"], one["status"], one["passed"], one["score"]) == (
        'Zoë, "Z"',
        "finished",
        "yes",
        "80.0",
    )
    assert (one["path_length_m"], one["impulse_n_s"], one["integrated_jerk"]) == ("0.5", "6.5", "2.5")
    assert "bimanual_dexterity" not in one
    assert (other["status"], other["reason"]) == ("interrupted", "the page\nwas closed")
    assert other["score"] == other["passed"] == other["path_length_m"] == ""


def test_nothing_is_a_table_without_rows():
    assert table([], {}) == ",".join(ABOUT) + "\r\n"


def test_a_pseudonym_tells_no_name(records):
    attempt(records)
    (row,) = read(table(records.attempts(), records.metrics(), pseudonymous=True))
    assert row["trainee"] == "trainee 1"


def test_an_export_replaces_its_kind_alone(tmp_path):
    out = tmp_path / "far" / "attempts.csv"
    write_export(out, "id,one\n", "id,")
    write_export(out, "id,two\n", "id,")
    assert out.read_text() == "id,two\n"
    with pytest.raises(InputError, match="another file"):
        write_export(out, "[]", "[")
    with pytest.raises(InputError, match="a folder"):
        write_export(tmp_path, "[]", "[")
    assert out.read_text() == "id,two\n"


def test_an_export_that_fails_leaves_the_older_one(tmp_path, monkeypatch):
    out = tmp_path / "attempts.csv"
    write_export(out, "id,one\n", "id,")

    def full(_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(whole_file.os, "fsync", full)
    with pytest.raises(OSError, match="No space left"):
        write_export(out, "id,two\n", "id,")
    assert [file.name for file in tmp_path.iterdir()] == ["attempts.csv"]
    assert out.read_text() == "id,one\n"
