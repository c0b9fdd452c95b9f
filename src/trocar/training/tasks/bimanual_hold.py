"""Bimanual hold: one instrument holds tissue down while the other works beside it."""

from __future__ import annotations

from trocar.training.tasks.bands import BANDS, FORCE_LIMIT, PASS_SOURCE, RADII, marking
from trocar.training.tasks.step import LetGo, Press, Step, Together
from trocar.training.tasks.task import Task

_BASES = ((0, (0.020, 0.030)), (1, (0.040, 0.030)))  # hand, x and y [m]
_POINTS = (((0.036, 0.030), (0.040, 0.038), (0.042, 0.022)), ((0.024, 0.030), (0.020, 0.038), (0.018, 0.022)))
_LASTING = 1.5  # [s]


def bimanual_hold(level: int) -> Task:
    """Return it at a level."""
    least, most = BANDS[level]
    radius = RADII[level]
    steps: list[Step] = []
    for (hand, place), points in zip(_BASES, _POINTS, strict=True):
        base = Press(hand=hand, place=place, radius=radius, least=0.5 * least, most=FORCE_LIMIT, lasting=1.0)
        steps.append(base)
        steps += [
            Together(
                base=base,
                step=Press(
                    hand=1 - hand, place=point, radius=radius, least=least, most=most, lasting=_LASTING
                ),
            )
            for point in points
        ]
        steps.append(LetGo(hand=hand))
    return Task(
        name="bimanual-hold",
        title="Hold and work",
        level=level,
        purpose="Keep one hand still and pressing while the other moves.",
        tissue="skin",
        ports="usual",
        steps=tuple(steps),
        force_limit=FORCE_LIMIT,
        marking=marking(level, expert_time=26.0),
        pass_source=PASS_SOURCE,
    )
