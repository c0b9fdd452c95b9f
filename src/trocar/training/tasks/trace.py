"""Trace: follow a curve on the tissue without pressing too hard or leaving it."""

from __future__ import annotations

from math import pi, sin

from trocar.training.tasks.bands import BANDS, FORCE_LIMIT, PASS_SOURCE, RADII, marking
from trocar.training.tasks.step import Follow
from trocar.training.tasks.task import Task

_FROM, _TO, _MIDDLE, _SWING = 0.016, 0.046, 0.030, 0.008  # [m]
_WAVES = 2.0
_POINTS = 241
_HAND = 1
_LEAST = 0.004  # [N] that counts as touching


def trace(level: int) -> Task:
    """Return it at a level."""
    shares = [number / (_POINTS - 1) for number in range(_POINTS)]
    curve = tuple(
        (_TO + share * (_FROM - _TO), _MIDDLE + _SWING * sin(2 * pi * _WAVES * share)) for share in shares
    )
    return Task(
        name="trace",
        title="Trace a line",
        level=level,
        purpose="Move along a line on soft tissue with a touch that stays light.",
        tissue="skin",
        ports="usual",
        steps=tuple(
            Follow(
                hand=_HAND,
                curve=curve,
                to=number,
                width=0.5 * RADII[level],
                least=_LEAST,
                most=BANDS[level][1],
            )
            for number in range(_POINTS)
        ),
        force_limit=FORCE_LIMIT,
        marking=marking(level, expert_time=21.0),
        pass_source=PASS_SOURCE,
    )
