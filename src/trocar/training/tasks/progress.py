"""How far an attempt has come, tick by tick: the step that is on, what to do now, and the mistakes so far."""

from __future__ import annotations

from dataclasses import dataclass

from trocar.contact.instrument import NAMES
from trocar.training.tasks.moment import Moment
from trocar.training.tasks.step import Step
from trocar.training.tasks.task import Task

TOO_MUCH = "used too much force"
_AGAIN = 0.5  # [s] a mistake that stops for less goes on
LAPSE = 0.2  # [s] a step that is not met for less is still kept up, and what is wrong for less is no mistake of a step:
# everybody's hand trembles. Too much force counts at once.
_GAP = 0.01  # [s] of no mistake ends one that has not counted yet


@dataclass(frozen=True, kw_only=True)
class Mistake:
    """One mistake.

    Attributes:
        time: when it began [s].
        step: number of the step that was on.
        words: what it was.
    """

    time: float
    step: int
    words: str


@dataclass
class _Wrong:
    """Something that is wrong, or was a moment ago: since when and until when [s], and whether it counted."""

    begin: float
    last: float
    counted: bool = False


class Progress:
    """Follow an attempt.

    Args:
        task: what is attempted.
    """

    def __init__(self, task: Task) -> None:
        self.task = task
        self.number = 0
        """Of the step that is on, from 0; as many as there are when all is done."""
        self.mistakes: list[Mistake] = []
        self.ended: list[float] = []
        """When each step that is done ended [s], in order."""
        self._met_since: float | None = None
        self._met_last = 0.0
        self._begins = (
            True  # a step: what was right for the last one is no mistake in this, until it has ended
        )
        self._wrong: dict[str, _Wrong] = {}
        self._last: Moment | None = None

    @property
    def done(self) -> bool:
        """Whether every step is."""
        return self.number == len(self.task.steps)

    @property
    def step(self) -> Step | None:
        """The step that is on."""
        return None if self.done else self.task.steps[self.number]

    @property
    def now(self) -> str:
        """What would bring the step nearer."""
        if self.step is None or self._last is None:
            return ""
        for hand in self.step.hands:
            if self._last.strayed(hand):
                return f"Take the {NAMES[hand]} tip out of the tissue first."
        return self.step.hint(self._last)

    def advance(self, moment: Moment) -> None:
        """Take the next tick; times must rise."""
        step = self.step
        if step is None:
            return
        too_much = max(moment.force(0), moment.force(1)) > self.task.force_limit
        self._last = moment
        self._note(moment.time, TOO_MUCH if too_much else "")
        self._note(moment.time, step.mistake(moment), after=LAPSE, counts=not self._begins)
        self._begins = False
        if not step.met(moment):
            if moment.time - self._met_last > LAPSE:
                self._met_since = None
            return
        self._met_last = moment.time
        if self._met_since is None:
            self._met_since = moment.time
        if moment.time - self._met_since >= step.lasting:
            self.number += 1
            self.ended.append(moment.time)
            self._met_since = None
            self._begins = True

    def _note(self, time: float, words: str, *, after: float = 0.0, counts: bool = True) -> None:
        """Take what is wrong now, if anything is: it counts once it has lasted so long [s]."""
        if not words:
            return
        wrong = self._wrong.get(words)
        if wrong is None or time - wrong.last >= _AGAIN or not (wrong.counted or time - wrong.last < _GAP):
            wrong = self._wrong[words] = _Wrong(begin=time, last=time)
        wrong.last = time
        if not counts:
            wrong.counted = True
        elif not wrong.counted and time - wrong.begin >= after:
            wrong.counted = True
            self.mistakes.append(Mistake(time=wrong.begin, step=self.number, words=words))
