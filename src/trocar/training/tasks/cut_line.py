"""Cut along the line: scissors on a sheet in a frame, along a line drawn on it."""

from __future__ import annotations

from math import atan2, cos, pi, sin

from trocar.training.line import Line, Place
from trocar.training.score import Marking
from trocar.training.tasks.bands import PASS_SOURCE, RADII, marking
from trocar.training.tasks.cut import Cut
from trocar.training.tasks.task import Task
from trocar.waves.sheet.sheet import Sheet

_HAND = 1  # has the scissors
_FORCE_LIMIT = 0.05  # [N]; a dent that deep stretches the sheet by as much again as it is
_MIDDLE = (0.03, 0.03)  # x, y [m]
_TOWARDS = (-0.08, 0.04)  # from the right port, seen from above: where its blades point
_HALF = 0.016  # [m] of the line, along that
_SWINGS = {1: 0.0, 2: 0.0025, 3: 0.0018}  # [m] to either side of straight, by level
_WAVES = {1: 0.5, 2: 0.5, 3: 1.0}  # half a wave is an arc, a whole one an S
_POINTS = 129  # a quarter of a millimetre from each other
_PER_METRE = 1e4  # [s/m]: a millimetre beside the line, on average, costs what a mistake does


def cut_line(level: int) -> Task:
    """Return it at a level."""
    line = Line(points=_points(level), width=0.5 * RADII[level])
    plain = marking(level, expert_time=23.0)
    return Task(
        name="cut-along-the-line",
        title="Cut along the line",
        level=level,
        purpose="Set blades of a fixed direction to a line, bite by bite, on a sheet that gives way and gapes.",
        tissue="silicone-sheet",
        ports="scissors",
        steps=tuple(Cut(hand=_HAND, line=line, to=number, most=_FORCE_LIMIT) for number in range(_POINTS)),
        force_limit=_FORCE_LIMIT,
        marking=Marking(
            cutoff=plain.cutoff,
            expert_time=plain.expert_time,
            pass_score=plain.pass_score,
            per_metre_off=_PER_METRE,
        ),
        pass_source=PASS_SOURCE,
        sheet=Sheet(),
    )


def _points(level: int) -> tuple[Place, ...]:
    """Return the line from the scissors' side to the other."""
    angle = atan2(_TOWARDS[1], _TOWARDS[0])
    found = []
    for number in range(_POINTS):
        share = number / (_POINTS - 1)
        along = _HALF * (2 * share - 1)
        aside = _SWINGS[level] * sin(2 * pi * _WAVES[level] * share)
        x = _MIDDLE[0] + along * cos(angle) - aside * sin(angle)
        y = _MIDDLE[1] + along * sin(angle) + aside * cos(angle)
        found.append((x, y))
    return tuple(found)
