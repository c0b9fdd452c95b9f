"""The versions of the tables, and how an older file is brought to the newest.

All steps and the record of them are one transaction: a file has one version or the other, never something between. The
file as it was is kept beside it first.
"""

from __future__ import annotations

from pathlib import Path

from sqlalchemy import Connection

from trocar.records.database import copy_whole
from trocar.records.trouble import RecordsError

SCHEMAS = ("0001", "0002")
"""Every version there has been; the last is what `trocar.records.tables` maps."""

NEWEST = SCHEMAS[-1]
WITH_ANSWERS = "0002"


def version(connection: Connection, path: Path) -> str | None:
    """Return the version of a file's tables, or None where it has no tables at all.

    Raises:
        RecordsError: the tables are another program's, or a later Trocar's.
    """
    found = {
        name
        for (name,) in connection.exec_driver_sql(
            "SELECT name FROM sqlite_master WHERE type = 'table' AND name NOT LIKE 'sqlite!_%' ESCAPE '!'"
        )
    }
    if not found:
        return None
    known = None
    if "alembic_version" in found:
        known = connection.exec_driver_sql("SELECT version_num FROM alembic_version").scalar()
    if known is None:
        raise RecordsError(
            f"{path}: expected a database of Trocar's, got another program's; "
            "move it away, or set TROCAR_DATA to another folder"
        )
    if known not in SCHEMAS:
        raise RecordsError(
            f"{path}: expected schema {NEWEST} or older, got {known}; "
            "a newer Trocar made it: use that one, it was left as it is"
        )
    return str(known)


def bring_up(connection: Connection, path: Path, patience: float) -> str:
    """Bring a file to the newest version, and return what was done as a sentence, empty if nothing.

    Args:
        connection: in a transaction that has the file's lock.
        path: of the file.
        patience: how long another process may hold it while it is copied [s].

    Raises:
        RecordsError: as `version` does; or an older file cannot be copied first.
    """
    old = version(connection, path)
    if old == NEWEST:
        return ""
    if old is None:
        _step_through(connection)
        return f"{path} was made."
    copy = path.with_name(f"{path.name}.schema-{old}")
    copy_whole(path, copy, patience)
    _step_through(connection)
    return f"{path} was brought from schema {old} to {NEWEST}; as it was, it is kept in {copy.name}."


def _step_through(connection: Connection, target: str = NEWEST) -> None:
    # Imported here: only a file that is new or old needs alembic, which takes long to load.
    from alembic.migration import MigrationContext  # noqa: PLC0415
    from alembic.operations import Operations  # noqa: PLC0415
    from alembic.script import ScriptDirectory  # noqa: PLC0415

    folder = str(Path(__file__).parent / "migrations")
    steps = ScriptDirectory(folder, version_locations=[folder])
    context = MigrationContext.configure(connection)
    with Operations.context(context):
        for step in reversed(list(steps.iterate_revisions(target, context.get_current_revision() or "base"))):
            step.module.upgrade()
            context.stamp(steps, step.revision)
