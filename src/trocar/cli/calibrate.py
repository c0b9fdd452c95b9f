"""trocar calibrate: parameters of a tissue from measured force and displacement."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from shlex import join
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from trocar.study.calibration.calibration import Calibration
    from trocar.tissues.record import Setting


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command(
        epilog="Example: trocar calibrate examples/phantom.csv --case examples/phantom.toml --fit body.young_modulus"
    )(calibrate)


def calibrate(
    data: Annotated[
        Path,
        typer.Argument(
            help="A record with the columns time_s, force_n, displacement_mm.", show_default=False
        ),
    ],
    case: Annotated[
        Path, typer.Option(help="A case file: block, tool, layers as they are known, starting values.")
    ],
    fit: Annotated[
        list[str],
        typer.Option(help="A parameter such as fat.young_modulus or fat.prony[0].tau; once for each."),
    ],
    model: Annotated[
        str, typer.Option(help="wave-solid, wave-membrane or fea: what the data are explained with.")
    ] = "wave-solid",
    markers: Annotated[
        Path | None, typer.Option(help="Markers on the surface: columns time_s, x_mm, y_mm, uz_mm.")
    ] = None,
    hold_out: Annotated[
        float | None,
        typer.Option(help="Share of the record, its end, that the fit does not see. Default: 0.25."),
    ] = None,
    check: Annotated[
        Path | None, typer.Option(help="Another record of the same press to hold the fit against instead.")
    ] = None,
    noise_n: Annotated[float | None, typer.Option(help="Standard deviation of the force's noise.")] = None,
    noise_mm: Annotated[
        float | None,
        typer.Option(help="Standard deviation of the displacements' noise. Default: what the fit leaves."),
    ] = None,
    model_error: Annotated[
        float | None,
        typer.Option(
            help="Share of a deflection the model may be off by. Default: 0.002; wave-membrane 0.03."
        ),
    ] = None,
    zeroed: Annotated[
        bool, typer.Option("--zeroed", help="Trust the displacement's zero; else an offset is fitted too.")
    ] = False,
    out: Annotated[
        Path | None, typer.Option(help="Write the tissue as a file.toml that trocar train takes.")
    ] = None,
    setting: Annotated[
        str,
        typer.Option(help="in vivo, ex vivo or material test: where it was measured, for the tissue file."),
    ] = "material test",
    report: Annotated[
        Path | None, typer.Option(help="Write a report: a file.html, or a folder that gets the figures too.")
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON alone on stdout.")] = False,
) -> None:
    """Fit parameters of a tissue to measured force and displacement, and say how far the data tell them."""
    from rich.console import Console

    from trocar.study.calibration.calibration import HOLD_OUT
    from trocar.study.calibration.calibration import calibrate as run
    from trocar.study.calibration.reading import read_measurement
    from trocar.study.calibration.tissue_file import check_tissue_file, write_tissue_file
    from trocar.study.cases.reading import load_case
    from trocar.study.report.calibration_page import check_report, write_report
    from trocar.units import MILLIMETRE

    names = tuple(fit)
    where = _setting(setting)
    if check is not None and hold_out is not None:
        raise typer.BadParameter("--check and --hold-out: expected one of them")
    experiment = load_case(case)
    measurement = read_measurement(data, experiment, markers)
    other = None if check is None else read_measurement(check, experiment)
    if out is not None:
        check_tissue_file(out, names)
    if report is not None:
        check_report(report)
    with Console(stderr=True).status("fitting") as status:
        done = run(
            measurement,
            experiment,
            names,
            model=model,
            hold_out=HOLD_OUT if hold_out is None else hold_out,
            check=other,
            noise_force=noise_n,
            noise_depth=None if noise_mm is None else noise_mm * MILLIMETRE,
            zeroed=zeroed,
            model_error=model_error,
            watch=status.update,
        )
    written: dict[str, str | None] = {"tissue": None, "report": None}
    if out is not None:
        write_tissue_file(out, done, where)
        written["tissue"] = str(out)
    if report is not None:
        written["report"] = str(write_report(report, done, join(["trocar", *sys.argv[1:]])))
    if as_json:
        typer.echo(json.dumps({**done.as_dict(), **written}, allow_nan=False))
    else:
        _print(done, written)


def _setting(name: str) -> Setting:
    from trocar.study.calibration.tissue_file import SETTINGS

    for one in SETTINGS:
        if one.value == name:
            return one
    raise typer.BadParameter(
        f"--setting: expected {' or '.join(one.value for one in SETTINGS)}, got {name!r}"
    )


def _print(done: Calibration, written: dict[str, str | None]) -> None:
    from rich.console import Console
    from rich.table import Table

    from trocar.study.report.calibration_page import noise_table, parameter_table

    console = Console(highlight=False)
    for said, columns in ((parameter_table(done), 4), (noise_table(done), 4)):  # the report has the others
        table = Table(title=said.caption, title_justify="left")
        for i, entry in enumerate(said.head[:columns]):
            table.add_column(entry, justify="right" if i in said.numeric else "left", no_wrap=i == 0)
        for row in said.rows:
            table.add_row(*row[:columns])
        console.print(table)
    for sentence in done.known.sentences:
        console.print(sentence, markup=False)
    if done.held_out is not None:
        console.print(done.held_out.sentence, markup=False)
    for sentence in done.warnings:
        console.print(f"Mind: {sentence}", style="bold", markup=False)
    for name, place in written.items():
        if place is not None:
            console.print(f"{name}: {place}", markup=False)
