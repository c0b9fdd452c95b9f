"""Palpate an organ: press marked points of a dome within a force band and hold, along its normal wherever it slopes."""

from __future__ import annotations

from trocar.simulation.phantom import Phantom
from trocar.training.tasks.bands import BANDS, FORCE_LIMIT, PASS_SOURCE, RADII, marking
from trocar.training.tasks.step import Press
from trocar.training.tasks.task import Task
from trocar.waves.mesh.organ import Liver

PHANTOM = Phantom(
    name="liver-phantom",
    tissue="silicone-pad",
    layer="skin",
    shape=Liver(length=0.09, width=0.0675, height=0.0325),
    spacing=0.01,
)
_PLACES = (
    (1, (0.068, 0.028)),
    (0, (0.046, 0.028)),
    (1, (0.066, 0.038)),
    (0, (0.050, 0.020)),
    (1, (0.074, 0.022)),
    (0, (0.040, 0.030)),
)  # hand, x and y [m]: on the dome and on its slopes to either side
_LASTING = 2.0  # [s]


def palpate_organ(level: int) -> Task:
    """Return it at a level."""
    least, most = BANDS[level]
    return Task(
        name="palpate-organ",
        title="Palpate an organ",
        level=level,
        purpose="Feel how hard you press on what slopes and curves, where down is nowhere the same.",
        tissue=PHANTOM.name,
        ports="usual",
        steps=tuple(
            Press(hand=hand, place=place, radius=RADII[level], least=least, most=most, lasting=_LASTING)
            for hand, place in _PLACES
        ),
        force_limit=FORCE_LIMIT,
        marking=marking(level, expert_time=26.0),
        pass_source=PASS_SOURCE,
        organ=PHANTOM,
    )
