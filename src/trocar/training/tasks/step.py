"""Steps of a task: each says what to do, where, when it is done and what is wrong meanwhile.

A step keeps nothing from one tick to the next; what has to last is counted by `progress`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from trocar.contact.instrument import NAMES
from trocar.training.tasks.moment import Moment

SHUT = 0.15  # of a jaw that has closed and would have taken hold before
_TAKEN = 0.3  # of the most force: pressed with less, the tissue is gone before a jaw has closed
Place = tuple[float, float]
Band = tuple[float, float]


@dataclass(frozen=True, kw_only=True)
class Mark:
    """Something to be drawn on the tissue.

    Attributes:
        place: x, y [m].
        radius: [m].
        hand: whose it is, 0 left or 1 right.
        hidden: whether it must be found: it is not drawn before the attempt is over.
    """

    place: Place
    radius: float
    hand: int
    hidden: bool = False


class Step(Protocol):
    """One thing to do."""

    @property
    def hands(self) -> tuple[int, ...]:
        """Which hands it asks for, the one it asks most of first."""
        ...

    @property
    def lasting(self) -> float:
        """How long it must be kept up [s]; lapses of `progress.LAPSE` are forgiven."""
        ...

    @property
    def words(self) -> str:
        """What to do."""
        ...

    @property
    def marks(self) -> tuple[Mark, ...]:
        """Where."""
        ...

    def band(self, hand: int) -> Band | None:
        """Return the least and the most force it asks of a hand [N]; None where it asks for none."""
        ...

    def met(self, moment: Moment) -> bool:
        """Return whether it is as it should be."""
        ...

    def hint(self, moment: Moment) -> str:
        """Return what would bring it nearer, or nothing."""
        ...

    def mistake(self, moment: Moment) -> str:
        """Return what is wrong, or nothing; each time it begins it counts once."""
        ...


@dataclass(frozen=True, kw_only=True)
class Press:
    """Press a marked place with a force between two limits.

    Attributes:
        hand: 0 left, 1 right.
        place: x, y [m].
        radius: of the mark [m].
        least, most: of the force [N].
        lasting: [s].
    """

    hand: int
    place: Place
    radius: float
    least: float
    most: float
    lasting: float

    @property
    def hands(self) -> tuple[int, ...]:
        """The pressing one."""
        return (self.hand,)

    @property
    def words(self) -> str:
        """What to do."""
        during = f" for {self.lasting:g} s" if self.lasting > 0 else ""
        return (
            f"With the {NAMES[self.hand]} hand press the marked place{during}, "
            f"between {self.least:.2g} and {self.most:.2g} N."
        )

    @property
    def marks(self) -> tuple[Mark, ...]:
        """The place."""
        return (Mark(place=self.place, radius=self.radius, hand=self.hand),)

    def band(self, hand: int) -> Band | None:
        """Return the least and the most force it asks of a hand [N]."""
        return (self.least, self.most) if hand == self.hand else None

    def met(self, moment: Moment) -> bool:
        """Return whether the tip presses there, neither too softly nor too hard."""
        return (
            moment.away(self.hand, self.place) <= self.radius
            and self.least <= moment.force(self.hand) <= self.most
        )

    def hint(self, moment: Moment) -> str:
        """Return which way to go."""
        if moment.away(self.hand, self.place) > self.radius:
            return "Go to the mark."
        force = moment.force(self.hand)
        if force < self.least:
            return "A little harder." if moment.touches(self.hand) else "Down, until it touches."
        return "Softer." if force > self.most else "Hold it so."

    def mistake(self, moment: Moment) -> str:
        """Return whether the tip presses beside its mark."""
        beside = moment.away(self.hand, self.place) > 2 * self.radius
        return "pressed beside the mark" if beside and moment.force(self.hand) > self.least else ""


@dataclass(frozen=True, kw_only=True)
class Follow:
    """Go along a curve to one of its points, touching the tissue all the way.

    Attributes:
        hand: 0 left, 1 right.
        curve: places x, y one after the other [m], closer to each other than the width.
        to: number of the point to reach.
        width: how near its points must be passed; twice as far beside the curve is a mistake [m].
        least, most: of the force [N].
    """

    hand: int
    curve: tuple[Place, ...]
    to: int
    width: float
    least: float
    most: float
    lasting: float = 0.0

    @property
    def hands(self) -> tuple[int, ...]:
        """The one that goes."""
        return (self.hand,)

    @property
    def words(self) -> str:
        """What to do."""
        return (
            f"With the {NAMES[self.hand]} hand follow the line to its end, "
            f"touching it with less than {self.most:.2g} N."
        )

    @property
    def marks(self) -> tuple[Mark, ...]:
        """The rest of the curve."""
        return tuple(Mark(place=place, radius=self.width, hand=self.hand) for place in self.curve[self.to :])

    def band(self, hand: int) -> Band | None:
        """Return the least and the most force it asks of a hand [N]."""
        return (self.least, self.most) if hand == self.hand else None

    def met(self, moment: Moment) -> bool:
        """Return whether the point is reached, by a tip that touches."""
        near = moment.away(self.hand, self.curve[self.to]) <= self.width
        return near and self.least <= moment.force(self.hand) <= self.most

    def hint(self, moment: Moment) -> str:
        """Return which way to go."""
        if moment.force(self.hand) < self.least:
            return "Touch the line." if self.to == 0 else "Keep touching it."
        return "Softer." if moment.force(self.hand) > self.most else "On along the line."

    def mistake(self, moment: Moment) -> str:
        """Return whether the tip left the curve or the tissue on the way."""
        if self.to == 0:
            return ""
        if not moment.touches(self.hand):
            return "lifted off the line"
        x, y, _ = moment.tip(self.hand)
        beside = np.hypot(*(np.array(self.curve) - (x, y)).T).min() > 2 * self.width
        if beside:
            return "left the line"
        return "pressed too hard on the line" if moment.force(self.hand) > self.most else ""


@dataclass(frozen=True, kw_only=True)
class Together:
    """Do a step with one hand while the other presses a place.

    Attributes:
        base: what the other hand keeps up.
        step: what is done meanwhile.
    """

    base: Press
    step: Press

    @property
    def hands(self) -> tuple[int, ...]:
        """The working one first."""
        return (self.step.hand, self.base.hand)

    @property
    def lasting(self) -> float:
        """As long as the step [s]."""
        return self.step.lasting

    @property
    def words(self) -> str:
        """What to do."""
        return f"Hold the tissue down with the {NAMES[self.base.hand]} hand. {self.step.words}"

    @property
    def marks(self) -> tuple[Mark, ...]:
        """Both."""
        return self.base.marks + self.step.marks

    def band(self, hand: int) -> Band | None:
        """Return the least and the most force it asks of a hand [N]."""
        return self.step.band(hand) or self.base.band(hand)

    def met(self, moment: Moment) -> bool:
        """Return whether both hands do theirs."""
        return self.base.met(moment) and self.step.met(moment)

    def hint(self, moment: Moment) -> str:
        """Return what the hand that is not there yet should do."""
        hand, part = (self.step.hand, self.step) if self.base.met(moment) else (self.base.hand, self.base)
        return f"{NAMES[hand].capitalize()}: {part.hint(moment)}"

    def mistake(self, moment: Moment) -> str:
        """Return whether the working hand presses while the other has let go, or beside its mark."""
        if moment.force(self.step.hand) > self.step.least and not moment.touches(self.base.hand):
            return "worked on tissue that was not held down"
        return self.step.mistake(moment)


@dataclass(frozen=True, kw_only=True)
class Lift:
    """Take hold of the tissue at a place and raise it.

    Attributes:
        hand: 0 left, 1 right.
        place: x, y [m].
        radius: of the mark [m].
        height: of the tip above the surface at rest [m].
        most: of the force [N].
        lasting: [s].
    """

    hand: int
    place: Place
    radius: float
    height: float
    most: float
    lasting: float

    @property
    def hands(self) -> tuple[int, ...]:
        """The holding one."""
        return (self.hand,)

    @property
    def words(self) -> str:
        """What to do."""
        return (
            f"With the {NAMES[self.hand]} hand take hold of the tissue at the mark, "
            f"raise it by {1e3 * self.height:g} mm and hold it for {self.lasting:g} s, "
            f"with less than {self.most:.2g} N."
        )

    @property
    def marks(self) -> tuple[Mark, ...]:
        """The place."""
        return (Mark(place=self.place, radius=self.radius, hand=self.hand),)

    def band(self, hand: int) -> Band | None:
        """Return the least and the most force it asks of a hand [N]."""
        return (0.0, self.most) if hand == self.hand else None

    def met(self, moment: Moment) -> bool:
        """Return whether the tissue is held at the mark, high enough and not too hard."""
        there = moment.holds(self.hand) and moment.away(self.hand, self.place) <= 2 * self.radius
        high = float(moment.tip(self.hand)[2]) >= self.height
        return there and high and moment.force(self.hand) <= self.most

    def hint(self, moment: Moment) -> str:
        """Return what is next."""
        if not moment.holds(self.hand):
            if moment.away(self.hand, self.place) > self.radius:
                return "Go to the mark, jaw open."
            if moment.jaw(self.hand) < SHUT:
                return "Open the jaw again: it closed on nothing."
            pressed = moment.force(self.hand) > _TAKEN * self.most
            return "Close the jaw on it." if pressed else "Press lightly, jaw open."
        if float(moment.tip(self.hand)[2]) < self.height:
            return "Raise it, straight up."
        return "Hold it so." if moment.force(self.hand) <= self.most else "Softer: not quite so high."

    def mistake(self, moment: Moment) -> str:
        """Return whether the tissue is held elsewhere."""
        elsewhere = moment.holds(self.hand) and moment.away(self.hand, self.place) > 2 * self.radius
        return "took hold beside the mark" if elsewhere else ""


@dataclass(frozen=True, kw_only=True)
class LetGo:
    """Take a hand out of the tissue.

    Attributes:
        hand: 0 left, 1 right.
    """

    hand: int
    lasting: float = 0.0

    @property
    def hands(self) -> tuple[int, ...]:
        """The one that leaves."""
        return (self.hand,)

    @property
    def words(self) -> str:
        """What to do."""
        return f"Open the {NAMES[self.hand]} jaw and leave the tissue."

    @property
    def marks(self) -> tuple[Mark, ...]:
        """None."""
        return ()

    def band(self, hand: int) -> Band | None:
        """Return nothing: it asks for no force."""
        return None

    def met(self, moment: Moment) -> bool:
        """Return whether the tip is free."""
        return not moment.touches(self.hand) and not moment.holds(self.hand)

    def hint(self, moment: Moment) -> str:
        """Return what is next."""
        return "Open the jaw." if moment.holds(self.hand) else "Up."

    def mistake(self, moment: Moment) -> str:
        """Return nothing: there is nothing to do wrong."""
        return ""
