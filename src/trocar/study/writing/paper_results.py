"""Write the study of the paper's formula: the same folder, smaller."""

from __future__ import annotations

import csv
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from pathlib import Path

import xarray as xr

from trocar import __version__
from trocar.study.paper_preset import PaperStudy
from trocar.study.report.paper_page import paper_page, paper_picture, paper_summary
from trocar.study.writing.dataset import PAPER
from trocar.study.writing.folder import fresh_folder
from trocar.study.writing.results import write_json


def write_paper_study(
    study: PaperStudy,
    out: Path,
    *,
    ledger: Sequence[Mapping[str, object]] = (),
    command: str = "",
    created: datetime | None = None,
) -> Path:
    """Write the study into a folder, which appears only when everything in it is written.

    Args:
        study: the results.
        out: the folder; new, empty, or an earlier study's, which is replaced whole.
        ledger: entries of the reproduction ledger as plain values.
        command: that made it, recorded.
        created: time of writing; now where None.

    Returns:
        The path of the report.

    Raises:
        InputError: `out` is a file, or a folder with files no study wrote.
        OSError: it cannot be written.
    """
    moment = created or datetime.now(UTC)
    stamp = moment.isoformat(timespec="seconds")
    with fresh_folder(out) as folder:
        picture = paper_picture(study)
        (folder / "figures").mkdir()
        (folder / "figures" / f"{picture.name}.svg").write_text(picture.svg, encoding="utf-8")
        paper_dataset(study, created=stamp, command=command).to_netcdf(
            folder / "results.nc", engine="h5netcdf"
        )
        _write_curves(study, folder / "curves.csv")
        write_json(folder / "statistics.json", paper_summary(study))
        write_json(folder / "ledger.json", [dict(entry) for entry in ledger])
        page = paper_page(
            study,
            picture,
            ledger=ledger,
            command=command,
            created=f"{moment.astimezone(UTC):%Y-%m-%d %H:%M} UTC",
        )
        (folder / "report.html").write_text(page, encoding="utf-8")
    return out / "report.html"


def paper_dataset(study: PaperStudy, *, created: str, command: str = "") -> xr.Dataset:
    """Return both time series after the CF conventions."""
    variables = {}
    for name, swing in (("printed", study.printed), ("corrected", study.corrected)):
        time = f"time_{name}"
        variables[time] = xr.Variable(
            (time,), swing.time, {"units": "s", "long_name": f"time since release, {name}"}
        )
        variables[f"centre_{name}"] = xr.Variable(
            (time,),
            swing.centre,
            {"units": "m", "long_name": f"displacement of the middle of the dermis, {name}"},
        )
    times = {name: variables.pop(name) for name in list(variables) if name.startswith("time_")}
    return xr.Dataset(
        variables,
        coords=times,
        attrs={
            "Conventions": "CF-1.11",
            "title": "The 2014 paper's wave formula, as printed and corrected",
            "source": f"trocar {__version__}",
            "history": f"{created} {command}".strip(),
            "references": PAPER,
            "version": __version__,
            "created": created,
        },
    )


def _write_curves(study: PaperStudy, path: Path) -> None:
    with path.open("w", newline="", encoding="utf-8") as stream:
        rows = csv.writer(stream, lineterminator="\n")
        rows.writerow(("formula", "time_s", "displacement_m"))
        for name, swing in (("printed", study.printed), ("corrected", study.corrected)):
            for time, displacement in zip(swing.time, swing.centre, strict=True):
                rows.writerow((name, f"{time:.9g}", f"{displacement:.9g}"))
