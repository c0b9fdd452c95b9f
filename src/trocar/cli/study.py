"""trocar study: the paper's whole validation study, from a tissue to a report."""

from __future__ import annotations

import json
import sys
from enum import StrEnum
from math import isfinite
from pathlib import Path
from shlex import join
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from trocar.model import Support
    from trocar.study.conduct import Conducted
    from trocar.study.paper_preset import PaperStudy


class Preset(StrEnum):
    """A study that is not the validation study."""

    PAPER_2014 = "paper-2014"


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command(epilog="Example: trocar study --out study --tissue skin --support base")(study)


def study(
    out: Annotated[Path, typer.Option(help="Folder for the results: new, empty, or an earlier study's.")],
    tissue: Annotated[
        str | None, typer.Option(help="A preset (trocar tissues list), or a tissue file.toml. Default: skin.")
    ] = None,
    support: Annotated[
        str | None, typer.Option(help="edges, edges+base or base: how the block is held. Default: base.")
    ] = None,
    diameter_mm: Annotated[float | None, typer.Option(help="Diameter of the tool. Default: 6.")] = None,
    peak_n: Annotated[float | None, typer.Option(help="The paper's load. Default: 5.")] = None,
    small_n: Annotated[
        float | None, typer.Option(help="A load that linear theory can bear. Default: 0.05.")
    ] = None,
    quick: Annotated[bool, typer.Option("--quick", help="Coarser meshes, fewer pictures.")] = False,
    preset: Annotated[
        Preset | None,
        typer.Option(help="paper-2014: the paper's formula as printed, beside the corrected one."),
    ] = None,
    data: Annotated[
        Path | None,
        typer.Option(help="Folder of measured sets: adds what models foretell of them to the report."),
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print a summary as JSON alone on stdout.")] = False,
) -> None:
    """Run the validation study and write report, figures, data and ledger."""
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    from trocar.study.conduct import conduct, conduct_paper
    from trocar.study.plan import Plan
    from trocar.units import MILLIMETRE

    command = join(["trocar", *sys.argv[1:]])
    given = {
        "tissue": tissue,
        "support": None if support is None else _support(support),
        "diameter": None if diameter_mm is None else _number("--diameter-mm", diameter_mm) * MILLIMETRE,
        "peak": None if peak_n is None else _number("--peak-n", peak_n),
        "small": None if small_n is None else _number("--small-n", small_n),
        "quick": quick or None,
    }
    asked = {key: value for key, value in given.items() if value is not None}
    if preset is not None:
        if asked or data is not None:
            named = [*asked, *(() if data is None else ("data",))]
            raise typer.BadParameter(
                f"--preset {preset.value} fixes everything; leave out {', '.join(named)}"
            )
        _print_paper(*conduct_paper(out, command=command), as_json=as_json)
        return
    plan = Plan(**asked)  # type: ignore[arg-type]
    percentage = TextColumn("{task.percentage:>3.0f} %")
    columns = (TextColumn("{task.description:<28}"), BarColumn(), percentage, TimeElapsedColumn())
    bars = Progress(*columns, console=Console(stderr=True), transient=True)
    bar = bars.add_task("starting", total=1.0)

    def watch(what: str, share: float) -> None:
        bars.start()  # at the first report of work, so that a refusal before it is one line alone
        bars.update(bar, description=what, completed=share)

    try:
        done = conduct(plan, out, data=data, command=command, watch=watch)
    finally:
        if bars.live.is_started:
            bars.stop()
    if as_json:
        typer.echo(json.dumps(_summary(done), allow_nan=False))
    else:
        _print(done)


def _support(name: str) -> Support:
    from trocar.model import Support

    if name not in tuple(Support):
        raise typer.BadParameter(f"--support: expected {' or '.join(Support)}, got {name!r}")
    return Support(name)


def _number(option: str, value: float) -> float:
    if not (isfinite(value) and value > 0):
        raise typer.BadParameter(f"{option}: expected a finite number above 0, got {value!r}")
    return value


def _summary(done: Conducted) -> dict[str, object]:
    from trocar.study.protocol import REFERENCE
    from trocar.study.writing.measured_results import measured_results
    from trocar.units import MILLIMETRE

    study = done.study
    return {
        "report": str(done.report),
        "tissue": study.plan.tissue,
        "support": study.plan.support.value,
        "small_n": study.plan.small,
        "peak_n": study.plan.peak,
        "max_deflection_mm": {
            layer: float(depth.max()) / MILLIMETRE
            for layer, depth in study.small[REFERENCE].deflection.items()
        },
        "largest_difference": {
            model: {layer: curve.largest_relative_error for layer, curve in layers.items()}
            for model, layers in study.agreement["small"].items()
        },
        "nrmse": {
            model: {layer: curve.nrmse for layer, curve in layers.items()}
            for model, layers in study.agreement["small"].items()
        },
        "cpu_s": {history.model: history.cpu_seconds for history in study.small.histories},
        "compile_s": study.compile_seconds,
        "study_s": study.seconds - study.compile_seconds,
        "writing_s": done.writing_seconds,
        **({} if done.measured is None else {"measured": measured_results(done.measured)}),
    }


def _print(done: Conducted) -> None:
    from rich.console import Console
    from rich.table import Table

    from trocar.study.protocol import JUDGED, REFERENCE
    from trocar.study.report.figures.style import label, three
    from trocar.study.report.table import percent
    from trocar.units import MILLIMETRE

    study = done.study
    console = Console(highlight=False)
    table = Table(title=f"{study.plan.small:g} N on {study.plan.tissue}, support {study.plan.support.value}")
    table.add_column("upper face of")
    for column in ("finite elements, mm", *(f"{label(model)}, largest difference" for model in JUDGED)):
        table.add_column(column, justify="right")
    for layer, depth in study.small[REFERENCE].deflection.items():
        differences = (
            percent(study.agreement["small"][model][layer].largest_relative_error) for model in JUDGED
        )
        table.add_row(layer, three(float(depth.max()) / MILLIMETRE), *differences)
    table.add_section()
    seconds = (f"{three(study.small[model].cpu_seconds)} s" for model in (REFERENCE, *JUDGED))
    table.add_row("processor time", *seconds)
    console.print(table)
    console.print(
        f"compiling {study.compile_seconds:.1f} s, study {study.seconds - study.compile_seconds:.1f} s, "
        f"drawing and writing {done.writing_seconds:.1f} s"
        + ("" if done.measured is None else f", measured tissue {done.measured.seconds:.1f} s")
    )
    for sentence in () if done.measured is None else done.measured.sets.missing:
        console.print(sentence)
    typer.echo(done.report)


def _print_paper(study: PaperStudy, report: Path, *, as_json: bool) -> None:
    from rich.console import Console
    from rich.table import Table

    from trocar.study.report.paper_page import paper_summary, paper_table

    if as_json:
        typer.echo(json.dumps({"report": str(report), **paper_summary(study)}, allow_nan=False))
        return
    said = paper_table(study)
    table = Table(title=said.caption)
    for entry in said.head[:-1]:
        table.add_column(entry)
    for row in said.rows:
        table.add_row(*row[:-1])
    Console(highlight=False).print(table)
    typer.echo(report)
