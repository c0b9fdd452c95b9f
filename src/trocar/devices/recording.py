"""Recordings of both hands: a text file that any spreadsheet opens and any trainer plays back.

The first line says what the file is and in which version, the second names the columns, and each further line is one
instrument at one time::

    # trocar recording, version 1
    time_s,instrument,present,handle_x_m,handle_y_m,handle_z_m,roll_rad,jaw
    0.02,left,1,-0.150213,-0.072101,0.243310,0.0,1.0

Times rise for each instrument by itself. Numbers are written in the shortest form that reads back as the same float64,
so a recording loses nothing. Handles are recorded, not tips: the same ports and shafts give the same tips.
"""

from __future__ import annotations

import csv
import os
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from io import StringIO
from math import isfinite, pi
from pathlib import Path

from trocar.contact.instrument import LARGEST_BLOCK, NAMES
from trocar.devices.device import FARTHEST, LEFT, RIGHT, HandlePose
from trocar.errors import InputError
from trocar.whole_file import whole

MARK = "# trocar recording, version "
VERSION = 1
COLUMNS = ("time_s", "instrument", "present", "handle_x_m", "handle_y_m", "handle_z_m", "roll_rad", "jaw")

MOST_BYTES = 64 * 2**20  # two hours of both hands at 60 Hz, or five minutes of every tick
LONGEST = 24 * 3600.0  # [s]
MOST_ROLL = 2000 * pi  # [rad]; what the trainer takes from a page, too

_RANGES = {  # column: (least, most, what that means)
    "time_s": (0.0, LONGEST, f"0 to {LONGEST:g} s"),
    **{
        f"handle_{axis}_m": (
            -FARTHEST,
            FARTHEST + LARGEST_BLOCK,
            f"{-FARTHEST:g} to {FARTHEST + LARGEST_BLOCK:g} m",
        )
        for axis in "xyz"
    },
    "roll_rad": (-MOST_ROLL, MOST_ROLL, f"{-MOST_ROLL:.0f} to {MOST_ROLL:.0f} rad"),
    "jaw": (0.0, 1.0, "0, closed, to 1, open"),
}


@dataclass(frozen=True, kw_only=True, slots=True)
class Moment:
    """One instrument at one time.

    Args:
        time: since the start of the recording [s].
        instrument: `LEFT` or `RIGHT`.
        pose: how it is held.
    """

    time: float
    instrument: int
    pose: HandlePose


def read_recording(path: str | os.PathLike[str]) -> tuple[tuple[Moment, ...], tuple[Moment, ...]]:
    """Return the moments of the left and of the right instrument, in order of time; not both are empty.

    Raises:
        InputError: the file cannot be read, is no recording, or a number in it is not possible; the message names file,
            line and column.
    """
    return _read(str(path), Path(path))


def write_recording(path: str | os.PathLike[str], moments: Iterable[Moment]) -> None:
    """Write moments, in order of time, into a file that is whole or not there; an older recording is replaced.

    Raises:
        InputError: another file has that name, there is no moment, or a moment could not be read back.
        OSError: the place cannot be written to.
    """
    place = Path(path)
    if place.exists() and not is_recording(place):
        raise InputError(
            f"out: {place}", "a new file, or an older recording", "another file", "choose another name"
        )
    place.parent.mkdir(parents=True, exist_ok=True)
    with whole(place) as partial:
        with partial.open("w", encoding="utf-8", newline="") as stream:
            stream.writelines(_lines(moments))
        _read(f"out: {place}", partial)


def is_recording(path: Path) -> bool:
    """Return whether a file begins as a recording of any version does."""
    if not path.is_file():
        return False
    with path.open("rb") as stream:
        return stream.read(len(MARK)) == MARK.encode()


