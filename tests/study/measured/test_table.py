"""A table is read as it is written, and what is broken in it is named by file and line."""

from __future__ import annotations

import numpy as np
import pytest

from trocar.errors import InputError
from trocar.study.measured.table import read_measured_table

GOOD = "a disc\nHeight: 30mm\nt,x,who\n0,1.5,A\n1,2.5,B\n\n"


@pytest.fixture
def read(tmp_path):
    def reading(text, columns=("t", "x"), encoding="utf-8", **options):
        path = tmp_path / "disc.csv"
        path.write_bytes(text.encode(encoding))
        return read_measured_table(path, columns, **options)

    return reading


def test_columns_are_found_by_name_below_a_preamble(read):
    table = read(GOOD, ("x", "t", "who"))
    np.testing.assert_array_equal(table.numbers("x", 1e-3), [1.5e-3, 2.5e-3])
    assert table.cells["who"] == ("A", "B")
    assert table.preamble == ("a disc", "Height: 30mm")
    assert table.lines == (4, 5)


def test_a_mark_at_the_start_of_the_file_and_windows_line_ends_are_no_trouble(read):
    table = read(GOOD.replace("\n", "\r\n"), encoding="utf-8-sig")
    np.testing.assert_array_equal(table.numbers("t"), [0.0, 1.0])


def test_gaps_are_taken_only_where_they_may_be(read):
    text = "t,x\n0,\n1,NaN\n2,3\n"
    np.testing.assert_array_equal(read(text, gaps=("x",)).numbers("x"), [np.nan, np.nan, 3.0])
    with pytest.raises(InputError, match=r"disc.csv, line 2, x: expected a number, got ''; mend or take out"):
        read(text).numbers("x")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (GOOD.replace("2.5", "nan"), r"disc.csv, line 5, x: expected a finite number, got 'nan'"),
        (GOOD.replace("2.5", "soft"), r"disc.csv, line 5, x: expected a number, got 'soft'"),
        (GOOD.replace("1,2.5,B", "1,2.5"), r"disc.csv, line 5: expected 3 cells, as the head in line 3 has, got 2"),
        (GOOD.replace("t,x,who", "t,y,who"), r"disc.csv, line 3: expected a column named 'x', got 't, y, who'"),
        (GOOD.replace(",", ";"), r"disc.csv: expected a comma between cells, got 'a semicolon'; save it"),
        ("nothing here\n", r"disc.csv: expected a head with the columns t, x"),
        ("", r"disc.csv: expected a head with the columns t, x"),
        ("t,x\n0,1\n", r"disc.csv: expected at least 2 rows below the head in line 1, got 1"),
        ('t,x\n0,"1\n1,2\n', r"disc.csv, line 3: expected cells with a comma between them"),
    ],
)  # fmt: skip
def test_what_is_broken_is_named(read, text, said):
    with pytest.raises(InputError, match=said):
        read(text).numbers("x")


def test_a_decimal_comma_is_told(read):
    with pytest.raises(InputError, match=r"line 2, x: expected a number, got '1,5'; write a decimal point"):
        read("t;x\n0;1,5\n1;2,5\n", delimiter=";").numbers("x")


def test_rows_that_do_not_rise_or_are_not_positive_are_named(read):
    with pytest.raises(InputError, match=r"disc.csv, line 4, t: expected a number above 1, .* got '1'; sort"):
        read("t,x\n0,1\n1,1\n1,1\n").rising("t")
    with pytest.raises(InputError, match=r"disc.csv, line 3, x: expected a number above 0, got '-1'"):
        read("t,x\n0,1\n1,-1\n").positive("x")


def test_a_file_that_is_not_there_or_no_text_is_told(tmp_path):
    with pytest.raises(InputError, match=r"gone.csv: expected a table that can be read, got 'No such file"):
        read_measured_table(tmp_path / "gone.csv", ("t",))
    (tmp_path / "photo.csv").write_bytes(b"\xff\xd8\x00")
    with pytest.raises(InputError, match=r"photo.csv: expected text in UTF-8"):
        read_measured_table(tmp_path / "photo.csv", ("t",))
