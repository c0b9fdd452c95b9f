"""What the report says of measured tissue: its figures and tables, of the sets that are there."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from trocar.study.measured.leg import MeasuredLeg
from trocar.study.measured.stretched import FittedRubber
from trocar.study.report import measured_tables
from trocar.study.report.figures.courses import holds_alt, holds_figure, strips_alt, strips_figure
from trocar.study.report.figures.limbs import limbs_alt, limbs_figure
from trocar.study.report.figures.platens import growth_alt, growth_figure, platens_alt, platens_figure
from trocar.study.report.figures.rubber import rubber_alt, rubber_figure
from trocar.study.report.picture import Picture
from trocar.study.report.table import Table


@dataclass(frozen=True, kw_only=True)
class Part:
    """One set in the report.

    Attributes:
        title: a heading.
        lead: a paragraph under it.
        pictures: names of figures.
        tables: below them.
    """

    title: str
    lead: str
    pictures: tuple[str, ...]
    tables: tuple[Table, ...]


def measured_pictures(leg: MeasuredLeg) -> Mapping[str, Picture]:
    """Draw every figure of the sets that are there, by name."""
    drawn = []
    if leg.phantoms is not None:
        drawn += [
            Picture(
                name="measured-platens",
                alt=platens_alt(leg.phantoms),
                caption="Silicone discs, specimen B, of which nothing was fitted. Shaded: the compressions to which "
                "specimen A was fitted. A band goes from faces that slide to faces that are held (its line).",
                figure=platens_figure(leg.phantoms),
            ),
            Picture(
                name="measured-growth",
                alt=growth_alt(leg.phantoms),
                caption="How the error grows with compression: median of all compositions, and their range.",
                figure=growth_figure(leg.phantoms),
            ),
        ]
    if leg.limbs is not None:
        drawn.append(
            Picture(
                name="measured-limbs",
                alt=limbs_alt(leg.limbs),
                caption="Limbs of people that nothing was fitted to. Grey: within a quarter. Right: dashed, the error "
                "published for a two-spring model; dotted, half of it.",
                figure=limbs_figure(leg.limbs),
            )
        )
    if leg.strips:
        drawn.append(
            Picture(
                name="measured-strips",
                alt=strips_alt(leg.strips),
                caption="A sow's tissues in tension. What a law cannot know is which animal it is.",
                figure=strips_figure(leg.strips),
            )
        )
    if leg.holds is not None:
        drawn.append(
            Picture(
                name="measured-holds",
                alt=holds_alt(leg.holds),
                caption="Beef held after an indentation. The series was fitted to another day's tests.",
                figure=holds_figure(leg.holds),
            )
        )
    if leg.rubber and leg.sets.rubber is not None:
        best = _best(leg)
        drawn.append(
            Picture(
                name="measured-rubber",
                alt=rubber_alt(leg.rubber, best),
                caption=f"Kawabata's rubber (points) and {best.name}, whose numbers come from Treloar's (lines).",
                figure=rubber_figure(leg.sets.rubber, best),
            )
        )
    return {picture.name: picture for picture in drawn}


def measured_parts(leg: MeasuredLeg) -> tuple[Part, ...]:
    """Return what is said of each set that is there."""
    parts = []
    if leg.phantoms is not None:
        tables = [measured_tables.phantom_table(leg.phantoms), measured_tables.growth_table(leg.phantoms)]
        if leg.grades:
            tables.append(measured_tables.grade_table(leg.grades))
        tables.append(measured_tables.composition_table(leg.phantoms))
        parts.append(
            Part(
                title="Silicone between platens",
                lead="Discs of 50 mm by 30 mm pressed to a third of their height. Each law is fitted to one specimen "
                "up to 30 % and foretells the rest and the other specimen. Where faces slide the answer is closed, "
                "where they are held it is finite elements. The truth lies between.",
                pictures=("measured-platens", "measured-growth"),
                tables=tuple(tables),
            )
        )
    if leg.limbs is not None:
        parts.append(
            Part(
                title="Limbs in vivo",
                lead="People's limbs pressed with an ultrasound probe. Skin, fat and muscle on bone, their thicknesses "
                "measured, one set of moduli for all, foretell the force at the measured indentation.",
                pictures=("measured-limbs",),
                tables=(measured_tables.limb_table(leg.limbs),),
            )
        )
    if leg.strips:
        parts.append(
            Part(
                title="A sow's tissues in tension",
                lead="Laws fitted to four animals foretell the fifth.",
                pictures=("measured-strips",),
                tables=(measured_tables.strip_table(leg.strips),),
            )
        )
    if leg.holds is not None:
        parts.append(
            Part(
                title="Beef that relaxes",
                lead="A Prony series, the law by which a layer remembers, fitted to one day's holds through each "
                "test's own ramp, foretells another day's.",
                pictures=("measured-holds",),
                tables=(measured_tables.hold_table(leg.holds),),
            )
        )
    if leg.rubber:
        parts.append(
            Part(
                title="Rubber, to check the laws' code",
                lead="No tissue, but the classical test: numbers from one experiment must hold in another.",
                pictures=("measured-rubber",),
                tables=(measured_tables.rubber_table(leg.rubber),),
            )
        )
    return tuple(parts)


def _best(leg: MeasuredLeg) -> FittedRubber:
    whole = max(law.points for law in leg.rubber)
    return min((law for law in leg.rubber if law.points == whole), key=lambda law: law.biaxial)
