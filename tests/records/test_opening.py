"""Records that cannot be opened say why, and stay as they are."""

import sqlite3
import subprocess
import sys
from pathlib import Path
from shutil import copy

import pytest
from alembic.autogenerate import compare_metadata
from alembic.migration import MigrationContext
from alembic.script import ScriptDirectory
from sqlalchemy import create_engine, event

from score_cards import attempt
from trocar.errors import InputError
from trocar.records import schema
from trocar.records.database import _begin
from trocar.records.owner import this_process
from trocar.records.rows import Status
from trocar.records.store import Records
from trocar.records.tables import Table
from trocar.records.trouble import RecordsError, RecordsFullError

ATTEMPT = (
    "INSERT INTO attempt (id, trainee_id, task, level, device, status, began, owner, ticks, dt_s, header) "
    "VALUES (?, 1, 'palpate', 1, 'web', ?, '2026-01-02T03:04:05.000006Z', ?, 3000, 0.001, '{}')"
)


def changed(path, *statements):
    """Change a database behind the records' back."""
    connection = sqlite3.connect(path)
    with connection:
        for statement, *values in statements:
            connection.execute(statement, *values)
    connection.close()


def content(folder):
    return {file.name: file.read_bytes() for file in folder.iterdir()}


@pytest.fixture
def old(tmp_path):
    """Records of the first schema, with somebody's attempts in them."""
    path = tmp_path / "records.db"
    engine = create_engine(f"sqlite:///{path}")
    event.listen(engine, "connect", lambda raw, _: setattr(raw, "isolation_level", None))
    event.listen(engine, "begin", _begin)
    with engine.begin() as connection:
        schema._step_through(connection, "0001")
    engine.dispose()
    changed(
        path,
        ("INSERT INTO trainee VALUES (1, 'Anna', '2026-01-02T03:04:05.000006Z')",),
        (ATTEMPT, (1, "interrupted", "")),
        (ATTEMPT, (2, "running", "another boot/pid:[1]/17/4711")),
        (ATTEMPT, (3, "running", this_process())),
        ("INSERT INTO chunk VALUES (1, 0, 3000, ?)", (b"old piece",)),
    )
    return path


def test_where_there_is_nothing_there_is_nothing_to_read(tmp_path):
    folder = tmp_path / "not" / "there"
    with Records.open(folder, writing=False) as reader:
        assert reader.attempts() == []
        assert reader.trainees() == []
        assert reader.answers() == []
        assert reader.metrics() == {}
        assert reader.history("Anna", "lift").rows == ()
        with pytest.raises(InputError, match="the number of an attempt, got 1"):
            reader.attempt(1)
        assert not folder.parent.exists()
        with Records.open(folder) as records:
            records.trainee("Anna")
        assert [one.name for one in reader.trainees()] == ["Anna"]


def test_a_new_file_says_so_and_is_its_owners_alone(tmp_path):
    folder = tmp_path / "Zoë's records? 100 % #1"
    with Records.open(folder) as records:
        assert records.note == f"{folder / 'records.db'} was made."
        attempt(records)
    assert folder.stat().st_mode & 0o077 == 0
    assert [file.name for file in folder.iterdir()] == ["records.db"]
    with Records.open(folder) as records:
        assert records.note == ""
        assert len(records.attempts()) == 1


def test_the_folder_is_the_one_that_is_named(tmp_path, monkeypatch):
    monkeypatch.setenv("TROCAR_DATA", str(tmp_path / "named"))
    with Records.open() as records:
        assert records.path == tmp_path / "named" / "records.db"
    monkeypatch.delenv("TROCAR_DATA")
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "home"))
    with Records.open(writing=False) as records:
        assert records.path == tmp_path / "home" / "trocar" / "records.db"


