"""Tables of measurements as their authors left them: a few lines of preamble, a head that names columns, rows.

What cannot be read is refused with file, line and what to do about it; no cell is guessed.
"""

from __future__ import annotations

import csv
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from io import StringIO
from math import isfinite, nan
from pathlib import Path

import numpy as np

from trocar.errors import InputError
from trocar.model import FloatArray

MOST_BYTES = 64 * 2**20
_MOST_PREAMBLE = 60  # lines before the head
_NAMES = {",": "a comma", ";": "a semicolon", "\t": "a tab"}


@dataclass(frozen=True, kw_only=True)
class MeasuredTable:
    """Columns of a table.

    Args:
        file: how errors call it.
        preamble: lines before the head.
        lines: where each row stands in the file, counted from 1.
        cells: of each column that was asked for, as text.
        gaps: columns of which cells may be empty or nan.
    """

    file: str
    preamble: tuple[str, ...]
    lines: tuple[int, ...]
    cells: dict[str, tuple[str, ...]]
    gaps: frozenset[str]

    def numbers(self, column: str, unit: float = 1.0) -> FloatArray:
        """Return a column in SI, nan where a cell that may be empty is.

        Args:
            column: its name.
            unit: what one of its unit is in SI.

        Raises:
            InputError: a cell is no finite number.
        """
        values = np.empty(len(self.lines))
        for row, (line, cell) in enumerate(zip(self.lines, self.cells[column], strict=True)):
            values[row] = self._number(column, line, cell)
        return values * unit

    def rising(self, column: str, unit: float = 1.0) -> FloatArray:
        """Return a column in SI whose numbers rise from row to row.

        Raises:
            InputError: as `numbers`, or one does not rise.
        """
        values = self.numbers(column, unit)
        for row in np.flatnonzero(np.diff(values) <= 0)[:1]:
            raise InputError(
                f"{self.file}, line {self.lines[row + 1]}, {column}",
                f"a number above {self.cells[column][row]}, that of the row before",
                self.cells[column][row + 1],
                "sort the rows and take out those that are there twice",
            )
        return values

    def positive(self, column: str, unit: float = 1.0) -> FloatArray:
        """Return a column in SI whose numbers, but for permitted gaps, are above 0.

        Raises:
            InputError: as `numbers`, or one is not above 0.
        """
        values = self.numbers(column, unit)
        for row in np.flatnonzero(values <= 0)[:1]:
            raise InputError(
                f"{self.file}, line {self.lines[row]}, {column}",
                "a number above 0",
                self.cells[column][row],
                "mend or take out the row",
            )
        return values

    def _number(self, column: str, line: int, cell: str) -> float:
        where = f"{self.file}, line {line}, {column}"
        if column in self.gaps and cell.lower() in ("", "nan"):
            return nan
        try:
            value = float(cell)
        except ValueError:
            advice = "write a decimal point" if "," in cell else "mend or take out the row"
            raise InputError(where, "a number", cell, advice) from None
        if not isfinite(value):
            raise InputError(where, "a finite number", cell, "mend or take out the row")
        return value


def read_measured_table(
    path: Path,
    columns: Sequence[str],
    *,
    delimiter: str = ",",
    gaps: Collection[str] = (),
    least_rows: int = 2,
) -> MeasuredTable:
    """Read the columns of a table; others in it are left alone.

    Args:
        path: of the file.
        columns: their names in the head.
        delimiter: what stands between cells.
        gaps: columns whose cells may be empty.
        least_rows: without so many rows there is nothing to compute.

    Raises:
        InputError: the file cannot be read, a column is missing, a row is longer or shorter than the head, or there are
            too few rows.
    """
    text = _text(path)
    rows = list(_rows(path.name, text, delimiter))
    head = _head(path.name, text, rows, columns, delimiter)
    line_of_head, names = rows[head]
    kept = [(line, row) for line, row in rows[head + 1 :] if any(row)]
    for line, row in kept:
        if len(row) != len(names):
            raise InputError(
                f"{path.name}, line {line}",
                f"{len(names)} cells, as the head in line {line_of_head} has",
                len(row),
                "mend or take out the row",
            )
    if len(kept) < least_rows:
        raise InputError(
            path.name, f"at least {least_rows} rows below the head in line {line_of_head}", len(kept)
        )
    places = {column: names.index(column) for column in columns}
    return MeasuredTable(
        file=path.name,
        preamble=tuple(text.splitlines()[: line_of_head - 1]),
        lines=tuple(line for line, _ in kept),
        cells={column: tuple(row[place] for _, row in kept) for column, place in places.items()},
        gaps=frozenset(gaps),
    )


def _text(path: Path) -> str:
    try:
        if path.stat().st_size > MOST_BYTES:
            raise InputError(str(path), f"a table of at most {MOST_BYTES >> 20} MiB", path.stat().st_size)
        return path.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise InputError(str(path), "a table that can be read", error.strerror) from None
    except UnicodeDecodeError as error:
        raise InputError(
            str(path), "text in UTF-8", f"byte {error.start}: {error.reason}", "save it as UTF-8"
        ) from None


def _rows(file: str, text: str, delimiter: str) -> Iterator[tuple[int, list[str]]]:
    reader = csv.reader(StringIO(text), delimiter=delimiter, strict=True)
    try:
        for row in reader:
            yield reader.line_num, [cell.strip() for cell in row]
    except csv.Error as error:
        raise InputError(
            f"{file}, line {reader.line_num}",
            f"cells with {_NAMES[delimiter]} between them",
            str(error),
            "mend or take out the row",
        ) from None


def _head(
    file: str, text: str, rows: list[tuple[int, list[str]]], columns: Sequence[str], delimiter: str
) -> int:
    """Return which row names all the columns; where none does, say what is missing from the likeliest."""
    found = [sum(column in row for column in columns) for _, row in rows[:_MOST_PREAMBLE]]
    best = max(range(len(found)), key=found.__getitem__, default=0)
    if found and found[best] == len(columns):
        return best
    if not found or found[best] == 0:
        for other, name in _NAMES.items():
            lines = text.splitlines()[:_MOST_PREAMBLE]
            cells = [[cell.strip() for cell in line.split(other)] for line in lines]
            if other != delimiter and any(all(column in row for column in columns) for row in cells):
                raise InputError(
                    file, f"{_NAMES[delimiter]} between cells", name, "save it with the separator expected"
                )
        raise InputError(
            file, f"a head with the columns {', '.join(columns)}", "none", "take the file as it was published"
        )
    line, row = rows[best]
    missing = [column for column in columns if column not in row]
    raise InputError(
        f"{file}, line {line}",
        f"a column named {missing[0]!r}",
        ", ".join(row),
        "take the file as it was published",
    )
