"""Where records lie: in the folder `TROCAR_DATA` names, or else in the platform's place for a user's data."""

from __future__ import annotations

import os
from pathlib import Path

from platformdirs import user_data_dir

from trocar.errors import InputError
from trocar.records.trouble import RecordsError

VARIABLE = "TROCAR_DATA"
FILE = "records.db"


def records_folder() -> Path:
    """Return the folder that records lie in; it need not exist yet."""
    named = os.environ.get(VARIABLE, "")
    return Path(named).expanduser() if named else Path(user_data_dir("trocar", appauthor=False))


def check_folder(folder: Path) -> None:
    """Refuse a folder that is something else, or in which something else has the file's name.

    Raises:
        InputError: it is a file, or nothing can be called so.
        RecordsError: the file is a folder.
    """
    if "\0" in str(folder):
        raise InputError("records: folder", "a usable name", str(folder), "it has a null byte")
    for place in (folder, *folder.parents):
        try:
            if place.is_dir():
                break
            if place.exists() or place.is_symlink():
                advice = f"name another folder, or set {VARIABLE} to one"
                raise InputError(f"records: {place}", "a folder", "a file", advice)
        except OSError as error:  # a name too long, a folder that may not be looked into
            reason = error.strerror or str(error)
            raise InputError("records: folder", "a usable name", str(folder), reason) from None
    if (folder / FILE).is_dir():
        raise RecordsError(f"{folder / FILE}: expected a file, got a folder; move it away, or set {VARIABLE}")


def make_folder(folder: Path) -> None:
    """Make the folder where it is missing, for its owner alone: records are about people.

    Raises:
        InputError: it is a file.
        RecordsError: it cannot be made.
    """
    check_folder(folder)
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    except OSError as error:
        raise RecordsError(
            f"{folder}: expected a folder that can be made, got {error.strerror or error}; "
            f"set {VARIABLE} to a folder that you can write to"
        ) from None
