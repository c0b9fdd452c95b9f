"""trocar compare: one case through several models."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from trocar.study.compare import Comparison


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command(epilog="Example: trocar compare examples/press.toml --models wave-solid,wave-membrane,fea")(
        compare
    )


def compare(
    case: Annotated[
        Path, typer.Argument(help="A case file in TOML (docs: reference/case-file).", show_default=False)
    ],
    models: Annotated[
        str | None,
        typer.Option(
            help="Models, separated by commas: wave-membrane, wave-solid, wave-mesh, fea, mass-spring, mesh-free. "
            "Default: wave-solid,fea; with a rigid tip wave-solid,wave-membrane; on a mesh wave-mesh, the one "
            "that takes it."
        ),
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON alone on stdout.")] = False,
) -> None:
    """Run one case through several models and print what each says."""
    from rich.console import Console
    from rich.progress import Progress

    from trocar.study.cases.reading import load_case
    from trocar.study.compare import compare as run
    from trocar.study.compare import models_for

    experiment = load_case(case)
    asked = None if models is None else [name.strip() for name in models.split(",") if name.strip()]
    names = models_for(experiment, asked)
    with Progress(console=Console(stderr=True), transient=True) as bars:
        tasks = {name: bars.add_task(name, total=1.0) for name in names}
        result = run(experiment, names, watch=lambda name, share: bars.update(tasks[name], completed=share))
    if as_json:
        typer.echo(json.dumps(result.as_dict()))
    else:
        _print(result)


def _print(result: Comparison) -> None:
    from rich.console import Console
    from rich.table import Table

    from trocar.units import MILLIMETRE

    console = Console()
    case = result.case
    peaks = " and ".join(f"{tool.peak:g}" for tool in case.tools)
    sides = " x ".join(f"{side / MILLIMETRE:g}" for side in case.size)
    held = f"support {case.support.value}" if case.mesh is None else f"{len(case.mesh.cells)} elements"
    console.print(f"[bold]{case.title}[/]: {sides} mm, {held}, peak {peaks} N")
    table = Table()
    table.add_column("largest deflection, mm")
    for history in result.histories:
        table.add_column(history.model, justify="right")
    for layer in case.faces:
        table.add_row(
            layer, *(f"{history.deflection[layer].max() / MILLIMETRE:.4g}" for history in result.histories)
        )
    table.add_section()
    table.add_row("processor time, s", *(f"{history.cpu_seconds:.3g}" for history in result.histories))
    table.add_row("unknowns", *(f"{history.dofs}" for history in result.histories))
    linear = [history for history in result.histories if not history.large_deformation]
    table.add_row(
        "in the linear range",
        *(
            "needs none" if history.large_deformation else "yes" if history.linear_range.inside else "NO"
            for history in result.histories
        ),
    )
    table.add_row(
        "stated for this case", *("NO" if history.departures else "yes" for history in result.histories)
    )
    fits = [history.fit_error for history in result.histories]
    if any(fits):
        table.add_row("misfit", *(f"{100 * fit:.1f} %" if fit else "" for fit in fits))
    console.print(table)
    for history in result.histories:
        for reason in history.departures:
            console.print(f"{history.model} is not stated for this case: {reason}.", style="bold")
    if not all(history.linear_range.inside for history in linear):
        least = min(history.linear_range.force_limit for history in linear)
        whose = (
            f"of {', '.join(history.model for history in linear)} "
            if len(linear) < len(result.histories)
            else ""
        )
        console.print(
            f"Outside the linear range: above {least:.2g} N these numbers {whose}are linear extrapolation, "
            "no prediction.",
            style="bold",
        )