def _read(file: str, path: Path) -> tuple[tuple[Moment, ...], tuple[Moment, ...]]:
    lines = _text(file, path).splitlines()
    if not lines or not lines[0].startswith(MARK):
        raise InputError(f"{file}: line 1", f"{MARK}{VERSION}", lines[0] if lines else "an empty file")
    if _first_cell(lines[0]) != f"{MARK}{VERSION}":
        advice = "it was written by another version of Trocar"
        raise InputError(f"{file}: line 1", f"version {VERSION}", _first_cell(lines[0])[len(MARK) :], advice)
    if len(lines) < 2 or tuple(cell.strip() for cell in lines[1].split(",")) != COLUMNS:
        raise InputError(
            f"{file}: line 2", ",".join(COLUMNS), lines[1] if len(lines) > 1 else "the file's end"
        )
    moments: tuple[list[Moment], list[Moment]] = ([], [])
    for number, cells in _rows(file, lines):
        moment = _moment(f"{file}: line {number}", cells)
        earlier = moments[moment.instrument]
        if earlier and moment.time <= earlier[-1].time:
            name = NAMES[moment.instrument]
            expected = f"a time after {earlier[-1].time!r}, the {name} instrument's last"
            raise InputError(f"{file}: line {number}: time_s", expected, moment.time)
        earlier.append(moment)
    if not any(moments):
        raise InputError(f"{file}: line {len(lines) + 1}", "at least one moment", "the file's end")
    return tuple(moments[LEFT]), tuple(moments[RIGHT])


def _lines(moments: Iterable[Moment]) -> Iterator[str]:
    yield f"{MARK}{VERSION}\n"
    yield f"{','.join(COLUMNS)}\n"
    for moment in moments:
        pose = moment.pose
        numbers = (repr(float(number)) for number in (*pose.handle, pose.roll, pose.jaw))
        place = f"{float(moment.time)!r},{NAMES[moment.instrument]},{int(pose.present)}"
        yield f"{place},{','.join(numbers)}\n"


def _text(file: str, path: Path) -> str:
    expected = "a recording, a readable text file"
    try:
        if path.exists() and not path.is_file():
            raise InputError(file, expected, "a folder" if path.is_dir() else "no regular file")
        with path.open("rb") as stream:
            content = stream.read(MOST_BYTES + 1)
    except (OSError, ValueError) as error:  # ValueError: a path with a null byte
        raise InputError(file, expected, getattr(error, "strerror", None) or str(error)) from None
    if len(content) > MOST_BYTES:
        raise InputError(file, f"at most {MOST_BYTES} bytes", "a larger file")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise InputError(
            f"{file}: line {line}", "text in UTF-8", content[error.start : error.start + 1]
        ) from None


def _first_cell(line: str) -> str:
    """Return a comment line as it was before a spreadsheet filled it up with empty cells."""
    return line.rstrip(", \t").strip('"')


def _rows(file: str, lines: list[str]) -> Iterator[tuple[int, list[str]]]:
    """Yield the cells of each line that has any, with the line's number."""
    for number, line in enumerate(lines[2:], start=3):
        try:
            cells = next(csv.reader(StringIO(line), strict=True), [])
        except csv.Error as error:
            raise InputError(
                f"{file}: line {number}", "values separated by commas", line, str(error)
            ) from None
        if any(cell.strip() for cell in cells):
            yield number, [cell.strip() for cell in cells]


def _moment(where: str, cells: list[str]) -> Moment:
    if len(cells) != len(COLUMNS):
        raise InputError(where, f"{len(COLUMNS)} values", ",".join(cells), f"there are {len(cells)}")
    row = dict(zip(COLUMNS, cells, strict=True))
    if row["instrument"] not in NAMES:
        raise InputError(f"{where}: instrument", " or ".join(NAMES), row["instrument"])
    if row["present"] not in ("0", "1"):
        raise InputError(f"{where}: present", "1, in the hand, or 0", row["present"])
    time, x, y, z, roll, jaw = (_number(f"{where}: {column}", row[column], column) for column in _RANGES)
    pose = HandlePose(present=row["present"] == "1", handle=(x, y, z), roll=roll, jaw=jaw)
    return Moment(time=time, instrument=NAMES.index(row["instrument"]), pose=pose)


def _number(where: str, text: str, column: str) -> float:
    least, most, meaning = _RANGES[column]
    try:
        value = float(text.replace("_", "?"))  # Python takes 1_000 for a number, nobody else does
    except ValueError:
        raise InputError(where, f"a number, {meaning}", text) from None
    if not (isfinite(value) and least <= value <= most):
        raise InputError(where, f"a number, {meaning}", text)
    return value
