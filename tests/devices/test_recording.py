"""The file format: nothing is lost, every mistake is named by file, line and column, a file is whole or not there."""

import math
from contextlib import suppress
from pathlib import Path

import pytest
from hypothesis import given, seed, settings
from hypothesis import strategies as st

from trocar.devices.device import LEFT, RIGHT, HandlePose
from trocar.devices.recorder import moments_of, thinned
from trocar.devices.recording import Moment, read_recording, write_recording
from trocar.devices.simulated import SimulatedDevice
from trocar.errors import InputError

EXAMPLE = Path(__file__).parents[2] / "examples" / "press-slide-lift.csv"
HEAD = (
    "# trocar recording, version 1\ntime_s,instrument,present,handle_x_m,handle_y_m,handle_z_m,roll_rad,jaw\n"
)
ROW = "0.0,left,1,-0.15,-0.07,0.24,0.0,1.0\n"
LENGTHS = st.floats(-1.0, 1.2)
POSES = st.builds(
    HandlePose,
    present=st.booleans(),
    handle=st.tuples(LENGTHS, LENGTHS, LENGTHS),
    roll=st.floats(-6000, 6000),
    jaw=st.floats(0, 1),
)


def written(tmp_path, text):
    path = tmp_path / "moves.csv"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


@seed(6)
@settings(max_examples=60, deadline=None, database=None)
@given(
    poses=st.lists(st.tuples(st.sampled_from([LEFT, RIGHT]), POSES), min_size=1, max_size=8),
    step=st.floats(1e-9, 99),
)
def test_what_is_written_reads_back_to_the_last_bit(tmp_path_factory, poses, step):
    path = tmp_path_factory.mktemp("recordings") / "moves.csv"
    moments = [Moment(time=n * step, instrument=which, pose=pose) for n, (which, pose) in enumerate(poses)]
    write_recording(path, moments)
    left, right = read_recording(path)
    assert sorted(left + right, key=lambda moment: moment.time) == moments


def test_a_spreadsheet_may_have_saved_it(tmp_path):
    plain = read_recording(written(tmp_path, HEAD + ROW))
    comma_filled = (
        (HEAD + ROW + ",,,,,,,\n").replace("version 1\n", "version 1,,,,,,,\n").replace("\n", "\r\n")
    )
    assert read_recording(written(tmp_path, b"\xef\xbb\xbf" + comma_filled.encode())) == plain
    assert read_recording(written(tmp_path, HEAD + ROW.replace(",", " , "))) == plain


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "line 1: expected # trocar recording, version 1, got 'an empty file'"),
        ("time,x\n1,2\n", "line 1: expected # trocar recording, version 1"),
        (HEAD.replace("version 1", "version 2") + ROW, "line 1: expected version 1, got '2'"),
        (HEAD.splitlines()[0], "line 2: expected time_s,instrument"),
        (HEAD.replace("jaw", "jaw_deg") + ROW, "line 2: expected time_s,instrument"),
        (HEAD, "line 3: expected at least one moment"),
        (HEAD + ROW + "0.1,left,1,0,0,0.2,0\n", "line 4: expected 8 values"),
        (HEAD + ROW + "0.1,left,1,0,0,0.2,0,1,9\n", "line 4: expected 8 values"),
        (HEAD + ROW + ROW, "line 4: time_s: expected a time after 0.0, the left instrument's last"),
        (HEAD + ROW.replace("0.0,left", "-1,left"), "line 3: time_s: expected a number, 0 to 86400 s"),
        (HEAD + ROW.replace("left", "middle"), "line 3: instrument: expected left or right, got 'middle'"),
        (HEAD + ROW.replace("left,1", "left,yes"), "line 3: present: expected 1, in the hand, or 0"),
        (HEAD + ROW.replace("-0.15", "nan"), "line 3: handle_x_m: expected a number"),
        (HEAD + ROW.replace("-0.07", "1e999"), "line 3: handle_y_m: expected a number"),
        (HEAD + ROW.replace("0.24", "3.0"), "line 3: handle_z_m: expected a number, -1 to 1.2 m, got '3.0'"),
        (HEAD + ROW.replace("0.24", "0_24"), "line 3: handle_z_m"),
        (HEAD + ROW.replace("0.24", ""), "line 3: handle_z_m"),
        (HEAD + ROW.replace(",0.0,1.0", ",7000,1.0"), "line 3: roll_rad"),
        (HEAD + ROW.replace(",1.0\n", ",1.01\n"), "line 3: jaw: expected a number, 0, closed, to 1, open"),
        (HEAD + ROW.replace("left", '"left'), "line 3: expected values separated by commas"),
        (HEAD.encode() + b"0.0,left,\xff\n", "line 3: expected text in UTF-8"),
    ],
)
def test_a_mistake_is_named_by_file_line_and_column(tmp_path, text, said):
    path = written(tmp_path, text)
    with pytest.raises(InputError) as caught:
        read_recording(path)
    assert str(caught.value).startswith(f"{path}: {said}")


