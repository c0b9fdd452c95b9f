"""Write a study: the report, and every number and figure in it as files of their own, all of them or none."""

from __future__ import annotations

import csv
import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from datetime import UTC, datetime
from pathlib import Path

from trocar.study.compare import Comparison
from trocar.study.linear_range import LinearRange, Ranges
from trocar.study.measured.leg import MeasuredLeg
from trocar.study.protocol import BLOCK, Study
from trocar.study.report.figures.animation import animation
from trocar.study.report.measured_section import measured_pictures
from trocar.study.report.page import report_page
from trocar.study.report.pictures import pictures
from trocar.study.validity import as_plain
from trocar.study.writing.dataset import study_dataset
from trocar.study.writing.folder import fresh_folder
from trocar.study.writing.measured_results import measured_results
from trocar.study.writing.plain import plain
from trocar.units import MILLIMETRE

FILM = "press-and-release"
CURVE_COLUMNS = ("case", "support", "model", "layer", "time_s", "force_n", "max_deflection_mm")
_RANGE_KEYS = ("strain", "deflection_share", "slope", "inside", "limiting", "force_limit")


def write_study(
    study: Study,
    out: Path,
    *,
    ledger: Sequence[Mapping[str, object]] = (),
    ranges: Ranges | None = None,
    measured: MeasuredLeg | None = None,
    command: str = "",
    created: datetime | None = None,
) -> Path:
    """Write a study into a folder, which appears only when everything in it is written.

    Args:
        study: the results.
        out: the folder; new, empty, or an earlier study's, which is replaced whole.
        ledger: entries of the reproduction ledger as plain values: id, published, recomputed, unit, verdict, note.
        ranges: verdicts on the linear range, by case: "small", "paper", "tilted", "pair", "tap".
        measured: what was foretold of measured tissue; None where no data were named.
        command: that made it, recorded.
        created: time of writing; now where None.

    Returns:
        The path of the report.

    Raises:
        InputError: `out` is a file, or a folder with files no study wrote.
        OSError: it cannot be written.
    """
    moment = created or datetime.now(UTC)
    with fresh_folder(out) as folder:
        drawn = {**pictures(study), **({} if measured is None else measured_pictures(measured))}
        film = animation(study.film)
        figures = folder / "figures"
        figures.mkdir()
        for name, picture in drawn.items():
            (figures / f"{name}.svg").write_text(picture.svg, encoding="utf-8")
        (figures / f"{FILM}.gif").write_bytes(film.gif)
        (figures / f"{FILM}.png").write_bytes(film.still)
        stamp = moment.isoformat(timespec="seconds")
        study_dataset(study, created=stamp, command=command).to_netcdf(
            folder / "results.nc", engine="h5netcdf"
        )
        write_curves(study, folder / "curves.csv")
        write_json(folder / "statistics.json", statistics(study, ranges))
        write_json(folder / "ledger.json", [dict(entry) for entry in ledger])
        if measured is not None:
            write_json(folder / "measured.json", measured_results(measured))
        page = report_page(
            study,
            drawn,
            film,
            ledger=ledger,
            ranges=ranges,
            measured=measured,
            command=command,
            created=f"{moment.astimezone(UTC):%Y-%m-%d %H:%M} UTC",
        )
        (folder / "report.html").write_text(page, encoding="utf-8")
    return out / "report.html"


def write_curves(study: Study, path: Path) -> None:
    """Write every curve as one row a case, model, layer and sample."""
    with path.open("w", newline="", encoding="utf-8") as stream:
        rows = csv.writer(stream, lineterminator="\n")
        rows.writerow(CURVE_COLUMNS)
        for name, comparison in _cases(study):
            for history in comparison.histories:
                for layer, depth in {**history.deflection, BLOCK: history.block}.items():
                    for time, force, deflection in zip(history.time, history.force, depth, strict=True):
                        numbers = (f"{value:.9g}" for value in (time, force, deflection / MILLIMETRE))
                        rows.writerow((name, comparison.case.support.value, history.model, layer, *numbers))


def statistics(study: Study, ranges: Ranges | None = None) -> dict[str, object]:
    """Return every statistic as plain values for JSON; lengths in metres, what is not finite is None."""
    return {
        "tissue": study.plan.tissue,
        "support": study.plan.support.value,
        "agreement": {
            load: {
                model: {layer: curve.as_dict() for layer, curve in layers.items()}
                for model, layers in models.items()
            }
            for load, models in study.agreement.items()
        },
        "numerics": {
            layer: plain(
                asdict(numbers)
                | {
                    "resolved": numbers.comparison.resolved,
                    "model_error": list(numbers.comparison.model_error),
                }
            )
            for layer, numbers in study.numerics.items()
        },
        "strength": {layer: plain(asdict(strength)) for layer, strength in study.strength.items()},
        "cost": {
            name: {
                history.model: {
                    "cpu_s": history.cpu_seconds,
                    "setup_s": history.setup_seconds,
                    "dofs": history.dofs,
                }
                for history in comparison.histories
            }
            for name, comparison in _cases(study)
        },
        "validity": as_plain(study.validity),
        "compile_s": study.compile_seconds,
        "study_s": study.seconds,
        "machine": dict(study.machine),
        "linear_range": None if ranges is None else {name: _verdict(one) for name, one in ranges.items()},
    }


def write_json(path: Path, content: object) -> None:
    """Write plain values as JSON that any reader takes: no infinity, no nan."""
    path.write_text(
        json.dumps(content, indent=1, ensure_ascii=False, allow_nan=False) + "\n", encoding="utf-8"
    )


def _cases(study: Study) -> list[tuple[str, Comparison]]:
    others = [
        (f"support {support.value}", comparison)
        for support, comparison in study.supports.items()
        if support is not study.plan.support
    ]
    named = ("small", "paper", "tilted", "pair", "tap")
    return [*((name, getattr(study, name)) for name in named), *others]


def _verdict(verdict: LinearRange) -> object:
    return plain({key: getattr(verdict, key) for key in _RANGE_KEYS})
