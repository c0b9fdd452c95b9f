"""Reads a device into the moments of a recording, or into the table that a scene is played with."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import chain
from math import floor, isfinite

import numpy as np

from trocar.devices.device import LEFT, RIGHT, Device, HandlePose, Poses
from trocar.devices.recording import LONGEST, Moment
from trocar.errors import InputError
from trocar.model import FloatArray
from trocar.simulation import POSE

FASTEST_RATE = 1000.0  # [Hz]; the servo's own

_DECIMALS = 9  # of a recorded number: a nanometre


def moments_of(device: Device, *, seconds: float, rate: float) -> Iterator[Moment]:
    """Read an open device at a fixed rate of its own time, without waiting, rounded to a nanometre.

    Args:
        device: one whose poses follow from the time.
        seconds: how long, from its start.
        rate: readings in a second [Hz].

    Raises:
        InputError: the time or the rate is not possible.
    """
    if not (isfinite(seconds) and 0 < seconds <= LONGEST):
        raise InputError("recording: seconds", f"a time above 0 and at most {LONGEST:g} s", seconds)
    if not (isfinite(rate) and 0 < rate <= FASTEST_RATE):
        raise InputError("recording: rate", f"a rate above 0 and at most {FASTEST_RATE:g} Hz", rate)
    last = floor(seconds * rate + 1e-9)  # a whole number of readings may come out a rounding short
    for number in range(last + 1):
        time = number / rate
        for instrument, pose in zip((LEFT, RIGHT), device.poses(time), strict=True):
            x, y, z = (round(coordinate, _DECIMALS) for coordinate in pose.handle)
            roll, jaw = round(pose.roll, _DECIMALS), round(pose.jaw, _DECIMALS)
            short = HandlePose(present=pose.present, handle=(x, y, z), roll=roll, jaw=jaw)
            yield Moment(time=round(time, _DECIMALS), instrument=instrument, pose=short)


def pose_table(poses: Callable[[float], Poses], times: Sequence[float]) -> FloatArray:
    """Return both poses at some times as a scene takes them, shape (n, 2, POSE).

    Args:
        poses: of both hands at a time [s].
        times: [s].
    """
    table = np.zeros((len(times), 2, POSE))
    for tick, time in enumerate(times):
        for hand, pose in enumerate(poses(time)):
            table[tick, hand] = (pose.present, *pose.handle, pose.roll, pose.jaw)
    return table


def thinned(moments: Iterable[Moment]) -> Iterator[Moment]:
    """Drop the moments between equal ones: while an instrument stays, its first and last moment say it all.

    Args:
        moments: in order of time, both instruments in any mixture.

    Yields:
        The moments that remain, in order of time.
    """
    kept: list[Moment] = []
    runs: dict[int, list[Moment]] = {LEFT: [], RIGHT: []}
    for moment in moments:
        run = runs[moment.instrument]
        if run and run[0].pose == moment.pose:
            run[1:] = [moment]
        else:
            kept += run
            runs[moment.instrument] = [moment]
    kept += chain(*runs.values())
    yield from sorted(kept, key=lambda moment: (moment.time, moment.instrument))
