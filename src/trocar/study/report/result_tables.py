"""What came out: deflections of every case, supports, the linear range, stresses and cost."""

from __future__ import annotations

from collections.abc import Mapping
from math import isfinite

from trocar.study.compare import Comparison
from trocar.study.linear_range import Ranges
from trocar.study.protocol import JUDGED, REFERENCE, Study
from trocar.study.report.figures.style import label, three
from trocar.study.report.figures.supports import WORDS
from trocar.study.report.table import Table, count, percent
from trocar.study.statistics.agreement import nrmse
from trocar.study.validity import BOUNDS
from trocar.units import KILOPASCAL, MILLIMETRE

NOT_ASSESSED = "not assessed"


def cases(study: Study) -> Mapping[str, tuple[str, Comparison]]:
    """Return every case by key, with the name tables show it under."""
    small, peak = f"{study.plan.small:g} N", f"{study.plan.peak:g} N"
    return {
        "small": (f"{small} in the middle", study.small),
        "paper": (f"{peak} in the middle", study.paper),
        "tilted": (f"{small}, tool at an angle", study.tilted),
        "pair": (f"two tools, {small} each", study.pair),
        "tap": (f"tap of {small}, in time", study.tap),
    }


def deflection_table(comparison: Comparison, caption: str, note: str = "") -> Table:
    """Return the largest deflection of every layer under every model, and how far each is from finite elements."""
    judged = [history for history in comparison.histories if history.model != REFERENCE]
    truth = comparison[REFERENCE]
    rows = []
    for layer, reference in truth.deflection.items():
        cells = [layer, three(float(reference.max()) / MILLIMETRE)]
        for history in judged:
            depth = history.deflection[layer]
            difference = float(depth.max() - reference.max()) / float(reference.max())
            cells += [
                three(float(depth.max()) / MILLIMETRE),
                percent(difference, signed=True),
                percent(nrmse(reference, depth)),
            ]
        rows.append(tuple(cells))
    names = [label(history.model) for history in judged]
    return Table(
        caption=caption,
        head=(
            "upper face of",
            "finite elements / mm",
            *(entry for name in names for entry in (f"{name} / mm", "at the peak", "NRMSE")),
        ),
        rows=tuple(rows),
        numeric=tuple(range(1, 2 + 3 * len(judged))),
        note=note,
    )


def support_table(study: Study) -> Table:
    """Return the small load's deflection of each layer under each support."""
    rows = []
    for support, comparison in study.supports.items():
        truth = comparison[REFERENCE]
        for layer, depth in truth.deflection.items():
            peak = float(depth.max())
            others = (
                percent((float(comparison[model].deflection[layer].max()) - peak) / peak, signed=True)
                for model in JUDGED
            )
            rows.append((WORDS[support].replace("\n", " "), layer, three(peak / MILLIMETRE), *others))
    return Table(
        caption=f"Largest deflection under {study.plan.small:g} N for each support; wave models as "
        "difference from finite "
        "elements.",
        head=("support", "upper face of", "finite elements / mm", *(label(model) for model in JUDGED)),
        rows=tuple(rows),
        numeric=(2, 3, 4),
    )


def range_table(study: Study, ranges: Ranges | None) -> Table:
    """Return whether each case lies inside the linear range; "not assessed" where nobody judged it."""
    rows = []
    for key, (name, comparison) in cases(study).items():
        thickness = comparison.case.tissue.thickness
        share = float(comparison[REFERENCE].block.max()) / thickness
        verdict = None if ranges is None else ranges.get(key)
        if verdict is None:
            rows.append((name, NOT_ASSESSED, percent(share), NOT_ASSESSED, NOT_ASSESSED, "", ""))
            continue
        rows.append(
            (
                name,
                "inside" if verdict.inside else "OUTSIDE",
                percent(verdict.deflection_share),
                percent(verdict.strain),
                three(verdict.slope),
                verdict.limiting.replace("_", " "),
                three(verdict.force_limit) if isfinite(verdict.force_limit) else "none",
            )
        )
    return Table(
        caption="Whether each case lies inside the range in which small-strain theory holds.",
        head=(
            "case",
            "linear range",
            "deflection / thickness",
            "largest strain",
            "largest slope",
            "decided by",
            "range ends at / N",
        ),
        rows=tuple(rows),
        numeric=(2, 3, 4, 6),
    )


