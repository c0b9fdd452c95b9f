"""An attempt as a file: the devices' own format, every tick of it, so that it comes back bit by bit.

The trainer plays such a file like any other recording (`--device recorded`); one with fewer moments than ticks, made by
another device, is played straight between them.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from math import floor

from trocar.devices.device import HandlePose
from trocar.devices.recorded import RecordedDevice
from trocar.devices.recorder import pose_table
from trocar.devices.recording import Moment, write_recording
from trocar.errors import InputError
from trocar.simulation import DT, HANDLE, JAW, PRESENT, ROLL
from trocar.training.session import Recording


def write_attempt(path: str | os.PathLike[str], recording: Recording) -> None:
    """Write every tick, into a file that is whole or not there; an older recording is replaced.

    Raises:
        InputError: another file has that name, a pose could not be read back, nothing was recorded, or the tissue was
            put to rest meanwhile, which the format cannot say.
        OSError: the place cannot be written to.
    """
    if not len(recording.poses):
        raise InputError("recording", "a tick at least", "none", "nothing was recorded of it")
    if recording.resets:
        at = f"rest once more at {recording.resets[0] * recording.dt:g} s"
        raise InputError("recording", "one that begins from rest once", at, "a file of poses cannot say that")
    write_recording(path, _moments(recording))


def read_attempt(path: str | os.PathLike[str], *, dt: float = DT) -> Recording:
    """Read a recording at every tick from one tick after its start to its end.

    Args:
        path: of the file.
        dt: length of a tick [s].

    Raises:
        InputError: it cannot be read, is none, or is shorter than a tick; the message names file, line and column.
    """
    device = RecordedDevice(path)
    ticks = max(
        floor(device.duration / dt + 1e-6), 1
    )  # a whole number of ticks may come out a rounding short
    times = [(tick + 1) * dt for tick in range(ticks)]
    return Recording(poses=pose_table(device.poses, times), dt=dt)


def _moments(recording: Recording) -> Iterator[Moment]:
    for tick, both in enumerate(recording.poses, 1):
        for hand, pose in enumerate(both.tolist()):
            x, y, z = pose[HANDLE : HANDLE + 3]
            yield Moment(
                time=tick * recording.dt,
                instrument=hand,
                pose=HandlePose(
                    present=pose[PRESENT] != 0.0, handle=(x, y, z), roll=pose[ROLL], jaw=pose[JAW]
                ),
            )