def test_older_records_are_brought_up_after_a_copy(old):
    before = old.read_bytes()
    with Records.open(old.parent) as records:
        assert records.note == (
            f"{old} was brought from schema 0001 to 0002; as it was, it is kept in records.db.schema-0001. "
            "Attempt 2 is interrupted: its process has ended."
        )
        states = [row.status for row in records.attempts()]
        assert states == [Status.INTERRUPTED, Status.INTERRUPTED, Status.RUNNING]
        assert records.chunks(1)[1] == [b"old piece"]
        records.answer(records.trainee("Anna"), 1, "novice", {"picture": 3})
        assert len(records.answers()) == 1
    assert sorted(file.name for file in old.parent.iterdir()) == ["records.db", "records.db.schema-0001"]
    kept = old.parent / "records.db.schema-0001"
    with sqlite3.connect(kept) as connection:
        assert connection.execute("SELECT version_num FROM alembic_version").fetchone() == ("0001",)
        assert connection.execute("SELECT data FROM chunk").fetchall() == [(b"old piece",)]
        assert connection.execute("PRAGMA integrity_check").fetchone() == ("ok",)
    connection.close()
    assert len(kept.read_bytes()) == len(before)


def test_older_records_are_read_as_they_are(old):
    before = old.read_bytes()
    with Records.open(old.parent, writing=False) as reader:
        assert [row.id for row in reader.attempts()] == [1, 2, 3]
        assert reader.answers() == []
    assert old.read_bytes() == before


def test_a_step_that_fails_leaves_the_older_records(old, monkeypatch):
    real = schema._step_through

    def failing(connection):
        real(connection)
        raise sqlite3.OperationalError("a step failed")

    monkeypatch.setattr(schema, "_step_through", failing)
    with pytest.raises(RecordsError, match="a step failed"):
        Records.open(old.parent)
    monkeypatch.undo()
    with Records.open(old.parent) as records:
        assert "from schema 0001 to 0002" in records.note
        assert len(records.attempts()) == 3


def test_the_known_schemas_are_those_there_are_steps_for(tmp_path, records):
    folder = str(Path(schema.__file__).parent / "migrations")
    steps = ScriptDirectory(folder, version_locations=[folder]).walk_revisions()
    assert tuple(step.revision for step in steps)[::-1] == schema.SCHEMAS


def test_the_steps_lead_to_the_mapped_tables(records):
    with records._engine.connect() as connection:
        assert compare_metadata(MigrationContext.configure(connection), Table.metadata) == []


@pytest.mark.parametrize("writing", [True, False])
def test_newer_records_are_left_to_a_newer_trocar(tmp_path, writing):
    Records.open(tmp_path).close()
    changed(tmp_path / "records.db", ("UPDATE alembic_version SET version_num = '0099'",))
    before = content(tmp_path)
    with pytest.raises(RecordsError, match=r"schema 0002 or older, got 0099; a newer Trocar made it"):
        Records.open(tmp_path, writing=writing)
    assert content(tmp_path)["records.db"] == before["records.db"]


@pytest.mark.parametrize("writing", [True, False])
def test_another_programs_database_is_left_alone(tmp_path, writing):
    changed(tmp_path / "records.db", ("CREATE TABLE song (title)",))
    before = content(tmp_path)
    with pytest.raises(RecordsError, match="another program's"):
        Records.open(tmp_path, writing=writing)
    assert content(tmp_path) == before


@pytest.mark.parametrize("writing", [True, False])
def test_a_file_that_is_no_database_is_left_alone(tmp_path, writing):
    (tmp_path / "records.db").write_text("Dear diary, " * 100)
    before = content(tmp_path)
    with pytest.raises(RecordsError, match="a file that is none"):
        Records.open(tmp_path, writing=writing)
    assert content(tmp_path) == before


@pytest.mark.parametrize("writing", [True, False])
def test_a_damaged_file_says_so(tmp_path, writing):
    with Records.open(tmp_path) as records:
        for _ in range(30):
            attempt(records)
    path = tmp_path / "records.db"
    whole = path.read_bytes()
    path.write_bytes(whole[:4096] + b"\xff" * (len(whole) - 4096))
    before = content(tmp_path)
    with (
        pytest.raises(RecordsError, match="a damaged file"),
        Records.open(tmp_path, writing=writing) as found,
    ):
        found.attempts()
    assert content(tmp_path)["records.db"] == before["records.db"]


@pytest.mark.parametrize("writing", [True, False])
def test_a_file_cut_short_says_so(tmp_path, writing):
    with Records.open(tmp_path) as records:
        for _ in range(30):
            attempt(records)
    path = tmp_path / "records.db"
    path.write_bytes(path.read_bytes()[: 3 * 4096])
    with (
        pytest.raises(RecordsError, match="a damaged file"),
        Records.open(tmp_path, writing=writing) as found,
    ):
        found.attempts()


