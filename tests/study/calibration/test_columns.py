"""Tables as instruments write them."""

import numpy as np
import pytest

from trocar.errors import InputError
from trocar.study.calibration.columns import read_columns

NAMES = ("time_s", "force_n")


def read(tmp_path, text, optional=("extra",)):
    path = tmp_path / "data.csv"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return read_columns(path, NAMES, optional)


@pytest.mark.parametrize(
    "text",
    [
        "time_s,force_n\n0,1.5\n0.25,2\n",
        "# a comment\n\ntime_s, force_n\n0, 1.5\n# another\n0.25, 2\n",
        "time_s;force_n\n0;1,5\n0,25;2\n",
        "time_s\tforce_n\n0\t1,5\n0.25\t2\n",
        "\ufefftime_s,force_n,,\r\n0,1.5,,\r\n2.5e-1,2,,\r\n,,,\r\n",
    ],
    ids=["commas", "comments", "semicolons", "tabs", "spreadsheet"],
)
def test_every_way_of_writing_is_read(tmp_path, text):
    found = read(tmp_path, text)
    assert np.array_equal(found.values["time_s"], [0.0, 0.25])
    assert np.array_equal(found.values["force_n"], [1.5, 2.0])


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "expected a line that names columns"),
        ("time_s,force_n\n0,1\n1,nan\n", r"line 3: force_n: expected a finite number, got 'nan'"),
        ("time_s,force_n\n0,\n", r"line 2: force_n: expected a number, got an empty cell"),
        ("time_s,force_n\n0,1_0\n", r"line 2: force_n: expected a number"),
        ("time_s,force_n\n0,1,5\n", r"line 2: expected 2 cells.*semicolons"),
        ("time_s,forse_n\n0,1\n", r"line 1: .*did you mean force_n\?"),
        ("time_s,force_n,time_s\n0,1,2\n", r"line 1: expected every column once, got 'time_s'"),
        ("time_s,extra\n0,1\n", r"line 1: expected a column force_n, got time_s, extra"),
        (b"time_s,force_n\n0,\xff\n", r"line 2: expected text in UTF-8"),
    ],
)
def test_what_is_no_table_is_refused_with_its_line(tmp_path, text, words):
    with pytest.raises(InputError, match=words):
        read(tmp_path, text)


def test_a_file_that_is_not_there_or_a_folder_is_refused(tmp_path):
    for path in (tmp_path / "none.csv", tmp_path):
        with pytest.raises(InputError, match="readable text file"):
            read_columns(path, NAMES, ())
