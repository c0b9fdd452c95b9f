"""The file of records, opened: for writing, or for reading beside whoever writes.

SQLite in its write-ahead mode (WAL): a transaction is on the disk when it returns (synchronous FULL), and readers see
the last whole state while another process writes. Such a file needs two companions beside it, `-wal` and `-shm`, even
for reading; in a folder where they cannot be made, nobody writes either, and the file is read as one that does not
change.
"""

from __future__ import annotations

import os
import sqlite3
from pathlib import Path
from urllib.parse import quote

from sqlalchemy import Connection, Engine, create_engine, event
from sqlalchemy.pool import NullPool, QueuePool

from trocar.records.trouble import RecordsError, told

PATIENCE = 5.0  # [s] that another process may hold the file for

_WRITES = (
    "trocar_writes"  # among a connection's options: its transactions take the file's lock when they begin
)
_FOLDER_IS_READ_ONLY = {
    sqlite3.SQLITE_CANTOPEN,
    sqlite3.SQLITE_READONLY_DIRECTORY,
    sqlite3.SQLITE_READONLY_CANTINIT,
    sqlite3.SQLITE_READONLY_RECOVERY,
}


def engine_for_writing(path: Path, patience: float) -> Engine:
    """Return an engine whose connections may write; the file is made if it is missing.

    Args:
        path: of the file.
        patience: how long to wait for another process that holds it [s].
    """

    def connect() -> sqlite3.Connection:
        connection = _connect(path, "mode=rwc", patience)
        connection.execute("PRAGMA foreign_keys = ON")
        connection.execute("PRAGMA synchronous = FULL")
        connection.execute("PRAGMA secure_delete = ON")  # what is removed is overwritten, not only let go
        return connection

    # The pool is as patient as the file: a thread that found no connection would say the same thing.
    engine = create_engine(
        "sqlite://", creator=connect, poolclass=QueuePool, pool_size=8, pool_timeout=patience
    )
    event.listen(engine, "begin", _begin)
    return engine


def engine_for_reading(path: Path, patience: float) -> Engine:
    """Return an engine whose connections only read; each looks afresh how the file can be read.

    Args:
        path: of the file, which is there.
        patience: how long to wait for another process that holds it [s].
    """

    def connect() -> sqlite3.Connection:
        try:
            return _looked_into(_connect(path, "mode=ro", patience))
        except sqlite3.OperationalError as error:
            if error.sqlite_errorcode not in _FOLDER_IS_READ_ONLY:
                raise
            _check_nothing_waits(path)
            return _looked_into(_connect(path, "mode=ro&immutable=1", patience))

    engine = create_engine("sqlite://", creator=connect, poolclass=NullPool)
    event.listen(engine, "begin", _begin)
    return engine


def writes(engine: Engine) -> Engine:
    """Return the engine for transactions that write: each has the file's lock from its beginning.

    A transaction that reads first and asks for the lock later may be refused it, however patient it is.
    """
    return engine.execution_options(**{_WRITES: True})


def use_write_ahead(path: Path, patience: float) -> None:
    """Put the file into the mode in which readers and a writer do not wait for each other; it stays in it.

    Raises:
        RecordsError: the file is none of records, cannot be written to, or is held.
    """
    with told(path):
        connection = _connect(path, "mode=rwc", patience)
        try:
            connection.execute("PRAGMA journal_mode = WAL")
        finally:
            connection.close()


def clear_out(engine: Engine, path: Path) -> None:
    """Write the file anew without what was deleted, which would stay readable in it, and empty its companion.

    Raises:
        RecordsError: another process holds the companion.
    """
    connection = engine.raw_connection()
    try:
        cursor = connection.cursor()
        cursor.execute("VACUUM")
        cursor.execute("PRAGMA wal_checkpoint(TRUNCATE)")
        busy, *_ = cursor.fetchone() or (1,)
        if busy:
            raise RecordsError(
                f"{path}: what was removed can still be read beside it; close the trainer and remove once more"
            )
    finally:
        connection.close()


def copy_whole(path: Path, copy: Path, patience: float) -> None:
    """Copy the last whole state into a file that is whole or not there; an older copy is replaced.

    Raises:
        RecordsError: there is no room, or the folder cannot be written to.
    """
    partial = copy.with_name(f".{copy.name}.partial-{os.getpid()}")
    try:
        with told(copy):
            source = _connect(path, "mode=ro", patience)
            try:
                target = _connect(partial, "mode=rwc", patience)
                try:
                    source.backup(target)
                    target.execute("PRAGMA journal_mode = DELETE")  # one file alone, easy to move
                finally:
                    target.close()
            finally:
                source.close()
        _settle(partial)
        partial.replace(copy)
        _settle(copy.parent)
    except OSError as error:
        raise RecordsError(
            f"{copy}: expected to keep a copy of the older records there, got {error.strerror or error}"
        ) from None
    finally:
        for end in ("", "-wal", "-shm", "-journal"):
            partial.with_name(partial.name + end).unlink(missing_ok=True)


def _connect(path: Path, how: str, patience: float) -> sqlite3.Connection:
    address = f"file:{quote(os.fsencode(path.absolute()))}?{how}"
    return sqlite3.connect(address, uri=True, timeout=patience, isolation_level=None, check_same_thread=False)


def _looked_into(connection: sqlite3.Connection) -> sqlite3.Connection:
    """Read something, so that what cannot be read is known now."""
    try:
        connection.execute("PRAGMA schema_version").fetchone()
    except sqlite3.Error:
        connection.close()
        raise
    return connection


def _check_nothing_waits(path: Path) -> None:
    """Refuse a file whose companion holds what the file itself does not have yet."""
    waiting = path.with_name(f"{path.name}-wal")
    if waiting.exists() and waiting.stat().st_size > 0:
        raise RecordsError(
            f"{path}: expected a folder that can be written to, since {waiting.name} holds attempts that are "
            "not in the file yet, got a read-only one; copy the folder and set TROCAR_DATA to the copy"
        )


def _begin(connection: Connection) -> None:
    """Begin a transaction ourselves: sqlite3's own module would leave changes of tables outside it."""
    immediate = connection.get_execution_options().get(_WRITES, False)
    connection.exec_driver_sql("BEGIN IMMEDIATE" if immediate else "BEGIN")


def _settle(place: Path) -> None:
    """Have a file, or a folder's list of files, on the disk before going on."""
    descriptor = os.open(place, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
