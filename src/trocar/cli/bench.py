"""`trocar bench`: what a step costs on this machine, how the servo keeps time, and what finite elements cost."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import TYPE_CHECKING, Annotated

import typer
from rich import box
from rich.console import Console
from rich.table import Table

from trocar.cli.bench_models import models
from trocar.cli.bench_servo import servo
from trocar.cli.bench_stream import stream
from trocar.errors import InputError

if TYPE_CHECKING:
    from trocar.study.cost.equal_error import EqualError
    from trocar.study.cost.tick_cost import TickCost

AsJson = Annotated[bool, typer.Option("--json", help="Print JSON alone.")]
TissueName = Annotated[
    str, typer.Option("--tissue", help="A preset (trocar tissues list), or a tissue file.toml.")
]
_SIZE = (0.06, 0.06)  # [m] the paper's block
_TOLERANCE = 1e-4  # of what a live tip feels; the trainer's (`simulation.scene.TOLERANCE`)
_TOLERANCE_RANGE = (1e-8, 0.1)  # below, the modes no longer fit into memory
_DIAMETER_RANGE_MM = (2.0, 30.0)  # on the block of 60 mm
_TIP_RANGE_MM = (2.0, 12.0)
_DYNAMIC = (0.01, 0.005, 0.003)  # tolerances; below the last, steps of 1 ms cannot follow the force
_STATIC = (0.01, 0.005, 0.001)


def register(app: typer.Typer) -> None:
    """Add `trocar bench` to an application."""
    group = typer.Typer(no_args_is_help=True, help="Measure what steps cost on this machine.")
    group.command("step", epilog="Example: trocar bench step --diameter-mm 8")(step)
    group.command("cost", epilog="Example: trocar bench cost --quick")(cost)
    group.command("models", epilog="Example: trocar bench models --quick --figure models.png")(models)
    group.command("servo", epilog="Example: trocar bench servo --seconds 60 --rounds 5")(servo)
    group.command("stream", epilog="Example: trocar bench stream --seconds 30")(stream)
    app.add_typer(group, name="bench", epilog="Example: trocar bench step")


def step(
    diameters_mm: Annotated[
        list[float] | None,
        typer.Option("--diameter-mm", help="Of both tips; may be repeated. Default: 4, 6, 8."),
    ] = None,
    tolerance: Annotated[
        float, typer.Option(help="Relative error that the modes are chosen for.")
    ] = _TOLERANCE,
    tissue: TissueName = "skin",
    as_json: AsJson = False,
) -> None:
    """Time one 1 ms tick of the live trainer with two sliding tips, beside the machine's floor and other steps."""
    from trocar.study.cost.tick_cost import tick_cost
    from trocar.study.cost.warm_up import compile_steps
    from trocar.tissues.catalogue import tissue as preset

    _within("--tolerance", tolerance, *_TOLERANCE_RANGE)
    for diameter in diameters_mm or ():
        _within("--diameter-mm", diameter, *_TIP_RANGE_MM)
    layers = preset(tissue).linearised
    compiled = compile_steps()
    costs = [
        tick_cost(layers, size=_SIZE, radius=5e-4 * diameter, tolerance=tolerance)
        for diameter in diameters_mm or (4.0, 6.0, 8.0)
    ]
    if as_json:
        _print_json({"compile_s": compiled, "ticks": [cost.as_dict() for cost in costs]})
        return
    Console(highlight=False).print(
        _tick_table(costs), f"\ncompiled code ready after {compiled:.2f} s", sep="\n"
    )


def cost(
    tissue: TissueName = "skin",
    diameter_mm: Annotated[float, typer.Option(help="Of the flat tool in the middle.")] = 6.0,
    quick: Annotated[
        bool, typer.Option("--quick", help="Coarser reference, fewer meshes, 1 % alone.")
    ] = False,
    as_json: AsJson = False,
) -> None:
    """Compare waves and finite elements at equal measured error: a dynamic press, the study's static load."""
    from trocar.model import Press
    from trocar.study.cost.equal_error import dynamic_press, static_study
    from trocar.study.cost.warm_up import compile_steps
    from trocar.tissues.catalogue import tissue as preset

    _within("--diameter-mm", diameter_mm, *_DIAMETER_RANGE_MM)
    layers = preset(tissue).linearised
    compiled = compile_steps()
    tool = Press(x=_SIZE[0] / 2, y=_SIZE[1] / 2, radius=5e-4 * diameter_mm, force=0.1)
    dynamic, static = (_DYNAMIC[:1], _STATIC[:1]) if quick else (_DYNAMIC, _STATIC)
    results = {
        "dynamic": dynamic_press(layers, tool, size=_SIZE, tolerances=dynamic, quick=quick),
        "static": static_study(layers, tool.with_force(5.0), size=_SIZE, tolerances=static, quick=quick),
    }
    if as_json:
        found = {name: [result.as_dict() for result in rows] for name, rows in results.items()}
        _print_json({"compile_s": compiled, **found})
        return
    console = Console(highlight=False)
    for name, rows in results.items():
        console.print(_cost_table(rows, dynamic=name == "dynamic"))
        console.print(
            f"finite elements solved by {rows[0].fea.solver}; the finest lie {100 * rows[0].converged:.2g} % "
            "from the converged waves\n"
        )
    console.print(
        "CPU time. setting: modes a side of the waves (/ moving ones / Ritz vectors), elements a radius / growth of "
        f"finite elements, and the step.\ncompiled code ready after {compiled:.2f} s"
    )