def test_an_empty_file_is_one_without_records(tmp_path):
    (tmp_path / "records.db").touch()
    with Records.open(tmp_path, writing=False) as reader:
        assert reader.attempts() == []
    with Records.open(tmp_path) as records:
        attempt(records)
        assert len(records.attempts()) == 1


def test_records_that_another_process_holds_say_so(tmp_path, records):
    holder = sqlite3.connect(tmp_path / "records.db", isolation_level=None)
    holder.execute("BEGIN IMMEDIATE")
    try:
        with pytest.raises(RecordsError, match="another process that holds them"):
            Records.open(tmp_path, patience=0.01)
        with Records.open(tmp_path, writing=False, patience=0.01) as reader:
            assert reader.attempts() == []
    finally:
        holder.close()
    records.trainee("Anna")


def test_a_read_only_folder_can_be_read_but_not_written(reachable, without_rights):
    with Records.open(reachable) as records:
        attempt(records)
    before = content(reachable)
    with without_rights(reachable):
        with Records.open(reachable, writing=False) as reader:
            assert [row.status for row in reader.attempts()] == [Status.FINISHED]
        with pytest.raises(RecordsError, match=r"got read-only ones.*TROCAR_DATA"):
            Records.open(reachable)
        with pytest.raises(RecordsError, match="TROCAR_DATA to a folder that you can write to"):
            Records.open(reachable / "below")
    assert content(reachable) == before


def test_a_read_only_folder_is_not_read_without_what_waits_beside_the_file(
    tmp_path, reachable, without_rights
):
    with Records.open(tmp_path) as records:
        attempt(records)
        for end in ("", "-wal"):  # as a copy of the folder of a killed process may be
            copy(tmp_path / f"records.db{end}", reachable)
    waits = pytest.raises(RecordsError, match=r"records.db-wal holds attempts.*copy the folder")
    with without_rights(reachable), waits:
        Records.open(reachable, writing=False)
    with Records.open(reachable, writing=False) as reader:
        assert len(reader.attempts()) == 1


@pytest.mark.parametrize("writing", [True, False])
@pytest.mark.parametrize("below", ["", "below", "far/below"])
def test_a_folder_that_is_a_file_is_refused(tmp_path, writing, below):
    (tmp_path / "file").write_text("hello")
    with pytest.raises(InputError, match=r"file: expected a folder, got 'a file'"):
        Records.open(tmp_path / "file" / below, writing=writing)
    assert (tmp_path / "file").read_text() == "hello"


@pytest.mark.parametrize("writing", [True, False])
def test_a_file_that_is_a_folder_says_so(tmp_path, writing):
    (tmp_path / "records.db").mkdir()
    with pytest.raises(RecordsError, match=r"records.db: expected a file, got a folder"):
        Records.open(tmp_path, writing=writing)


@pytest.mark.parametrize("name", ["x" * 300, "a\0b"])
def test_a_folder_with_an_impossible_name_is_refused(tmp_path, name):
    with pytest.raises(InputError, match="a usable name"):
        Records.open(tmp_path / name)


def test_a_full_database_says_so_and_goes_on_when_there_is_room(records):
    number = records.begin(records.trainee("Anna"), task="lift", level=1, device="web", header={}, dt=1e-3)
    limits = []

    @event.listens_for(records._engine, "checkout")
    def limit(raw, *_):
        raw.execute(f"PRAGMA max_page_count = {limits[-1] if limits else 2**30}")

    limits.append(40)
    with pytest.raises(RecordsFullError, match=r"a full disk; free some and try again"):
        records.add(number, bytes(10**6), 1000)
    assert records.chunks(number)[1] == []
    assert records.attempts()[0].duration == 0
    limits.clear()
    records.add(number, bytes(10**6), 1000)
    assert records.attempts()[0].duration == 1.0


def test_many_processes_may_be_the_first(tmp_path):
    code = "import sys; from trocar.records.store import Records; Records.open(sys.argv[1]).trainee('Anna')"
    processes = [subprocess.Popen([sys.executable, "-c", code, str(tmp_path)]) for _ in range(4)]
    assert [process.wait() for process in processes] == [0, 0, 0, 0]
    with Records.open(tmp_path, writing=False) as reader:
        assert [one.name for one in reader.trainees()] == ["Anna"]
