"""The report of a calibration: one HTML file, or a folder with its figures beside it."""

from __future__ import annotations

import re
from collections.abc import Mapping
from datetime import UTC, datetime
from math import exp, isfinite
from pathlib import Path
from types import SimpleNamespace

from trocar import __version__
from trocar.errors import InputError
from trocar.study.calibration.calibration import Calibration
from trocar.study.calibration.identifiability import VAGUE, Estimate
from trocar.study.report.figures.agreement import MICROMETRE
from trocar.study.report.figures.calibration import (
    fit_alt,
    fit_figure,
    knowledge_alt,
    knowledge_figure,
    markers_alt,
    markers_figure,
)
from trocar.study.report.figures.style import label, three
from trocar.study.report.page import environment
from trocar.study.report.picture import Picture
from trocar.study.report.table import Table, count, percent
from trocar.tissues.key_table import Words
from trocar.units import MILLIMETRE
from trocar.whole_file import write_whole

REPORT = "report.html"
_OURS = re.compile(rb'<meta name="generator" content="Trocar ')
_HEAD_BYTES = 2000  # of a report, in which its generator stands


def calibration_pictures(calibration: Calibration) -> dict[str, Picture]:
    """Draw every figure, by name."""
    shown = {
        "fit": Picture(
            name="fit",
            alt=fit_alt(calibration),
            caption="Dots are readings, their zero offset taken off; open ones were held out of the fit. Below is what "
            "the fit leaves; the grey band holds 95 % of the tool's noise.",
            figure=fit_figure(calibration),
        ),
        "knowledge": Picture(
            name="knowledge",
            alt=knowledge_alt(calibration),
            caption="Left: 95 % intervals over the fitted value, pale where the data leave a parameter open. Right: "
            "correlation of the errors; two parameters near 1 or −1 are hardly told apart.",
            figure=knowledge_figure(calibration),
        ),
    }
    if any(series.places is not None for series in calibration.problem.measurement.series):
        shown["markers"] = Picture(
            name="markers",
            alt=markers_alt(calibration),
            caption="Markers: measured against fitted, on the line where both agree.",
            figure=markers_figure(calibration),
        )
    return shown


def calibration_page(
    calibration: Calibration, pictures: Mapping[str, Picture], *, command: str, created: str
) -> str:
    """Return the report as HTML.

    Args:
        calibration: what came of it.
        pictures: as `calibration_pictures` draws them.
        command: that made it.
        created: when, as it shall be shown.
    """
    held = calibration.held_out
    return (
        environment()
        .get_template("calibration.html.jinja")
        .render(
            title=calibration.case.title,
            data=calibration.problem.measurement.source,
            model=label(calibration.model),
            told=calibration.known.sentences,
            warnings=calibration.warnings,
            held_out="All rows were fitted; nothing was held out." if held is None else held.sentence,
            pictures=pictures,
            tables=SimpleNamespace(
                parameters=parameter_table(calibration),
                noise=noise_table(calibration),
                combinations=combination_table(calibration),
                made=_made_table(calibration, command),
            ),
            created=created,
        )
    )


def parameter_table(calibration: Calibration) -> Table:
    """Return values, intervals and what they are made of."""
    rows = tuple(
        (
            item.parameter.name,
            three(item.start / item.parameter.factor),
            three(item.value / item.parameter.factor),
            interval(item),
            percent(item.from_noise) if item.told else "",
            percent(item.from_model) if item.told else "",
        )
        for item in calibration.known.estimates
    )
    return Table(
        caption="Fitted parameters.",
        head=("", "start", "fitted", "95 % interval", "error from noise", "error from the model"),
        rows=rows,
        numeric=(1, 2, 4, 5),
        note=f"The interval counts both: noise, for as many rows as are independent, and a model that is off by "
        f"{percent(calibration.model_error)} of every deflection.",
    )