def _within(flag: str, value: float, low: float, high: float) -> None:
    if not low <= value <= high:
        raise InputError(flag, f"a number from {low:g} to {high:g}", value)


def _print_json(content: object) -> None:
    typer.echo(json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False))


def _table(title: str) -> Table:
    return Table(box=box.SIMPLE_HEAD, title=title, title_justify="left", pad_edge=False, show_edge=False)


def _tick_table(costs: list[TickCost]) -> Table:
    table = _table("one tick of 1 ms, two tips that slide, CPU time")
    table.add_column("tips of")
    for one in costs:
        table.add_column(f"{one.diameter_mm:g} mm", justify="right")
    rows: tuple[tuple[str, Callable[[TickCost], str]], ...] = (
        ("modes x layers", lambda c: f"{c.modes} x {c.layers}"),
        ("error against all modes", lambda c: f"{c.error:.1e}"),
        ("points that press", lambda c: f"{c.pressing:.0f}"),
        ("tick in a compiled loop, median", lambda c: f"{c.tick_us:.1f} us"),
        ("the same, least of the repeats", lambda c: f"{c.tick_least_us:.1f} us"),
        ("the same, tips close together", lambda c: f"{c.together_us:.1f} us"),
        ("the same, 20 s after release", lambda c: f"{c.released_us:.1f} us"),
        ("tick called from Python, wall, median", lambda c: f"{c.call_us:.1f} us"),
        ("the same, 99th percentile", lambda c: f"{c.call_p99_us:.1f} us"),
        ("pass of an empty compiled loop", lambda c: f"{c.empty_us:.4f} us"),
        ("read and written", lambda c: f"{c.kilobytes:.0f} kB"),
        ("triad of that size", lambda c: f"{c.triad_gb_s:.0f} GB/s"),
        ("memory floor", lambda c: f"{c.floor_us:.1f} us"),
        ("tick over floor", lambda c: f"{c.tick_us / c.floor_us:.1f}"),
        ("WaveMembrane.step and read-out", lambda c: f"{c.python_us:.0f} us"),
        ("that over tick", lambda c: f"{c.python_us / c.tick_us:.0f}"),
        ("prefactored finite-element step", lambda c: f"{c.fea_us:.0f} us"),
        ("its unknowns, solver", lambda c: f"{c.fea_dofs}, {c.fea_solver}"),
        ("that over tick", lambda c: f"{c.fea_us / c.tick_us:.0f}"),
        ("set-up of the scene", lambda c: f"{c.set_up_s:.2f} s"),
    )
    for name, text in rows:
        table.add_row(name, *(text(one) for one in costs))
    return table


def _cost_table(results: tuple[EqualError, ...], *, dynamic: bool) -> Table:
    table = _table(results[0].case)
    spent = "us per ms" if dynamic else "ms in all"
    for name in ("allowed", "model", "setting", "error", "unknowns", "set-up", spent, "ratio"):
        left = name in ("model", "setting")
        table.add_column(name, justify="left" if left else "right", no_wrap=True)
    for result in results:
        for trial in (result.wave, result.fea):
            first = trial is result.wave
            step = f", {trial.dt_ms:g} ms" if dynamic else ""
            table.add_row(
                f"{100 * result.tolerance:g} %" if first else "",
                "waves" if first else "fea",
                trial.setting + step,
                f"{100 * trial.error:.2g} %",
                str(trial.dofs),
                f"{1e3 * trial.set_up_s:.0f} ms" if dynamic else "within",
                f"{trial.step_us / trial.dt_ms:.2f}" if dynamic else f"{1e-3 * trial.step_us:.2f}",
                "" if first else f"{result.ratio:.0f}",
            )
    return table
