"""What trainees are asked about the trainer: face validity, in items to agree or disagree with.

Answers run from 1, disagree, to 5, agree (Likert 1932, Archives of Psychology 140). The wording is ours and has not
been validated; it must not change under an item's name, or answers of different years would not be answers to one
question.
"""

from __future__ import annotations

from collections.abc import Mapping

from trocar.errors import InputError

SCALE: Mapping[int, str] = {
    1: "disagree",
    2: "rather disagree",
    3: "neither",
    4: "rather agree",
    5: "agree",
}

GROUPS = ("novice", "resident", "expert")

ITEMS: Mapping[str, str] = {
    "tissue-looks": "The tissue looks and moves as I would expect of real tissue.",
    "force-feel": "What the instruments feel or show of force fits what they do to the tissue.",
    "instrument-motion": "The instruments move about their ports as they do in an operation.",
    "picture": "The picture lets me judge where the tips are, also in depth.",
    "tasks-useful": "The tasks train what I need in an operation.",
    "guidance-clear": "At every moment I knew what to do next.",
    "score-fair": "The score was a fair judgement of what I did.",
    "would-use": "I would use this trainer for my own training.",
}


def check_answers(group: str, values: Mapping[str, int]) -> None:
    """Refuse answers to what was not asked.

    Raises:
        InputError: there is no such group or item, an answer is off the scale, or there is none at all.
    """
    if group not in GROUPS:
        raise InputError("answers: group", " or ".join(GROUPS), group)
    if not values:
        raise InputError("answers", "at least one item", "none")
    for item, value in values.items():
        if item not in ITEMS:
            raise InputError("answers: item", f"one of {', '.join(ITEMS)}", item)
        if type(value) is not int or value not in SCALE:
            raise InputError(f"answers: {item}", "a whole number from 1, disagree, to 5, agree", value)
