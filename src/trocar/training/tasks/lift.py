"""Lift: take hold of tissue, raise it a little and straight, and let go."""

from __future__ import annotations

from trocar.training.tasks.bands import BANDS, FORCE_LIMIT, PASS_SOURCE, RADII, marking
from trocar.training.tasks.step import LetGo, Lift, Step
from trocar.training.tasks.task import Task

_HAND = 0  # has the grasper
_PLACES = ((0.020, 0.030), (0.024, 0.038), (0.018, 0.024), (0.025, 0.028))  # x, y [m]
_HEIGHT = 6e-4  # [m]; straight up, it pulls at skin with 0.04 N
_LASTING = 2.5  # [s]


def lift(level: int) -> Task:
    """Return it at a level."""
    steps: list[Step] = []
    for place in _PLACES:
        steps += [
            Lift(
                hand=_HAND,
                place=place,
                radius=RADII[level],
                height=_HEIGHT,
                most=BANDS[level][1],
                lasting=_LASTING,
            ),
            LetGo(hand=_HAND),
        ]
    return Task(
        name="lift",
        title="Take hold and lift",
        level=level,
        purpose="Raise tissue straight up through a slanting shaft, without pulling at it.",
        tissue="skin",
        ports="usual",
        steps=tuple(steps),
        force_limit=FORCE_LIMIT,
        marking=marking(level, expert_time=25.5),
        pass_source=PASS_SOURCE,
    )
