"""Plays a recording back: straight between its moments, held before the first and after the last.

A jump in presence is no motion: where an instrument comes or goes, the earlier pose holds until the later one. An
instrument without a moment is absent throughout.
"""

from __future__ import annotations

import os
from bisect import bisect_right
from typing import Final

from trocar.devices.device import Forces, HandlePose, Poses
from trocar.devices.motion import between
from trocar.devices.recording import Moment, read_recording

_NEVER = HandlePose(present=False, handle=(0.0, 0.0, 0.0), roll=0.0, jaw=1.0)


class RecordedDevice:
    """The hands of a recording.

    Args:
        recording: the file's path.

    Raises:
        InputError: it cannot be read, or is none; the message names file, line and column.
    """

    name: Final = "recorded"
    description: Final = "plays a recording back"
    steered_by_page: Final = False
    every_tick: Final = True

    def __init__(self, recording: str | os.PathLike[str]) -> None:
        moments = read_recording(recording)
        left, right = (_Track(each) for each in moments)
        self._tracks = left, right
        self.duration = max(each[-1].time for each in moments if each)
        """Time of the last moment [s]."""

    def open(self) -> None:
        """Nothing to get ready: the recording was read when the device was made."""

    def poses(self, time: float, /) -> Poses:
        """Return both poses at a time [s] of the recording."""
        left, right = self._tracks
        return left.pose(time), right.pose(time)

    def feel(self, forces: Forces, /) -> None:
        """Feel nothing: the recording goes on whatever the tissue does."""

    def finished(self, time: float, /) -> bool:
        """Return whether the recording is over at a time [s]."""
        return time >= self.duration

    def close(self) -> None:
        """Nothing to let go of."""


class _Track:
    """One instrument's moments."""

    def __init__(self, moments: tuple[Moment, ...]) -> None:
        self._times = [moment.time for moment in moments]
        self._poses = [moment.pose for moment in moments] or [_NEVER]

    def pose(self, time: float) -> HandlePose:
        place = bisect_right(self._times, time)
        start = self._poses[max(place - 1, 0)]
        if place in (0, len(self._times)):
            return start
        end = self._poses[place]
        if not (start.present and end.present):
            return start
        before, after = self._times[place - 1 : place + 1]
        share = (time - before) / (after - before)
        x, y, z = (between(a, b, share) for a, b in zip(start.handle, end.handle, strict=True))
        return HandlePose(
            present=True,
            handle=(x, y, z),
            roll=between(start.roll, end.roll, share),
            jaw=between(start.jaw, end.jaw, share),
        )
