"""An attempt in stages: its steps, those along one line taken together, and the force each hand is asked for."""

from __future__ import annotations

from dataclasses import dataclass

from trocar.contact.instrument import NAMES
from trocar.training.metrics.attempt import Attempt
from trocar.training.tasks.cut import Cut
from trocar.training.tasks.find import Find
from trocar.training.tasks.progress import Progress
from trocar.training.tasks.step import Follow, LetGo, Lift, Press, Step, Together
from trocar.training.tasks.task import Task


@dataclass(frozen=True, kw_only=True)
class Stretch:
    """One or more steps that are one thing to do.

    Attributes:
        number: from 1.
        steps: which they are, from 0.
        step: the last of them.
        begin, end: when it was on [s].
        done: whether its last step was.
        words: what it is, in two or three words.
    """

    number: int
    steps: range
    step: Step
    begin: float
    end: float
    done: bool
    words: str


def stage_steps(task: Task) -> list[range]:
    """Return the numbers of the steps of each stage of a task, from 0."""
    found: list[range] = []
    steps, first = task.steps, 0
    for after in range(1, len(steps) + 1):
        if after == len(steps) or not _one_line(steps[first], steps[after]):
            found.append(range(first, after))
            first = after
    return found


def stages_of(attempt: Attempt, progress: Progress) -> list[Stretch]:
    """Return the stages that an attempt came to, in order; the last may not be done."""
    found: list[Stretch] = []
    ends, begin = progress.ended, 0.0
    for number, steps in enumerate(stage_steps(progress.task), 1):
        if steps.start > len(ends) or (found and not found[-1].done):
            break
        done = steps.stop <= len(ends)
        end = ends[steps.stop - 1] if done else float(attempt.times[-1])
        step = progress.task.steps[steps.stop - 1]
        found.append(
            Stretch(
                number=number, steps=steps, step=step, begin=begin, end=end, done=done, words=_words(step)
            )
        )
        begin = end
    return found


def _one_line(one: Step, other: Step) -> bool:
    if isinstance(one, Cut) and isinstance(other, Cut):
        return (one.line, one.hand) == (other.line, other.hand)
    return (
        isinstance(one, Follow)
        and isinstance(other, Follow)
        and (one.curve, one.hand) == (other.curve, other.hand)
    )


def hands_asked(progress: Progress) -> set[int]:
    """Return the hands that a task asks for."""
    return {hand for step in progress.task.steps for hand in step.hands}


def _words(step: Step) -> str:
    does = {
        Press: "press",
        Follow: "follow the line",
        Together: "hold and press",
        Lift: "lift",
        LetGo: "let go",
        Find: "find and hold",
        Cut: "cut along the line",
    }
    return f"{NAMES[step.hands[0]]}: {next((words for kind, words in does.items() if isinstance(step, kind)), 'do')}"
