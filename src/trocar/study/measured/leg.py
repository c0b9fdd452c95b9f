"""Everything that is foretold of measured tissue, set by set; what is not there is left out and said."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from time import perf_counter

from trocar.study.measured.grades import Grade, compare_grades
from trocar.study.measured.indented import LimbResults, foretell_limbs
from trocar.study.measured.pressed import PhantomResults, foretell_phantoms
from trocar.study.measured.relaxed import ForetoldHolds, foretell_holds
from trocar.study.measured.sets import MeasuredSets
from trocar.study.measured.stretched import FittedRubber, foretell_rubber
from trocar.study.measured.torn import ForetoldStrip, foretell_strips

Watch = Callable[[str, float], None]
"""Told what is being done and the share of all done, 0 to 1."""


@dataclass(frozen=True, kw_only=True)
class MeasuredLeg:
    """The study's third leg.

    Args:
        sets: what was read.
        phantoms: silicone discs; None where there are none of which both specimens are there.
        grades: of silicone, pressed and pulled.
        limbs: indented in vivo, or None.
        strips: of a sow's tissues.
        holds: of beef, or None.
        rubber: laws on it; empty where there is none.
        seconds: it took, by the clock [s].
    """

    sets: MeasuredSets
    phantoms: PhantomResults | None
    grades: tuple[Grade, ...]
    limbs: LimbResults | None
    strips: tuple[ForetoldStrip, ...]
    holds: ForetoldHolds | None
    rubber: tuple[FittedRubber, ...]
    seconds: float


def run_leg(sets: MeasuredSets, watch: Watch = lambda _what, _share: None) -> MeasuredLeg:
    """Foretell whatever the sets hold.

    Raises:
        InputError: a set holds too little.
        SolverError: a disc could not be computed.
    """
    began = perf_counter()
    pressed = None
    if sets.phantoms:
        watch("silicone between platens", 0.0)
        pressed = foretell_phantoms(
            sets.phantoms, lambda share: watch("silicone between platens", 0.5 * share)
        )
    limbs = None
    if sets.limbs is not None:
        watch("limbs", 0.5)
        limbs = foretell_limbs(sets.limbs, lambda share: watch("limbs", 0.5 + 0.4 * share))
    watch("strips, holds and rubber", 0.9)
    found = MeasuredLeg(
        sets=sets,
        phantoms=pressed if pressed is not None and pressed.discs else None,
        grades=() if pressed is None else compare_grades(pressed, sets.pulls),
        limbs=limbs,
        strips=foretell_strips(sets.strips),
        holds=foretell_holds(sets.holds),
        rubber=() if sets.rubber is None else foretell_rubber(sets.rubber),
        seconds=perf_counter() - began,
    )
    watch("strips, holds and rubber", 1.0)
    return found
