"""What a task is: its place in training, the steps it asks for, and how it is marked."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby, pairwise
from math import dist

from trocar.contact.instrument import Instrument
from trocar.contact.port_sets import instruments_over
from trocar.errors import InputError
from trocar.simulation.live import LIVE_SIZE
from trocar.simulation.phantom import Phantom
from trocar.tissues.nodule import Nodule
from trocar.training.line import Line
from trocar.training.score import Marking
from trocar.training.tasks.cut import Cut
from trocar.training.tasks.step import Step
from trocar.waves.sheet.sheet import Sheet


@dataclass(frozen=True, kw_only=True)
class Task:
    """One task at one level.

    Attributes:
        name: short, as on the command line.
        title: as in a list.
        level: 1 is the easiest.
        purpose: what it trains.
        tissue: name of the preset it is done on.
        ports: name of the port set.
        steps: in order.
        force_limit: more than this on either tip is a mistake [N].
        marking: how it is marked.
        pass_source: where the pass mark comes from.
        nodules: in its tissue.
        sheet: it is done on, in the place of a preset; `tissue` only names it then.
        organ: likewise.
    """

    name: str
    title: str
    level: int
    purpose: str
    tissue: str
    ports: str
    steps: tuple[Step, ...]
    force_limit: float
    marking: Marking
    pass_source: str
    nodules: tuple[Nodule, ...] = ()
    sheet: Sheet | None = None
    organ: Phantom | None = None

    def __post_init__(self) -> None:
        if not self.steps:
            raise InputError(f"task {self.name}: steps", "at least one", "none")

    @property
    def instruments(self) -> tuple[Instrument, Instrument]:
        """Left and right, through the task's ports."""
        return instruments_over(self.ports, self.size, LIVE_SIZE)

    @property
    def size(self) -> tuple[float, float]:
        """Sides of the rectangle over which it is done [m]."""
        return LIVE_SIZE if self.organ is None else self.organ.size

    def as_dict(self) -> dict[str, object]:
        """Return it as JSON takes it; steps that ask for the same thing are one line of its list."""
        return {
            "name": self.name,
            "title": self.title,
            "level": self.level,
            "purpose": self.purpose,
            "tissue": self.tissue,
            "ports": self.ports,
            "steps": len(self.steps),
            "list": [
                {"words": words, "steps": len(list(alike))}
                for words, alike in groupby(self.steps, key=lambda step: step.words)
            ],
            "force_limit_n": self.force_limit,
            "cutoff_s": self.marking.cutoff,
            "expert_time_s": self.marking.expert_time,
            "pass_score": self.marking.pass_score,
            "pass_source": self.pass_source,
        }

    @property
    def line(self) -> Line | None:
        """What is to be cut along, if anything is."""
        return next((step.line for step in self.steps if isinstance(step, Cut)), None)

    @property
    def ideal_length(self) -> float:
        """Length of the straight ways from where the tips begin over all marks, both tips together [m]."""
        return sum(
            _length([instrument.reach_of(instrument.handle).tip[:2], *self._places(hand)])
            for hand, instrument in enumerate(self.instruments)
        )

    def _places(self, hand: int) -> list[tuple[float, float]]:
        first = ([mark.place for mark in step.marks if mark.hand == hand] for step in self.steps)
        return [places[0] for places in first if places]


def _length(places: Sequence[Sequence[float]]) -> float:
    return sum(dist(one, other) for one, other in pairwise(places))
