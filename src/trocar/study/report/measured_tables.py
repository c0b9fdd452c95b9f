"""The tables of measured tissue."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from trocar.study.measured.grades import Grade
from trocar.study.measured.indented import PUBLISHED, LimbResults
from trocar.study.measured.phantom import thinner
from trocar.study.measured.platens import Faces
from trocar.study.measured.pressed import CALIBRATED, GROWTH_STRAINS, Model, PhantomResults, PressedDisc
from trocar.study.measured.relaxed import MOMENTS, ForetoldHolds
from trocar.study.measured.stretched import FittedRubber
from trocar.study.measured.torn import FITTED, JUDGED, ForetoldStrip
from trocar.study.report.figures.style import three
from trocar.study.report.table import Table, percent
from trocar.units import KILOPASCAL

FACES = {Faces.FREE: "slide", Faces.BONDED: "held"}
_UP_TO, _BEYOND = f"to {percent(CALIBRATED)}", f"{percent(CALIBRATED)} to 67 %"


def phantom_table(results: PhantomResults) -> Table:
    """Return every law's errors, the median over the compositions and the largest."""
    rows = []
    for faces in Faces:
        for model in Model:
            discs = results.of(faces, model)
            errors = (
                _median_and_largest([getattr(disc, key) for disc in discs])
                for key in ("fitted", "other", "beyond", "other_beyond")
            )
            rows.append((f"{model}, faces {FACES[faces]}", *errors))
    near, beyond = ([getattr(one, key) for one in results.specimens] for key in ("near", "beyond"))
    rows.append(
        (
            "specimen A itself, as it was measured",
            "",
            _median_and_largest(near),
            "",
            _median_and_largest(beyond),
        )
    )
    return Table(
        caption=f"Silicone between platens: error of the load over {len(results.specimens)} compositions, median "
        "(largest).",
        head=("law", f"A {_UP_TO}, fitted", f"B {_UP_TO}", f"A {_BEYOND}", f"B {_BEYOND}"),
        rows=tuple(rows),
        numeric=(1, 2, 3, 4),
        note="Root mean square difference over root mean square load. Fitted to specimen A up to 30 %, one modulus a "
        "composition, and Ogden's exponent; all other columns are foretold. The linear law is what the wave models "
        "are between platens, one stiffness at every compression: there, faces that slide or are held change the "
        "modulus and not the answer. Whether the real faces slid is not stated."
        + (f" Left out, one specimen only: {', '.join(results.alone)}." if results.alone else ""),
    )


def composition_table(results: PhantomResults) -> Table:
    """Return each composition: moduli and what is foretold of specimen B."""
    free, held = (results.of(faces, Model.NEO_HOOKEAN) for faces in Faces)
    ogden, linear = results.of(Faces.BONDED, Model.OGDEN), results.of(Faces.BONDED, Model.LINEAR)
    rows = tuple(_composition(*discs) for discs in zip(free, held, ogden, linear, strict=True))
    return Table(
        caption="Every composition: shear modulus μ of the neo-Hookean law, and errors on specimen B beyond 30 %.",
        head=(
            "silicone",
            "μ / kPa, faces slide",
            "μ / kPa, held",
            "Ogden's α, held",
            "neo-Hookean, slide",
            "neo-Hookean, held",
            "Ogden, held",
            "linear",
        ),
        rows=rows,
        numeric=tuple(range(1, 8)),
    )


def growth_table(results: PhantomResults) -> Table:
    """Return how the error of the load grows with compression."""
    shown = ((Faces.BONDED, Model.LINEAR), *((faces, model) for model in list(Model)[1:] for faces in Faces))
    rows = []
    for faces, model in shown:
        growth = np.median([disc.growth for disc in results.of(faces, model)], axis=0)
        name = str(model) if model is Model.LINEAR else f"{model}, faces {FACES[faces]}"
        rows.append((name, *(f"{round(100 * share, 1) + 0.0:+.1f} %".replace("-", "−") for share in growth)))
    return Table(
        caption="Predicted over measured load, less one, of specimen B at a compression: median of all compositions.",
        head=("law", *(percent(strain) for strain in GROWTH_STRAINS)),
        rows=tuple(rows),
        numeric=tuple(range(1, len(GROWTH_STRAINS) + 1)),
    )


def grade_table(grades: Sequence[Grade]) -> Table:
    """Return each grade of silicone, pressed in one laboratory and pulled in another."""
    return Table(
        caption="One silicone in two laboratories: neo-Hookean shear modulus in kPa.",
        head=("silicone", "pressed, faces slide", "pressed, held", "pulled", "pressed over pulled"),
        rows=tuple(
            (
                grade.name,
                *(three(value / KILOPASCAL) for value in (grade.free, grade.bonded, grade.pulled)),
                f"{grade.bonded / grade.pulled:.2f} to {grade.free / grade.pulled:.2f}",
            )
            for grade in grades
        ),
        numeric=(1, 2, 3, 4),
        note="What two laboratories make of one material: no model can claim a better absolute modulus than that.",
    )


