"""A table of numbers in a text file, as spreadsheets and instruments write it.

Cells stand apart by commas, semicolons or tabs; where commas do not part them a comma may be the decimal mark. Lines
that begin with # and empty lines are passed over. The first other line names the columns.
"""

from __future__ import annotations

import csv
from collections.abc import Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from math import isfinite
from os import PathLike
from pathlib import Path

import numpy as np

from trocar.errors import InputError
from trocar.model import FloatArray
from trocar.tissues.key_table import Words, printable

MOST_BYTES = 16 * 2**20
MOST_ROWS = 50_000
_MARKS = (";", "\t", ",")  # a decimal comma stands only beside the first two


@dataclass(frozen=True, kw_only=True)
class Columns:
    """Columns by name, and where each row stood.

    Attributes:
        file: as errors call it.
        values: shape (rows,) each.
        lines: number of each row's line in the file, shape (rows,).
    """

    file: str
    values: dict[str, FloatArray]
    lines: Sequence[int]

    def where(self, row: int, column: str = "") -> str:
        """Name a row as errors do."""
        return f"{self.file}: line {self.lines[row]}" + (f": {column}" if column else "")


def read_columns(path: str | PathLike[str], required: Sequence[str], optional: Sequence[str]) -> Columns:
    """Read a table.

    Args:
        path: of a text file in UTF-8.
        required: columns that must be there.
        optional: columns that may be.

    Raises:
        InputError: the file cannot be read, a column is missing, unknown or there twice, or a cell is no finite number;
            the message names the line.
    """
    file = Path(path).name
    lines = [
        (number, line)
        for number, line in enumerate(_text(file, Path(path)).splitlines(), start=1)
        if line.strip(" \t;,") and not line.lstrip(' "').startswith("#")
    ]
    if not lines:
        raise InputError(file, "a line that names columns, then rows of numbers", Words("no row"))
    mark = next((mark for mark in _MARKS if mark in lines[0][1]), ",")
    names = [name.strip() for name in _cells(file, *lines[0], mark)]
    while names and not names[-1]:  # a spreadsheet's empty last columns
        names.pop()
    _check_names(f"{file}: line {lines[0][0]}", names, required, optional)
    if len(lines) - 1 > MOST_ROWS:
        raise InputError(file, f"at most {MOST_ROWS} rows", len(lines) - 1, "keep every second row, or fewer")
    rows = [_row(file, number, _cells(file, number, line, mark), names, mark) for number, line in lines[1:]]
    table = np.array(rows, dtype=np.float64).reshape(len(rows), len(names))
    return Columns(
        file=file,
        values={name: table[:, i] for i, name in enumerate(names)},
        lines=[number for number, _ in lines[1:]],
    )


def _text(file: str, path: Path) -> str:
    try:
        if path.exists() and not path.is_file():
            raise InputError(
                file, "a readable text file", Words("a folder" if path.is_dir() else "no regular file")
            )
        with path.open("rb") as stream:
            content = stream.read(MOST_BYTES + 1)
    except (OSError, ValueError) as error:  # ValueError: a path with a null byte
        reason = getattr(error, "strerror", None) or str(error)
        raise InputError(file, "a readable text file", Words(printable(reason))) from None
    if len(content) > MOST_BYTES:
        raise InputError(file, f"at most {MOST_BYTES // 2**20} MiB", Words("a larger file"))
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        got = content[error.start : error.start + 1]
        raise InputError(f"{file}: line {line}", "text in UTF-8", got, "save the file as UTF-8") from None


def _cells(file: str, number: int, line: str, mark: str) -> list[str]:
    try:
        return [cell.strip() for cell in next(csv.reader([line], delimiter=mark, strict=True))]
    except csv.Error as error:
        raise InputError(f"{file}: line {number}", "cells set apart by one mark", line, str(error)) from None


def _check_names(where: str, names: list[str], required: Sequence[str], optional: Sequence[str]) -> None:
    known = [*required, *optional]
    for name in names:
        if name not in known:
            close = get_close_matches(name, known, n=1)
            advice = f"did you mean {close[0]}?" if close else "take the column out, or rename it"
            raise InputError(where, f"columns of {', '.join(known)}", name, advice)
        if names.count(name) > 1:
            raise InputError(where, "every column once", name)
    missing = [name for name in required if name not in names]
    if missing:
        raise InputError(where, f"a column {missing[0]}", Words(", ".join(names)))


def _row(file: str, number: int, cells: list[str], names: list[str], mark: str) -> list[float]:
    while len(cells) > len(names) and not cells[-1]:
        cells.pop()
    if len(cells) != len(names):
        raise InputError(
            f"{file}: line {number}",
            f"{len(names)} cells, one a column",
            len(cells),
            "with a decimal comma, set columns apart by semicolons" if len(cells) > len(names) else "",
        )
    return [
        _number(f"{file}: line {number}: {name}", cell, mark) for name, cell in zip(names, cells, strict=True)
    ]


def _number(where: str, cell: str, mark: str) -> float:
    text = cell if mark == "," or "." in cell else cell.replace(",", ".", 1)
    try:
        value = float(text.replace("_", "?"))  # Python takes 1_000 for a number, nobody else does
    except ValueError:
        raise InputError(where, "a number", cell or Words("an empty cell")) from None
    if not isfinite(value):
        raise InputError(where, "a finite number", cell, "take the row out, or fill it in")
    return value
