"""What levels ask for, the same in every task: force bands within skin's linear range, smaller marks, less time."""

from __future__ import annotations

from trocar.training.score import Marking

FORCE_LIMIT = (
    0.07  # [N]; skin under a 5 mm instrument is linear up to 0.071 N, the white mark on the trainer's bars
)
BANDS = {1: (0.015, 0.065), 2: (0.025, 0.06), 3: (0.03, 0.05)}  # [N] by level
RADII = {1: 4e-3, 2: 3e-3, 3: 2e-3}  # [m] of a mark, by level
ALLOWED = {1: 4.0, 2: 3.2, 3: 2.5}  # times the scripted expert's, by level
PASS_SCORE = 75.0
PASS_SOURCE = (
    "derived: a quarter of the time between the scripted expert's and the cut-off may be lost; no people have been "
    "measured yet"
)


def marking(level: int, expert_time: float) -> Marking:
    """Return how a task is marked at a level.

    Args:
        level: with its time allowed.
        expert_time: the scripted expert's [s].
    """
    return Marking(cutoff=ALLOWED[level] * expert_time, expert_time=expert_time, pass_score=PASS_SCORE)
