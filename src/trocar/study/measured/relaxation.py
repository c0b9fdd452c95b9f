"""Beef indented and then held: force and indentation against time.

S. Iaquinta (perineal_indentation, GPL-3.0). The shape of the indenter is not known, so nothing but the course of the
force in time can be learnt: the geometry cancels.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np

from trocar.errors import InputError
from trocar.model import FloatArray
from trocar.study.measured.table import read_measured_table
from trocar.units import MILLIMETRE

FOLDER = "beef_indentation_relaxation_gpl3"
TABLE = "zwick_indentation_relaxation.csv"


@dataclass(frozen=True, kw_only=True)
class Hold:
    """One ramp and hold.

    Args:
        session: its date, as 230407.
        name: of the piece and place.
        time: [s], shape (n,).
        force: [N], shape (n,).
        indentation: [m], shape (n,).
    """

    session: str
    name: str
    time: FloatArray
    force: FloatArray
    indentation: FloatArray

    @property
    def peak(self) -> int:
        """Row of the largest force."""
        return int(np.argmax(self.force))


def read_holds(folder: Path) -> tuple[Hold, ...]:
    """Read the set.

    Raises:
        InputError: the table cannot be read, or time does not rise within a test.
    """
    names = ("date", "test_id", "time_s", "force_N", "indentation_mm")
    table = read_measured_table(folder / TABLE, names, least_rows=10)
    time, force = table.numbers("time_s"), table.numbers("force_N")
    indentation = table.numbers("indentation_mm", MILLIMETRE)
    keys = list(zip(table.cells["date"], table.cells["test_id"], strict=True))
    starts = [0, *(row for row in range(1, len(keys)) if keys[row] != keys[row - 1]), len(keys)]
    holds = []
    for start, end in pairwise(starts):
        for row in start + np.flatnonzero(np.diff(time[start:end]) <= 0)[:1]:
            raise InputError(
                f"{table.file}, line {table.lines[row + 1]}, time_s",
                f"a time above {time[row]:g} s, that of the row before",
                table.cells["time_s"][row + 1],
                "sort the rows of each test",
            )
        rows = slice(start, end)
        if not force[rows].max() > 0:
            raise InputError(
                f"{table.file}, line {table.lines[start]}, test {keys[start][1]}",
                "a force above 0 somewhere",
                float(force[rows].max()),
                "pressing counts positive",
            )
        holds.append(
            Hold(
                session=keys[start][0],
                name=keys[start][1],
                time=time[rows],
                force=force[rows],
                indentation=indentation[rows],
            )
        )
    return tuple(holds)
