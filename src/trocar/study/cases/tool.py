"""One tool of a case: where it presses, with what tip, and how its force goes up, holds and comes down."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from math import cos, hypot, sin

from trocar.errors import InputError
from trocar.model import Press
from trocar.study.cases import quantity as q


class Tip(StrEnum):
    """The shape of a tool's end."""

    FLAT = "flat"
    SPHERE = "sphere"


class Contact(StrEnum):
    """How a tool's force comes to the tissue."""

    DEAD = "dead"  # spread evenly over the footprint, whatever the tissue does
    RIGID = "rigid"  # by a tip that keeps its shape


@dataclass(frozen=True, kw_only=True)
class Tool:
    """Describe a tool and its force.

    Args:
        diameter: of the tip [m].
        position: centre of the footprint on the top face (x, y) [m].
        peak: largest force along the tool's axis [N].
        rate: the force goes up at this rate and later down at it [N/s].
        hold: time at the peak [s].
        tilt: from the surface normal [rad].
        azimuth: of the tilt, from +x towards +y [rad].
        tip: shape of its end; a sphere has the tool's diameter, and is rigid.
        contact: how the force comes to the tissue; a rigid tip stands upright.

    Raises:
        InputError: a value is not finite, outside its range, or does not go with another, or the ramp is too short or
            too long to follow.
    """

    diameter: float
    position: tuple[float, float]
    peak: float
    rate: float
    hold: float = 0.0
    tilt: float = 0.0
    azimuth: float = 0.0
    tip: Tip = Tip.FLAT
    contact: Contact = Contact.DEAD

    def __post_init__(self) -> None:
        for item in q.TOOL:
            item.check(f"tool: {item.name}", getattr(self, item.name))
        for coordinate in self.position:
            q.POSITION.check("tool: position", coordinate)
        if self.tip is Tip.SPHERE and self.contact is Contact.DEAD:
            raise InputError(
                "tool: contact", '"rigid" for a sphere', self.contact.value, "a dead load has no shape"
            )
        if self.contact is Contact.RIGID and self.tilt > 0:
            advice = "an inclined tip is not built yet; take a dead load"
            raise InputError("tool: tilt", "0, upright, for a rigid tip", self.tilt / q.TILT.factor, advice)
        if not q.SHORTEST_RAMP <= self.ramp_time <= q.LONGEST_RAMP:
            raise InputError(
                "tool: rate",
                f"a rate that reaches the peak in {q.SHORTEST_RAMP:g} to {q.LONGEST_RAMP:g} s",
                self.rate,
                f"peak / rate is {self.ramp_time:g} s",
            )

    @property
    def ramp_time(self) -> float:
        """Time from no force to the peak [s]; coming down takes as long."""
        return self.peak / self.rate

    @property
    def duration(self) -> float:
        """Time from first touch to release [s]."""
        return self.corners()[-1]

    @property
    def half_extent(self) -> tuple[float, float]:
        """Half of the footprint's bounding box along x and y [m].

        An ellipse of semi-axes p along the azimuth, s across it reaches sqrt((p cos)^2 + (s sin)^2) along x.
        """
        across = self.diameter / 2
        along = across / cos(self.tilt)
        c, s = cos(self.azimuth), sin(self.azimuth)
        return hypot(along * c, across * s), hypot(along * s, across * c)

    def corners(self) -> tuple[float, float, float, float]:
        """Return the times the force changes its slope [s]: touch, peak reached, peak left, release."""
        up = self.ramp_time
        return 0.0, up, up + self.hold, up + self.hold + up

    def force(self, time: float) -> float:
        """Return the force along the axis [N] at `time` [s]; 0 before touch and after release."""
        start, up, down, end = self.corners()
        if not start < time < end:
            return 0.0
        if time < up:
            return min(self.peak, self.rate * time)
        if time <= down:
            return self.peak
        return min(self.peak, self.rate * (end - time))

    def press(self, force: float) -> Press:
        """Return the press of this tool with `force` [N]."""
        x, y = self.position
        return Press(x=x, y=y, radius=self.diameter / 2, force=force, tilt=self.tilt, azimuth=self.azimuth)
