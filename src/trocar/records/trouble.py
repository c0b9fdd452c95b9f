"""What is said when the file of records does not do what is asked of it: what, where, and what to do.

SQLite names its troubles by numbers; a caller gets one sentence. None of these loses what was kept before: a
transaction that failed has changed nothing.
"""

from __future__ import annotations

import os
import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from sqlalchemy.exc import DBAPIError
from sqlalchemy.exc import TimeoutError as NoConnection

from trocar.errors import TrocarError


class RecordsError(TrocarError):
    """The records could not be opened, read or written; what was kept before is untouched."""


class RecordsFullError(RecordsError):
    """There is no room to write to. Keep what was to be kept, and try again when there is."""


_FULL = "expected room to write to, got a full disk; free some and try again: nothing kept so far is lost"
_LOCKED = (
    "expected the records to be free, got another process that holds them; close it or wait, then try again"
)
_READ_ONLY = (
    "expected a file and folder that can be written to, got read-only ones; "
    "change their permissions, or set TROCAR_DATA to another folder"
)
_NO_DATABASE = (
    "expected a database of records, got a file that is none; "
    "move it away, or set TROCAR_DATA to another folder: it was left as it is"
)
_DAMAGED = (
    "expected whole records, got a damaged file; keep a copy of it and put a backup in its place "
    "(sqlite3's .recover may save what can still be read): it was left as it is"
)
_CANNOT_OPEN = (
    "expected a file that can be opened, got one that cannot; look at what lies there and at its permissions"
)
_BROKEN_DISK = "expected a disk that reads and writes, got an error of it; look at the disk, then try again"

_SENTENCES = {
    sqlite3.SQLITE_FULL: _FULL,
    sqlite3.SQLITE_BUSY: _LOCKED,
    sqlite3.SQLITE_LOCKED: _LOCKED,
    sqlite3.SQLITE_READONLY: _READ_ONLY,
    sqlite3.SQLITE_PERM: _READ_ONLY,
    sqlite3.SQLITE_NOTADB: _NO_DATABASE,
    sqlite3.SQLITE_CORRUPT: _DAMAGED,
    sqlite3.SQLITE_CANTOPEN: _CANNOT_OPEN,
    sqlite3.SQLITE_IOERR: _BROKEN_DISK,
}
_NO_ROOM = {  # what a write beyond a quota or a limit of the file's size comes as
    sqlite3.SQLITE_IOERR_WRITE,
    sqlite3.SQLITE_IOERR_SHMSIZE,
    sqlite3.SQLITE_IOERR_TRUNCATE,
}


@contextmanager
def told(path: Path) -> Iterator[None]:
    """Turn what SQLite says about a file into a sentence.

    Args:
        path: of the file.

    Raises:
        RecordsError: whatever the database could not do; `RecordsFullError` where there was no room.
    """
    try:
        yield
    except sqlite3.Error as error:
        raise records_error(path, error) from None
    except DBAPIError as error:
        if not isinstance(error.orig, sqlite3.Error):
            raise
        raise records_error(path, error.orig) from None
    except NoConnection:
        raise RecordsError(f"{path}: {_LOCKED}") from None


def records_error(path: Path, error: sqlite3.Error) -> RecordsError:
    """Return the sentence for one of SQLite's errors."""
    code = getattr(error, "sqlite_errorcode", None)  # set by SQLite itself, not by Python's own checks
    if code is None:
        return RecordsError(f"{path}: expected records that can be read and written, got: {error}")
    if code == sqlite3.SQLITE_FULL or code in _NO_ROOM:
        return RecordsFullError(f"{path}: {_FULL}")
    kind = code & 0xFF
    if kind == sqlite3.SQLITE_CANTOPEN and not _can_write_to(path.parent):
        kind = sqlite3.SQLITE_READONLY
    known = _SENTENCES.get(kind)  # the low byte is the kind, the rest its particulars
    if known is None and "no such" in str(error):
        known = _DAMAGED  # a table or column that the file's own version promises
    return RecordsError(f"{path}: {known or f'expected records that can be read and written, got: {error}'}")


def _can_write_to(folder: Path) -> bool:
    return os.access(folder, os.W_OK, effective_ids=os.access in os.supports_effective_ids)
