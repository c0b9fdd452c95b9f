"""What the simulated hands can do: scripts of presses, slides and lifts on a block of any size.

Places are shares of the block's sides, so that a script fits every block: the left hand works between 0.25 and 0.45 of
the width, the right one between 0.55 and 0.75, and the tips never meet. Depths are parts of the deepest press, which is
1.5 mm unless told otherwise: on the preset `skin` presses of 0.5, 1 and 1.5 mm.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from math import fsum, isfinite
from types import MappingProxyType

from trocar.contact.instrument import Instrument, Vector
from trocar.devices.motion import Path, Waypoint
from trocar.errors import InputError

USUAL_DEPTH, MOST_DEPTH = 1.5e-3, 5e-3  # [m]
LIFT = 3e-3  # [m] from where the tissue is gripped

_HOVER = 2e-3  # [m] above the tissue, between two actions
_ASIDE, _ALONG = 0.2, 0.15  # share of the block that a slide covers, along x and along y
_TURN = 0.5  # [rad] of roll while the tip slides

Place = tuple[float, float]


@dataclass(frozen=True, kw_only=True, slots=True)
class Script:
    """What both hands do.

    Args:
        name: what it is called.
        description: what happens, in a few words.
        write: takes the left and the right hand and puts their waypoints.
    """

    name: str
    description: str
    write: Callable[[Hand, Hand], None]

    def paths(
        self,
        instruments: tuple[Instrument, Instrument],
        size: tuple[float, float],
        depth: float = USUAL_DEPTH,
    ) -> tuple[Path, Path]:
        """Return the paths of both tips, equally long; each begins and ends where its instrument starts.

        Args:
            instruments: left and right.
            size: sides of the block along x and y [m].
            depth: of the deepest press [m].

        Raises:
            InputError: the depth or the size is not possible, or an instrument does not reach its places.
        """
        if not (isfinite(depth) and 0 < depth <= MOST_DEPTH):
            raise InputError("script: depth", f"a length above 0 and at most {MOST_DEPTH:g} m", depth)
        if not all(isfinite(side) and side > 0 for side in size):
            raise InputError("script: size", "two lengths above 0 m", size)
        hands = [Hand(instrument, size, depth) for instrument in instruments]
        self.write(hands[0], hands[1])
        longest = max(hand.busy for hand in hands)
        for hand in hands:
            hand.wait(longest - hand.busy)
        left, right = (hand.path() for hand in hands)
        return left, right


class Hand:
    """Puts one hand's waypoints one after the other."""

    def __init__(self, instrument: Instrument, size: tuple[float, float], depth: float) -> None:
        self._instrument, self._size, self._depth = instrument, size, depth
        self._waypoints = [Waypoint(after=0.0, tip=instrument.reach_of(instrument.handle).tip)]

    @property
    def busy(self) -> float:
        """Time until the last waypoint [s]."""
        return fsum(waypoint.after for waypoint in self._waypoints)

    def path(self) -> Path:
        """Return what has been put so far, if the instrument reaches all of it."""
        for waypoint in self._waypoints:
            self._instrument.handle_for(waypoint.tip)
        return Path(tuple(self._waypoints))

    def wait(self, seconds: float) -> None:
        """Stay."""
        if seconds > 0:
            self._put(seconds)

    def press(self, place: Place, share: float) -> None:
        """Press in to a share of the depth, hold, and let up."""
        self._put(0.8, self._above(place, _HOVER))
        self._put(1.2, self._above(place, -share * self._depth))
        self._put(1.0)
        self._put(0.8, self._above(place, _HOVER))

    def slide(self, place: Place, other: Place, share: float) -> None:
        """Press in to a share of the depth, slide to another place and back while the tip turns, and let up."""
        deep = -share * self._depth
        self._put(0.8, self._above(place, _HOVER))
        self._put(1.0, self._above(place, deep))
        self._put(2.0, self._above(other, deep), roll=_TURN)
        self._put(0.3)
        self._put(2.0, self._above(place, deep), roll=0.0)
        self._put(0.8, self._above(place, _HOVER))

    def lift(self, place: Place, share: float) -> None:
        """Close the jaw on lightly pressed tissue, raise it, hold it there and let go."""
        deep = -share * self._depth
        self._put(0.8, self._above(place, _HOVER), jaw=1.0)
        self._put(1.0, self._above(place, deep))
        self._put(0.6, jaw=0.0)
        self._put(1.5, self._above(place, deep + LIFT))
        self._put(1.0)
        self._put(0.4, jaw=1.0)
        self._put(0.6)
        self._put(0.8, self._above(place, deep + LIFT + _HOVER))

    def go_home(self) -> None:
        """Return to the start."""
        self._put(1.0, self._waypoints[0].tip)

    def _above(self, place: Place, height: float) -> Vector:
        return place[0] * self._size[0], place[1] * self._size[1], height

    def _put(
        self, after: float, tip: Vector | None = None, roll: float | None = None, jaw: float | None = None
    ) -> None:
        last = self._waypoints[-1]
        self._waypoints.append(
            replace(
                last,
                after=after,
                tip=last.tip if tip is None else tip,
                roll=last.roll if roll is None else roll,
                jaw=last.jaw if jaw is None else jaw,
            )
        )


def _press(left: Hand, right: Hand) -> None:
    right.wait(0.5)
    for share in (1 / 3, 2 / 3, 1.0):
        right.press((0.65, 0.5), share)
    left.wait(2.5)
    for share in (1 / 3, 2 / 3):
        left.press((0.35, 0.5), share)
    left.go_home()
    right.go_home()


def _slide(left: Hand, right: Hand) -> None:
    right.wait(0.5)
    right.slide((0.55, 0.55), (0.55 + _ASIDE, 0.55), 2 / 3)
    right.slide((0.65, 0.5), (0.65, 0.5 + _ALONG), 1 / 3)
    left.wait(2.0)
    left.slide((0.45, 0.45), (0.45 - _ASIDE, 0.45), 1 / 3)
    left.go_home()
    right.go_home()


def _lift(left: Hand, right: Hand) -> None:
    left.wait(0.5)
    left.lift((0.35, 0.5), 1 / 3)
    left.lift((0.4, 0.6), 1 / 3)
    right.wait(3.0)
    right.press((0.65, 0.5), 1 / 3)
    left.go_home()
    right.go_home()


def _press_slide_lift(left: Hand, right: Hand) -> None:
    right.wait(0.5)
    right.press((0.65, 0.5), 2 / 3)
    right.press((0.65, 0.5), 1.0)
    right.slide((0.55, 0.55), (0.55 + _ASIDE, 0.55), 2 / 3)
    right.slide((0.65, 0.5), (0.65, 0.5 + _ALONG), 1 / 3)
    left.wait(2.0)
    left.press((0.35, 0.5), 2 / 3)
    left.slide((0.45, 0.45), (0.45 - _ASIDE, 0.45), 1 / 3)
    left.press((0.4, 0.6), 1 / 3)
    left.lift((0.35, 0.5), 1 / 3)
    left.go_home()
    left.wait(0.8)
    right.go_home()


SCRIPTS: Mapping[str, Script] = MappingProxyType(
    {
        script.name: script
        for script in (
            Script(name="press", description="both hands press, deeper each time", write=_press),
            Script(name="slide", description="both hands slide over the tissue and back", write=_slide),
            Script(
                name="lift", description="the left hand grips and lifts, the right one presses", write=_lift
            ),
            Script(
                name="press-slide-lift",
                description="both hands press and slide, then the left one lifts",
                write=_press_slide_lift,
            ),
        )
    }
)
"""Every script by its name."""
