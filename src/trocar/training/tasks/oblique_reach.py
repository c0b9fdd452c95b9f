"""Oblique reach: the same as palpating, through ports so low that the shafts lie flat over the tissue."""

from __future__ import annotations

from trocar.training.tasks.bands import BANDS, FORCE_LIMIT, PASS_SOURCE, RADII, marking
from trocar.training.tasks.step import Press
from trocar.training.tasks.task import Task

_PLACES = (
    (1, (0.040, 0.032)),
    (0, (0.020, 0.032)),
    (1, (0.036, 0.042)),
    (0, (0.024, 0.042)),
    (1, (0.042, 0.024)),
    (0, (0.018, 0.024)),
)  # hand, x and y [m]
_LASTING = 2.0  # [s]


def oblique_reach(level: int) -> Task:
    """Return it at a level."""
    least, most = BANDS[level]
    return Task(
        name="oblique-reach",
        title="Reach at an angle",
        level=level,
        purpose="Press straight down with a shaft that comes from the side.",
        tissue="skin",
        ports="oblique",
        steps=tuple(
            Press(hand=hand, place=place, radius=RADII[level], least=least, most=most, lasting=_LASTING)
            for hand, place in _PLACES
        ),
        force_limit=FORCE_LIMIT,
        marking=marking(level, expert_time=23.0),
        pass_source=PASS_SOURCE,
    )