@seed(8)
@settings(max_examples=100, deadline=None, database=None)
@given(noise=st.binary(max_size=60), place=st.integers(0, len(HEAD + ROW)))
def test_no_bytes_bring_anything_but_an_input_error(tmp_path_factory, noise, place):
    good = (HEAD + ROW).encode()
    path = written(tmp_path_factory.mktemp("recordings"), good[:place] + noise + good[place:])
    moments = ((), ())
    with suppress(InputError):  # anything else is a mistake of ours
        moments = read_recording(path)
    assert all(math.isfinite(c) for each in moments for moment in each for c in moment.pose.handle)


def test_what_is_no_file_is_refused(tmp_path):
    with pytest.raises(InputError, match="No such file"):
        read_recording(tmp_path / "none.csv")
    with pytest.raises(InputError, match="a folder"):
        read_recording(tmp_path)
    with pytest.raises(InputError, match="null byte"):
        read_recording("moves\0.csv")


def moment(**changes):
    pose = HandlePose(**{"present": True, "handle": (0.0, 0.0, 0.2), "roll": 0.0, "jaw": 1.0, **changes})
    return Moment(time=0.0, instrument=LEFT, pose=pose)


def test_a_recording_that_cannot_be_read_back_is_not_written_and_the_old_one_stays(tmp_path):
    path = tmp_path / "moves.csv"
    write_recording(path, [moment()])
    before = path.read_bytes()
    with pytest.raises(InputError, match=r"moves\.csv: line 4: jaw"):
        write_recording(path, [moment(), moment(jaw=2.0)])
    with pytest.raises(InputError, match="at least one moment"):
        write_recording(path, [])
    with pytest.raises(ZeroDivisionError):
        write_recording(path, (moment(jaw=1 / number) for number in (1, 0)))
    assert path.read_bytes() == before
    assert [entry.name for entry in tmp_path.iterdir()] == ["moves.csv"]


def test_another_file_is_not_overwritten(tmp_path):
    path = tmp_path / "thesis.csv"
    path.write_text("mine")
    with pytest.raises(InputError, match="another file"):
        write_recording(path, [moment()])
    assert path.read_text() == "mine"


def test_the_example_is_what_its_command_writes():
    device = SimulatedDevice("press-slide-lift")
    fresh = list(thinned(moments_of(device, seconds=device.duration, rate=50.0)))
    left, right = read_recording(EXAMPLE)
    assert len(left) + len(right) == len(fresh)
    kept = sorted(left + right, key=lambda moment: (moment.time, moment.instrument))
    for one, other in zip(kept, fresh, strict=True):
        assert (one.time, one.instrument, one.pose.present) == (
            other.time,
            other.instrument,
            other.pose.present,
        )
        # Another machine's sine may end differently in the last bit, and so round to the next nanometre.
        assert one.pose.handle == pytest.approx(other.pose.handle, abs=1.5e-9)
        assert (one.pose.roll, one.pose.jaw) == pytest.approx((other.pose.roll, other.pose.jaw), abs=1.5e-9)
    assert EXAMPLE.stat().st_size < 200_000