def interval(item: Estimate) -> str:
    """Return a parameter's interval in words."""
    unit = "" if item.parameter.unit == "1" else f" {item.parameter.unit}"
    if item.low is None or item.high is None:
        return "at its bound" if item.at_bound else "open"
    factor = item.parameter.factor
    return f"{three(item.low / factor)} to {three(item.high / factor)}{unit}"


def noise_table(calibration: Calibration) -> Table:
    """Return what the fit leaves of each series."""
    rows = tuple(
        (
            noise.name,
            count(noise.rows),
            count(round(noise.worth)),
            f"{three(noise.rms / MICROMETRE)} µm",
            percent(noise.rms / noise.range),
            f"{three(offset / MILLIMETRE)} mm" if offset else "",
        )
        for noise, offset in zip(calibration.fitted.noise, calibration.fitted.offsets.tolist(), strict=True)
    )
    return Table(
        caption="What the fit leaves.",
        head=("", "rows", "independent", "left, root mean square", "of the range", "zero offset taken off"),
        rows=rows,
        numeric=(1, 2, 3, 4, 5),
        note="Rows that resemble their neighbours are not independent: n (1 − r)/(1 + r) are left of n, r being the "
        "correlation of what a row leaves with what the next one leaves.",
    )


def combination_table(calibration: Calibration) -> Table:
    """Return the eigenvectors of the information and their errors."""
    known = calibration.known
    parameters = tuple(item.parameter for item in known.estimates)
    rows = tuple((one.words(parameters), _error(one.error)) for one in known.combinations)
    return Table(
        caption="Independent combinations, best known first.", head=("", "known to, 95 %"), rows=rows
    )


def _error(error: float) -> str:
    if error < VAGUE:
        return percent(1.96 * error)
    return f"a factor of {three(exp(1.96 * error))}" if isfinite(error) and error < 10 else "nothing"


def _made_table(calibration: Calibration, command: str) -> Table:
    case = calibration.case
    sides = " × ".join(f"{side / MILLIMETRE:g}" for side in case.size)
    tool = case.tools[0]
    rows = (
        ("block", f"{sides} mm, support {case.support.value}"),
        ("tool", f"{tool.tip.value}, {tool.diameter / MILLIMETRE:g} mm, {tool.contact.value}"),
        ("model", f"{label(calibration.model)}, {calibration.fitted.evaluations} predictions"),
        ("linear range", f"to {three(calibration.force_limit)} N"),
        ("made with", f"Trocar {__version__}"),
        ("command", command),
    )
    return Table(caption="Circumstances.", head=("", ""), rows=rows)


def check_report(out: Path) -> tuple[Path, Path | None]:
    """Return the page's place, and the folder for figures where `out` is one; refuse before any work.

    Raises:
        InputError: something else stands in the way.
    """
    alone = out.suffix == ".html"
    page = out if alone else out / REPORT
    if not alone and out.exists() and not out.is_dir():
        raise InputError(f"--report {out}", "a folder, or a file that ends with .html", Words("another file"))
    if page.exists() and not (page.is_file() and _OURS.search(page.read_bytes()[:_HEAD_BYTES])):
        raise InputError(
            f"--report {page}", "a new file, or an earlier report", Words("another file"), "name another"
        )
    return page, None if alone else out


def write_report(out: Path, calibration: Calibration, command: str) -> Path:
    """Write the report; return the page's place.

    Args:
        out: a file that ends with .html, or a folder, which gets the figures as SVG too.
        calibration: what came of it.
        command: that made it.

    Raises:
        InputError: as `check_report`.
        OSError: it cannot be written.
    """
    page, folder = check_report(out)
    pictures = calibration_pictures(calibration)
    created = f"{datetime.now(UTC):%Y-%m-%d %H:%M} UTC"
    text = calibration_page(calibration, pictures, command=command, created=created)
    page.parent.mkdir(parents=True, exist_ok=True)
    write_whole(page, lambda stream: stream.write(text))
    if folder is not None:
        for picture in pictures.values():
            _write_picture(folder / f"{picture.name}.svg", picture)
    return page


def _write_picture(place: Path, picture: Picture) -> None:
    write_whole(place, lambda stream: stream.write(picture.svg))
