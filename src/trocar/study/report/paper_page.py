"""The smaller report: the paper's formula as printed, and corrected."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence

from trocar.study.paper_preset import PaperStudy, Swing
from trocar.study.report.figures.printed_and_corrected import (
    printed_and_corrected_alt,
    printed_and_corrected_figure,
)
from trocar.study.report.figures.style import three
from trocar.study.report.page import environment
from trocar.study.report.picture import Picture
from trocar.study.report.statistic_tables import ledger_rows
from trocar.study.report.table import Table, count
from trocar.units import MILLIMETRE, MILLISECOND

MICROMETRE = 1e-6  # [m]


def paper_picture(study: PaperStudy) -> Picture:
    """Draw the time series of both."""
    return Picture(
        name="printed-and-corrected",
        alt=printed_and_corrected_alt(study),
        caption="The middle of the dermis after it is let go. Neither is damped and neither feels a tool: the paper's "
        "formula has no force in it.",
        figure=printed_and_corrected_figure(study),
    )


def paper_table(study: PaperStudy) -> Table:
    """Return what the paper prints, what its formula gives, and what the corrected one gives."""
    one, two = study.printed, study.corrected
    rows = (
        (
            "B11, amplitude of the lowest mode",
            "6.11×10⁻⁶",
            _micro(one.b11),
            _micro(two.b11),
            "a shape that is zero on the boundary, and equation 3's factor",
        ),
        (
            "B11 by equation 4 as it is written",
            "6.11×10⁻⁶",
            f"{three(study.b11_with_factor / MILLIMETRE)} mm",
            "",
            "the printed value leaves the factor 4/(ab) = 1111 per m² out",
        ),
        (
            "lambda11, its angular frequency",
            "0.686",
            three(one.lambda11),
            f"{three(two.lambda11)} rad/s",
            "tension and density in SI units",
        ),
        ("its period", "", f"{three(one.period)} s", f"{three(two.period / MILLISECOND)} ms", "2π/lambda11"),
        (
            "wave speed",
            "",
            three(one.speed_along),
            f"{three(two.speed_along)} m/s along, {three(two.speed_across)} m/s across",
            "the fibres carry more along than across",
        ),
        (
            "tension",
            "1.54×10⁻³",
            three(one.tension_along),
            f"{three(two.tension_along)} N/m along, {three(two.tension_across)} N/m across",
            "stress times thickness, not stress times width",
        ),
        (
            "mass per area",
            "",
            three(one.areal_density),
            f"{three(two.areal_density)} kg/m²",
            "a density of skin; the printed 18 g/m³ is lighter than air",
        ),
        ("largest displacement at the start", "", _micro(one.peak), _micro(two.peak), "all modes together"),
        (
            "shape at the middle of a fixed side",
            "",
            f"{three(one.on_boundary / MILLIMETRE)} mm",
            "0",
            "5x(1−x)y(1−y) is made for a unit square; 5x(a−x)y(b−y) fits this one",
        ),
        ("modes", "1", count(one.modes), count(two.modes), "up to the width of the tool"),
    )
    return Table(
        caption="The dermis let go from its start.",
        head=("", "printed in the paper", "its formula, recomputed", "corrected", "what is different"),
        rows=rows,
        note="Numbers without a unit in the second and third column are plain numbers: with the units "
        "printed beside the "
        "inputs they would not have the unit of what they are called.",
    )


def paper_summary(study: PaperStudy) -> dict[str, float | dict[str, float]]:
    """Return the numbers of both as plain values: metres, seconds, newtons; printed ones as the paper reads them."""
    return {
        "b11_with_factor": study.b11_with_factor,
        "printed": _plain(study.printed),
        "corrected": _plain(study.corrected),
    }


def paper_page(
    study: PaperStudy,
    picture: Picture,
    *,
    ledger: Sequence[Mapping[str, object]] = (),
    command: str,
    created: str,
) -> str:
    """Return the report as HTML; arguments as those of `page.report_page`."""
    counts = Counter(str(entry["verdict"]) for entry in ledger)
    return (
        environment()
        .get_template("paper.html.jinja")
        .render(
            table=paper_table(study),
            ledger=ledger_rows(tuple(ledger)),
            verdicts=f"{len(ledger)} entries: "
            + ", ".join(f"{n} {verdict}" for verdict, n in counts.most_common())
            + ".",
            picture=picture,
            ratio=three(study.corrected.lambda11 / study.printed.lambda11),
            frequency=three(1 / study.corrected.period),
            period=three(study.printed.period),
            command=command,
            created=created,
        )
    )


def _micro(value: float) -> str:
    return f"{three(value / MICROMETRE)} µm"


def _plain(swing: Swing) -> dict[str, float]:
    keys = (
        "b11",
        "lambda11",
        "period",
        "speed_along",
        "speed_across",
        "tension_along",
        "tension_across",
        "areal_density",
        "peak",
        "on_boundary",
        "modes",
    )
    return {key: getattr(swing, key) for key in keys}
