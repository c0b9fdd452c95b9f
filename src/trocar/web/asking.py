"""What a step asks for, as the page shows it: words, marks on the tissue, bands on the bars of force."""

from __future__ import annotations

from typing import Any

from trocar.training.tasks.step import Step
from trocar.web.messages import TaskMark


def asking(step: Step | None, *, hidden: bool = False) -> dict[str, Any]:
    """Return the fields of `messages.Asked`; of no step, nothing is asked.

    Args:
        step: that is on.
        hidden: whether marks that must be found are shown as well.
    """
    if step is None:
        return {"words": "", "marks": (), "least_n": (0.0, 0.0), "most_n": (0.0, 0.0)}
    bands = [step.band(hand) or (0.0, 0.0) for hand in (0, 1)]
    return {
        "words": step.words,
        "marks": tuple(
            TaskMark(place_m=mark.place, radius_m=mark.radius, hand="left" if mark.hand == 0 else "right")
            for mark in step.marks
            if hidden or not mark.hidden
        ),
        "least_n": (bands[0][0], bands[1][0]),
        "most_n": (bands[0][1], bands[1][1]),
    }