def limb_table(results: LimbResults) -> Table:
    """Return every way of foretelling the force on a limb."""
    ways = (results.linear, results.exponential, *results.baselines)
    rows = [(way.name, percent(way.fitted_median), percent(way.median), percent(way.mean)) for way in ways]
    rows.append(("a two-spring model, as published", "", percent(PUBLISHED), ""))
    rows.append(
        ("two people alike in site, probe, layers and indentation", "", percent(results.neighbours), "")
    )
    moduli = ", ".join(three(modulus / KILOPASCAL) for modulus in results.shear_moduli)
    fitted, judged = results.people
    return Table(
        caption=f"Force on limbs: relative error on {judged} people that nothing was fitted to, "
        f"{int(results.judged.sum())} trials.",
        head=("foretold from thicknesses, probe and indentation by", "median, fitted", "median", "mean"),
        rows=tuple(rows),
        numeric=(1, 2, 3),
        note=f"Fitted to {fitted} other people. Linear layers: shear moduli of skin, fat and muscle {moduli} kPa, "
        f"the same everywhere. Exponential layers: b = {three(results.steepness)}; below zero they soften, which no "
        "tissue does: it seems that operators press until a force is reached, so indentation tells little of it. "
        f"Last row: the median of {results.pairs} trials that have such a neighbour, over √2. "
        f"Trials without all thicknesses are left out: {results.limbs.incomplete}.",
    )


def strip_table(strips: Sequence[ForetoldStrip]) -> Table:
    """Return each of a sow's tissues."""
    return Table(
        caption=f"A sow's tissues in tension: fitted to {', '.join(FITTED)}, error of the stress of {JUDGED}.",
        head=(
            "tissue",
            "to a stretch of",
            "Ogden",
            "fibre law",
            "mean of the others",
            "stiffest over softest",
        ),
        rows=tuple(
            (
                strip.tissue,
                f"{strip.limit:.2f}",
                *(percent(strip.errors[name]) for name in ("Ogden", "fibre", "mean of the others")),
                three(float(strip.others[:, -1].max() / strip.others[:, -1].min())),
            )
            for strip in strips
        ),
        numeric=(1, 2, 3, 4, 5),
        note="Root mean square difference over root mean square stress. The (geometric) mean of the other animals is "
        "no law: what a law adds to its error is the law's, the rest is the animal's. The last column compares those "
        "animals with each other at the largest stretch.",
    )


def hold_table(holds: ForetoldHolds) -> Table:
    """Return what is left of the force at moments after the peak."""
    series = ", ".join(f"g = {three(weight)} at τ = {three(time)} s" for weight, time in holds.prony)
    rows = zip(MOMENTS, holds.measured, holds.foretold, holds.spread, strict=True)
    return Table(
        caption=f"Relaxing beef: force over its peak in {holds.counts[1]} tests of another day.",
        head=(
            "seconds after the peak",
            "measured, mean",
            "foretold, mean",
            "difference",
            "spread between tests",
        ),
        rows=tuple(
            (
                f"{moment:g}",
                f"{measured:.3f}",
                f"{foretold:.3f}",
                f"{foretold - measured:+.3f}".replace("-", "−"),
                f"{spread:.3f}",
            )
            for moment, measured, foretold, spread in rows
        ),
        numeric=(0, 1, 2, 3, 4),
        note=f"Fitted to {holds.counts[0]} tests: {series}, over the long-term modulus; force as indentation to the "
        f"power {holds.power:.2f}. Root mean square error of a single test's course: {three(holds.fitted)} fitted, "
        f"{three(holds.judged)} foretold, {three(holds.mean_curve)} of the mean curve of the fitted day. Ten seconds "
        "say nothing of slower branches.",
    )


def rubber_table(laws: Sequence[FittedRubber]) -> Table:
    """Return what laws fitted to Treloar's rubber make of Kawabata's."""
    return Table(
        caption="Rubber: fitted to Treloar's, pulled one way; foretold for Kawabata's, pulled two ways.",
        head=(
            "law",
            "stretch up to",
            "shear modulus / kPa",
            "Treloar",
            "Kawabata",
            "Kawabata, median",
            "points",
        ),
        rows=tuple(
            (
                law.name,
                f"{law.stretch:.2f}",
                three(law.fitted.shear_modulus / KILOPASCAL),
                percent(law.uniaxial),
                percent(law.biaxial),
                percent(law.median),
                str(law.points),
            )
            for law in laws
        ),
        numeric=(1, 2, 3, 4, 5, 6),
        note="Root mean square difference over root mean square stress; the median is of relative errors. They are two "
        "rubbers. Ogden's law of 1972 was fitted to Treloar's tension, shear and balloon together; tension alone does "
        "not say what two directions do.",
    )


def _composition(
    free: PressedDisc, held: PressedDisc, ogden: PressedDisc, linear: PressedDisc
) -> tuple[str, ...]:
    grade = free.composition.split("_")[0].removeprefix("EF")
    name = f"Ecoflex 00-{grade}" + (
        f" + {thinner(free.composition):g} %" if thinner(free.composition) else ""
    )
    return (
        name,
        three(free.shear_modulus / KILOPASCAL),
        three(held.shear_modulus / KILOPASCAL),
        f"{ogden.exponent:.2f}",
        *(percent(disc.other_beyond) for disc in (free, held, ogden, linear)),
    )


def _median_and_largest(errors: Sequence[float]) -> str:
    return f"{percent(float(np.median(errors)))} ({percent(max(errors))})"
