"""Whoever is killed, forces end and nothing stays behind. `bench/kills.py` does it a hundred times."""

import os
import signal
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path

import pytest

from realtime.conftest import beaten
from realtime.toy_scene import until
from trocar.realtime.guard import GuardLimits
from trocar.simulation import FORCE

OPEN = GuardLimits(damping=1e3, still_growth=1e6, reserve=1e3, credit=1e3, slew=1e9, clamp=100.0)
HERE = Path(__file__).parent


def running(process):
    """Say whether a process is there and no mere entry of the dead."""
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except (FileNotFoundError, ProcessLookupError):
        return False


def members(group):
    """Return the processes of a group that still run."""
    found = []
    for entry in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = entry.read_text().rpartition(")")[2].split()
        except (FileNotFoundError, ProcessLookupError):
            continue
        if int(fields[2]) == group and fields[0] != "Z":
            found.append(int(entry.parent.name))
    return found


@contextmanager
def parent():
    """Start a parent in a group of its own; give it and its servo's number."""
    path = os.pathsep.join([str(HERE.parent), *(part for part in sys.path if part)])
    process = subprocess.Popen(
        [sys.executable, str(HERE / "doomed_parent.py")],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
        env={**os.environ, "PYTHONPATH": path},
    )
    try:
        yield process, int(process.stdout.readline())
    finally:
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
        process.communicate()


def test_a_killed_servo_is_no_force_and_starts_again(make_servo):
    servo = make_servo(smoothing=0.0, limits=OPEN)
    servo.start()
    for _ in range(2):
        with beaten(servo):
            servo.command(0, present=True, handle=(0.0, 0.0, -1e-2))
            assert until(lambda: servo.latest().hand_forces[0, 2] > 0.9)
            os.kill(servo.process_id, signal.SIGKILL)
            assert until(lambda: not servo.alive)
            state = servo.latest()
            assert not state.hand_forces.any()
            assert not state.records[:, FORCE : FORCE + 3].any()
            assert servo.exit_reason == "was killed by SIGKILL"
        before = servo.process_id
        servo.restart()
        assert servo.process_id != before
        assert servo.alive


def test_a_killed_parent_takes_its_servo_along():
    with parent() as (process, servo):
        assert running(servo)
        process.kill()
        process.wait()
        assert until(lambda: not members(process.pid), within=30)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGHUP], ids=["Ctrl-C", "a closed terminal"])
def test_a_signal_to_the_whole_group_leaves_nothing(number):
    with parent() as (process, servo):
        os.killpg(process.pid, number)
        _, errors = process.communicate(timeout=120)
        assert until(lambda: not members(process.pid), within=30)
        assert not running(servo)
        assert "trocar/realtime/process.py" not in errors  # the servo was not interrupted itself
