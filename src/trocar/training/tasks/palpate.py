"""Palpate: press marked points within a force band and hold, one hand after the other."""

from __future__ import annotations

from trocar.training.tasks.bands import BANDS, FORCE_LIMIT, PASS_SOURCE, RADII, marking
from trocar.training.tasks.step import Press
from trocar.training.tasks.task import Task

_PLACES = (
    (1, (0.042, 0.030)),
    (1, (0.036, 0.040)),
    (1, (0.044, 0.022)),
    (0, (0.018, 0.030)),
    (0, (0.024, 0.040)),
    (0, (0.016, 0.022)),
)  # hand, x and y [m]
_LASTING = 2.0  # [s]


def palpate(level: int) -> Task:
    """Return it at a level."""
    least, most = BANDS[level]
    return Task(
        name="palpate",
        title="Palpate six points",
        level=level,
        purpose="Feel how hard you press through a 30 cm lever, and keep to it.",
        tissue="skin",
        ports="usual",
        steps=tuple(
            Press(hand=hand, place=place, radius=RADII[level], least=least, most=most, lasting=_LASTING)
            for hand, place in _PLACES
        ),
        force_limit=FORCE_LIMIT,
        marking=marking(level, expert_time=24.0),
        pass_source=PASS_SOURCE,
    )
