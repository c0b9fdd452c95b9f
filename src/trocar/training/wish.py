"""What a step asks of one hand of a scripted trainee."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Wish:
    """A place, a force, and how high to hold what it holds.

    Attributes:
        place: x, y [m].
        force: to press with [N].
        aim: what the aim is renewed for.
        slide: whether the tip goes along the tissue.
        height: of the tip with tissue in the jaw [m]; None where nothing is taken hold of.
        snip: whether to close the blades there, and open them again.
    """

    place: tuple[float, float]
    force: float
    aim: object
    slide: bool = False
    height: float | None = None
    snip: bool = False
