"""Whatever happens to the process that writes, what was acknowledged is there."""

import signal
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path

from records.writing_process import piece
from trocar.records.reading import GONE
from trocar.records.rows import Status
from trocar.records.store import Records

WRITER = Path(__file__).parent / "writing_process.py"


@contextmanager
def writer(*arguments):
    command = [sys.executable, str(WRITER), *map(str, arguments)]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    try:
        yield process
    finally:
        process.kill()
        process.stdout.close()
        process.wait()


def acknowledged(process, at_least):
    """Return the last piece that was acknowledged, which is the given one or a later."""
    for line in process.stdout:
        if line.strip().isdecimal() and int(line) >= at_least:
            return int(line)
    raise AssertionError("the writer ended")


def test_a_killed_writer_loses_nothing_and_is_found_out(tmp_path):
    with writer(tmp_path) as process:
        last = acknowledged(process, 20)
        process.send_signal(signal.SIGKILL)
        last = max([last, *(int(line) for line in process.stdout if line.strip().isdecimal())])
        with Records.open(tmp_path, writing=False) as reader:  # nobody has waited for the dead process yet
            (row,) = reader.attempts()
            _, pieces = reader.chunks(row.id)
    assert (row.status, row.reason) == (Status.INTERRUPTED, GONE)
    assert len(pieces) in {last + 1, last + 2}  # one may have been kept and not been told of
    assert pieces == [piece(number) for number in range(len(pieces))]
    assert row.duration == 0.02 * len(pieces)
    with Records.open(tmp_path) as records:
        assert records.note == "Attempt 1 is interrupted: its process has ended."
        records.trainee("Ben")
    with Records.open(tmp_path) as records:
        assert records.note == ""
        assert records.attempts() == [row]
        assert records.chunks(row.id)[1] == pieces


def test_an_attempt_is_listed_while_another_process_writes_it(tmp_path):
    with writer(tmp_path) as process:
        last = acknowledged(process, 3)
        with Records.open(tmp_path, writing=False) as reader, Records.open(tmp_path) as other:
            for records in (reader, other):
                (row,) = records.attempts()
                assert row.status is Status.RUNNING
                assert row.duration >= 0.02 * (last + 1)
            assert other.note == ""
            number = other.begin(other.trainee("Ben"), task="lift", level=1, device="web", header={}, dt=1e-3)
            other.add(number, b"beside it", 9)
            assert other.chunks(number)[1] == [b"beside it"]


def test_a_full_disk_is_a_sentence_and_the_piece_can_be_added_again(tmp_path):
    with writer(tmp_path, 600_000) as process:
        lines = process.stdout.read().splitlines()
    assert process.wait() == 0
    (said,) = (line for line in lines[1:] if not line.isdecimal())
    assert said.startswith(f"RecordsFullError {tmp_path / 'records.db'}: expected room to write to")
    numbers = [int(line) for line in lines[1:] if line.isdecimal()]
    assert numbers == list(range(len(numbers)))
    with Records.open(tmp_path, writing=False) as reader:
        assert reader.chunks(1)[1] == [piece(number) for number in numbers]
