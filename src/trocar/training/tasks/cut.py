"""A step of scissors: cut past one point of a line, within a band to either side of it."""

from __future__ import annotations

from dataclasses import dataclass
from math import dist

from trocar.contact.instrument import NAMES
from trocar.training.line import Line
from trocar.training.tasks.moment import Moment
from trocar.training.tasks.step import Band, Mark, Place

BITE = 1.0e-3  # [m] along a line from where a cut ends to where the tip is set for the next snip
_NEAR = 4e-4  # [m] from there
_REACH = 4e-3  # [m] from there: farther off, it goes through the air


@dataclass(frozen=True, kw_only=True)
class Cut:
    """Cut past one point of a line.

    Attributes:
        hand: with the scissors, 0 left or 1 right.
        line: to be cut along; a cut outside its width is a mistake.
        to: number of the point.
        most: of the force [N].
    """

    hand: int
    line: Line
    to: int
    most: float
    lasting: float = 0.0

    @property
    def hands(self) -> tuple[int, ...]:
        """The one with the scissors."""
        return (self.hand,)

    @property
    def words(self) -> str:
        """What to do."""
        return (
            f"With the scissors in the {NAMES[self.hand]} hand cut along the line to its end, within "
            f"{1e3 * self.line.width:g} mm to either side and with less than {self.most:.2g} N: touch the sheet on the "
            "line, blades open, close them, open them, go on by a blade's bite."
        )

    @property
    def marks(self) -> tuple[Mark, ...]:
        """What is left of the line."""
        return tuple(
            Mark(place=place, radius=self.line.width, hand=self.hand) for place in self.line.points[self.to :]
        )

    def band(self, hand: int) -> Band | None:
        """Return the least and the most force it asks of a hand [N]; of either it asks to be gentle."""
        return (0.0, self.most)

    def met(self, moment: Moment) -> bool:
        """Return whether the last snip went by the point."""
        snip = moment.snip(self.hand)
        return snip is not None and self.line.passes(snip, self.to)

    @property
    def ahead(self) -> Place:
        """Where the tip goes next: a bite on from the point, or the line's end."""
        points = self.line.points
        ahead = (place for place in points[self.to :] if dist(place, points[self.to]) >= BITE)
        return next(ahead, points[-1])

    def hint(self, moment: Moment) -> str:
        """Return what is next."""
        if not moment.opened(self.hand):
            return "Open the blades."
        away = moment.away(self.hand, self.ahead)
        if away > _REACH:
            return "Go to where the cut ends, blades open."
        if moment.force(self.hand) > self.most:
            return "Softer."
        if away > _NEAR:
            return "On along the line, by a bite."
        return "Close the blades." if moment.touches(self.hand) else "Down, until it touches."

    def mistake(self, moment: Moment) -> str:
        """Return whether the last snip went off the line."""
        snip = moment.snip(self.hand)
        off = snip is not None and self.line.farthest(snip) > self.line.width
        return "cut beside the line" if off else ""
