"""Find the nodule: feel for a lump in a training pad, and take hold of what lies over it."""

from __future__ import annotations

from trocar.tissues.nodule import Nodule
from trocar.training.tasks.bands import PASS_SOURCE, marking
from trocar.training.tasks.find import Find
from trocar.training.tasks.task import Task

_HAND = 0  # has the grasper
_FORCE_LIMIT = 0.05  # [N]; the pad under a 5 mm instrument is linear up to 0.052 N
_WITHIN = ((0.015, 0.018), (0.045, 0.042))  # [m] two corners
_PLACES = {1: (0.0245, 0.034), 2: (0.038, 0.025), 3: (0.031, 0.0385)}  # x, y [m] by level
_RADII = {1: 5e-3, 2: 4.5e-3, 3: 4e-3}  # [m] of the nodule, by level, and how near it must be held
_DEPTH = 8e-3  # [m] of its middle
_YOUNG_MODULUS = 3e5  # [Pa]: fifty times the pad's body, as hard rubber cast into it
_LASTING = 1.0  # [s]


def find_nodule(level: int) -> Task:
    """Return it at a level."""
    x, y = _PLACES[level]
    radius = _RADII[level]
    return Task(
        name="find-nodule",
        title="Find the nodule",
        level=level,
        purpose="Feel a difference in stiffness through a 30 cm lever, and remember where it was.",
        tissue="silicone-pad",
        ports="usual",
        steps=(
            Find(
                hand=_HAND, place=(x, y), radius=radius, within=_WITHIN, most=_FORCE_LIMIT, lasting=_LASTING
            ),
        ),
        force_limit=_FORCE_LIMIT,
        marking=marking(level, expert_time=51.0),
        pass_source=PASS_SOURCE,
        nodules=(Nodule(x=x, y=y, depth=_DEPTH, radius=radius, young_modulus=_YOUNG_MODULUS),),
    )
