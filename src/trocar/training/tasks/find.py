"""A step that hides what it asks for: feel for something under the surface, and take hold of the tissue over it."""

from __future__ import annotations

from dataclasses import dataclass

from trocar.contact.instrument import NAMES
from trocar.training.tasks.moment import Moment
from trocar.training.tasks.step import SHUT, Band, Mark, Place


@dataclass(frozen=True, kw_only=True)
class Find:
    """Feel for something under the surface, and take hold of the tissue over it.

    Attributes:
        hand: that takes hold, 0 left or 1 right; either may feel.
        place: of what is hidden, x, y [m].
        radius: how near it the tissue must be held [m].
        within: two corners of where it may be [m].
        most: of the force [N].
        lasting: [s].
    """

    hand: int
    place: Place
    radius: float
    within: tuple[Place, Place]
    most: float
    lasting: float

    @property
    def hands(self) -> tuple[int, ...]:
        """The one that takes hold first, then the other, which may feel too."""
        return (self.hand, 1 - self.hand)

    @property
    def words(self) -> str:
        """What to do."""
        return (
            "Somewhere a lump lies under the surface: over it less gives way. Press here and there to find it, then "
            f"with the {NAMES[self.hand]} hand take hold of the tissue above it for {self.lasting:g} s, "
            f"with less than {self.most:.2g} N."
        )

    @property
    def marks(self) -> tuple[Mark, ...]:
        """Where it is, hidden."""
        return (Mark(place=self.place, radius=self.radius, hand=self.hand, hidden=True),)

    def band(self, hand: int) -> Band | None:
        """Return the least and the most force it asks of a hand [N]; of either it asks to be gentle."""
        return (0.0, self.most)

    def met(self, moment: Moment) -> bool:
        """Return whether the tissue is held above it, gently."""
        there = moment.holds(self.hand) and moment.away(self.hand, self.place) <= self.radius
        return there and moment.force(self.hand) <= self.most

    def hint(self, moment: Moment) -> str:
        """Return what is next, and nothing of where it is."""
        if moment.holds(self.hand):
            if moment.away(self.hand, self.place) > self.radius:
                return "Nothing is here. Open the jaw, and feel on."
            return "Softer." if moment.force(self.hand) > self.most else "Hold it so."
        if moment.jaw(self.hand) < SHUT:
            return "Open the jaw again: it closed on nothing."
        return "Feel where less gives way, and close the jaw on it there."

    def mistake(self, moment: Moment) -> str:
        """Return whether the tissue is held where nothing is."""
        elsewhere = moment.holds(self.hand) and moment.away(self.hand, self.place) > self.radius
        return "took hold where nothing is" if elsewhere else ""
