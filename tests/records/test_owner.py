"""A process is told from another one of the same number."""

import os
import subprocess
import sys

import pytest

from trocar.records.owner import is_gone, this_process


def test_this_process_is_there():
    assert this_process() == this_process()
    assert not is_gone(this_process())


def test_a_process_is_gone_as_soon_as_it_ended():
    code = "from trocar.records.owner import this_process; print(this_process(), flush=True); input()"
    process = subprocess.Popen(
        [sys.executable, "-c", code], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )
    with process:
        owner = process.stdout.readline().strip()
        assert owner != this_process()
        assert not is_gone(owner)
        process.kill()
        os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT)  # it has ended, and nobody has asked how
        assert is_gone(owner)
    assert is_gone(owner)


@pytest.mark.parametrize(("part", "other"), [(0, "another-boot"), (2, "999999999"), (3, "1")])
def test_another_boot_number_or_start_is_another_process(part, other):
    parts = this_process().split("/")
    parts[part] = other
    assert is_gone("/".join(parts))


def test_a_process_elsewhere_cannot_be_looked_for():
    boot, _, number, start = this_process().split("/")
    assert not is_gone(f"{boot}/pid:[1]/{number}/{start}")


@pytest.mark.parametrize("owner", ["", "nobody", "a/b/c/d"])
def test_what_names_no_process_is_gone(owner):
    assert is_gone(owner)
