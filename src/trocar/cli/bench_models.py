"""`trocar bench models`: accuracy against cost, every model from coarse to fine."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich import box
from rich.console import Console
from rich.progress import Progress
from rich.table import Table

from trocar.errors import InputError

if TYPE_CHECKING:
    from trocar.study.cost.accuracy import Point

_DIAMETER_RANGE_MM = (5.0, 12.0)  # the fitted membranes' tools
_QUICK = 2  # resolutions of each model
_FIGURES = (".png", ".svg", ".pdf")


def models(
    tissue: Annotated[
        str, typer.Option("--tissue", help="A preset (trocar tissues list), or a tissue file.toml.")
    ] = "skin",
    diameter_mm: Annotated[float, typer.Option(help="Of the flat tool in the middle.")] = 8.0,
    case: Annotated[
        list[str] | None,
        typer.Option("--case", help="static, dynamic or large force; may be repeated. Default: all."),
    ] = None,
    figure: Annotated[
        Path | None, typer.Option("--figure", help="Draw it too: a file.png, .svg or .pdf.")
    ] = None,
    quick: Annotated[bool, typer.Option("--quick", help="The two coarsest of each model alone.")] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON alone.")] = False,
) -> None:
    """Run every model from coarse to fine and print its error against finite elements and its cost."""
    from trocar.study.cost.accuracy import CASES, accuracy_against_cost
    from trocar.study.cost.warm_up import compile_models
    from trocar.study.stiffening import Dent
    from trocar.tissues.catalogue import tissue as preset

    for name in case or ():
        if name not in CASES:
            raise InputError("--case", f"one of {', '.join(CASES)}", name)
    if not _DIAMETER_RANGE_MM[0] <= diameter_mm <= _DIAMETER_RANGE_MM[1]:
        low, high = _DIAMETER_RANGE_MM
        raise InputError("--diameter-mm", f"a number from {low:g} to {high:g}", diameter_mm)
    if figure is not None and figure.suffix not in _FIGURES:
        raise InputError("--figure", f"a file that ends in {', '.join(_FIGURES)}", str(figure))
    dent = Dent(name=tissue, tissue=preset(tissue), diameter=1e-3 * diameter_mm)
    with Progress(console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("compiling", total=1.0)
        compile_models()
        points = list(
            accuracy_against_cost(
                dent,
                cases=case or CASES,
                rungs=_QUICK if quick else None,
                watch=lambda what, share: bar.update(task, description=what, completed=share),
            )
        )
    if figure is not None:
        _draw(points, figure)
    if as_json:
        typer.echo(json.dumps([point.as_dict() for point in points], indent=2, allow_nan=False))
        return
    console = Console(highlight=False)
    for name in case or CASES:
        console.print(_table(name, [point for point in points if point.case == name]))
    for point in points:
        if point.failure:
            console.print(f"{point.case}, {point.model}, {point.setting}: {point.failure}")


def _draw(points: list[Point], path: Path) -> None:
    from trocar.study.report.figures.accuracy import accuracy_figure
    from trocar.study.report.figures.style import settings
    from trocar.whole_file import whole

    with settings(), whole(path) as partial:
        accuracy_figure(points).savefig(partial, dpi=160, format=path.suffix.removeprefix("."))


def _table(case: str, points: list[Point]) -> Table:
    table = Table(box=box.SIMPLE_HEAD, title=case, title_justify="left", pad_edge=False, show_edge=False)
    for name in ("model", "setting", "error", "s a simulated second", "set-up", "unknowns"):
        table.add_column(name, justify="left" if name in ("model", "setting") else "right", no_wrap=True)
    for point in points:
        if point.error is None:
            table.add_row(point.model, point.setting, "none", "", f"{point.set_up_s:.2g} s", "")
            continue
        table.add_row(
            point.model,
            point.setting,
            f"{100 * point.error:.2g} %",
            f"{point.second_s:.3g}",
            f"{point.set_up_s:.2g} s",
            str(point.dofs),
        )
    return table
