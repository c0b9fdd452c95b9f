"""Alternate: touch lit points with left and right in turn, lightly."""

from __future__ import annotations

from trocar.training.tasks.bands import BANDS, FORCE_LIMIT, PASS_SOURCE, RADII, marking
from trocar.training.tasks.step import Press
from trocar.training.tasks.task import Task

_LEFT = (
    (0.018, 0.030),
    (0.024, 0.038),
    (0.016, 0.022),
    (0.025, 0.025),
    (0.020, 0.036),
    (0.015, 0.028),
    (0.024, 0.032),
)  # x, y [m]
_LASTING = 0.2  # [s]
_WIDTH = 0.06  # [m]


def alternate(level: int) -> Task:
    """Return it at a level."""
    least, most = BANDS[level]
    places = [at for x, y in _LEFT for at in ((0, (x, y)), (1, (_WIDTH - x, y)))]
    return Task(
        name="alternate",
        title="Left and right in turn",
        level=level,
        purpose="Bring either hand to a point quickly, and touch it lightly.",
        tissue="skin",
        ports="usual",
        steps=tuple(
            Press(hand=hand, place=place, radius=RADII[level], least=least, most=most, lasting=_LASTING)
            for hand, place in places
        ),
        force_limit=FORCE_LIMIT,
        marking=marking(level, expert_time=28.0),
        pass_source=PASS_SOURCE,
    )