def validity_table(study: Study) -> Table:
    """Return the force at which each wave model leaves 5 and 10 % under each tool."""
    rows = []
    for tool in study.validity.rows:
        for (model, kind), curve in tool.curves.items():
            furthest = float(tool.force[-1])
            limits = (
                three(limit) if isfinite(limit) else f"above {three(furthest)}" for limit in curve.leaves
            )
            largest = percent(float(curve.error[abs(curve.error).argmax()]), signed=True)
            rows.append((f"{tool.diameter / MILLIMETRE:g}", label(model), kind, *limits, largest))
    stops = {f"{tool.diameter / MILLIMETRE:g} mm" for tool in study.validity.rows if tool.stopped}
    return Table(
        caption="Up to which force each wave model stays within a bound of hyperelastic finite elements.",
        head=(
            "tool / mm",
            "model",
            "waves",
            *(f"{100 * bound:g} % left at / N" for bound in BOUNDS),
            "largest error",
        ),
        rows=tuple(rows),
        numeric=(0, 3, 4, 5),
        note="Errors of the worst layer, up to a deflection of a third of the block's thickness."
        + (f" Finite elements went less far under {', '.join(sorted(stops))}." if stops else ""),
    )


def strength_table(study: Study, *, predicted: bool) -> Table:
    """Return the largest stress of each layer beside what it bears; `predicted`: whether the paper's load is inside."""
    rows = []
    for layer, strength in study.strength.items():
        known = isfinite(strength.tensile_strength)
        rows.append(
            (
                layer,
                three(strength.at_small / KILOPASCAL),
                three(strength.at_peak / KILOPASCAL),
                three(strength.tensile_strength / KILOPASCAL) if known else "not known",
                percent(strength.at_small / strength.tensile_strength) if known else "",
            )
        )
    small, peak = f"{study.plan.small:g} N", f"{study.plan.peak:g} N"
    return Table(
        caption="Largest von Mises stress of each layer, prestress included, and its tensile strength.",
        head=(
            "layer",
            f"{small} / kPa",
            f"{peak} / kPa" if predicted else f"{peak} / kPa (not a prediction)",
            "tensile strength / kPa",
            f"share at {small}",
        ),
        rows=tuple(rows),
        numeric=(1, 2, 3, 4),
        note="Taken at the points inside the elements where stresses are most accurate. Under the rim of "
        "a flat disc the "
        "linear stress of the top layer has no bound: its value grows as the mesh is refined.",
    )


def cost_table(study: Study) -> Table:
    """Return the processor time of every model for every case, set-up apart, as a ratio to finite elements."""
    rows = []
    for name, comparison in cases(study).values():
        whole = comparison[REFERENCE].cpu_seconds
        for history in comparison.histories:
            rest = max(history.cpu_seconds - history.setup_seconds, 0.0)
            ratio = whole / history.cpu_seconds if history.cpu_seconds > 0 else float("inf")
            rows.append(
                (
                    name,
                    label(history.model),
                    three(history.setup_seconds),
                    three(rest),
                    three(history.cpu_seconds),
                    count(history.dofs),
                    "1" if history.model == REFERENCE else f"{ratio:.2g}" if ratio < 100 else f"{ratio:.0f}",
                )
            )
    return Table(
        caption="Processor time of each model for the same case on this machine.",
        head=(
            "case",
            "model",
            "set-up / s",
            "samples / s",
            "together / s",
            "unknowns",
            "times cheaper than finite elements",
        ),
        rows=tuple(rows),
        numeric=(2, 3, 4, 5, 6),
        note="Set-up is building the model and, where the load is followed through equilibria, one "
        "solution for each tool: "
        "linear models scale and add it for every sample. Finite elements use the block's symmetry, so their unknowns "
        f"count the part they solve. Compiling the wave models took {study.compile_seconds:.1f} s, apart; "
        "it is cached.",
    )
