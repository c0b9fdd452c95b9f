"""Reads a device into the moments of a recording."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import chain
from math import floor, isfinite

from trocar.devices.device import LEFT, RIGHT, Device, HandlePose
from trocar.devices.recording import LONGEST, Moment
from trocar.errors import InputError

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
