"""trocar devices: what can move the instruments; test one, record one."""

from __future__ import annotations

import json
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from collections.abc import Callable

    from rich.table import Table

    from trocar.devices.examination import Findings

AsJson = Annotated[bool, typer.Option("--json", help="Print JSON alone on stdout.")]
Seed = Annotated[
    int | None, typer.Option(min=0, help="Of the simulated hands' tremor and noise.", show_default="0")
]
Tremor = Annotated[
    float | None, typer.Option(help="Of the simulated handles, root mean square.", show_default="0.1")
]
Noise = Annotated[
    float | None, typer.Option(help="Of the simulated sensors, standard deviation.", show_default="0.01")
]

_WHILE = 5.0  # [s] that hands without an end are read for


def register(app: typer.Typer) -> None:
    """Add `trocar devices`."""
    group = typer.Typer(help="List what can move the instruments, test a device, record the simulated one.")
    group.callback(invoke_without_command=True, epilog="Example: trocar devices --json")(list_devices)
    group.command("test", epilog="Example: trocar devices test simulated --script press --seed 3")(try_out)
    group.command(epilog="Example: trocar devices record press-slide-lift --out press-slide-lift.csv")(record)
    app.add_typer(group, name="devices")


def list_devices(context: typer.Context, as_json: AsJson = False) -> None:
    """List the devices: what each is and whether it is there. Then test one, or record the simulated one."""
    if context.invoked_subcommand is not None:
        if as_json:
            raise typer.BadParameter(f"--json stands behind {context.invoked_subcommand}")
        return
    from rich.console import Console

    from trocar.devices.catalogue import DEVICES

    if as_json:
        _print_json([entry.as_dict() for entry in DEVICES.values()])
        return
    table = _table("device", "what it is", "steered by", "there")
    for entry in DEVICES.values():
        steered = "the page" if entry.steered_by_page else "itself"
        table.add_row(entry.name, entry.description, steered, entry.missing or "yes")
    Console(highlight=False).print(table)


def try_out(
    name: Annotated[str, typer.Argument(help="Which device; trocar devices lists them.", show_default=False)],
    script: Annotated[
        str | None,
        typer.Option(
            help="What the simulated hands do: press, slide, lift, press-slide-lift.",
            show_default="press-slide-lift",
        ),
    ] = None,
    seed: Seed = None,
    tremor_mm: Tremor = None,
    noise_mm: Noise = None,
    recording: Annotated[
        Path | None, typer.Option(help="What the recorded device plays back.", show_default=False)
    ] = None,
    seconds: Annotated[
        float | None, typer.Option(help="Of the device's own time.", show_default="all of it, or 5")
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Read a device at 1 kHz of its own time with the usual instruments, and check every pose.

    Ends with 1 where a pose is one that the trainer could not use.
    """
    from rich.console import Console

    from trocar.contact.instrument import default_instruments
    from trocar.devices.catalogue import device
    from trocar.devices.examination import LONGEST, examine
    from trocar.devices.simulated import USUAL_SIZE
    from trocar.errors import TrocarError

    made = device(name, **_given(script, seed, tremor_mm, noise_mm), **_only(recording=recording))
    usual = min(made.duration, LONGEST) if isfinite(made.duration) else _WHILE
    asked = usual if seconds is None else seconds
    found = examine(made, default_instruments(USUAL_SIZE), USUAL_SIZE, asked)
    complaints = [complaint for each in found for complaint in each.complaints]
    if as_json:
        _print_json(
            {
                "device": name,
                "seconds": asked,
                "passed": not complaints,
                "instruments": [each.as_dict() for each in found],
            }
        )
    else:
        Console(highlight=False).print(_findings_table(found))
        for complaint in complaints:
            typer.echo(complaint)
        if not any(each.present for each in found):
            typer.echo("No instrument was in the hand. The web device waits for a page.")
    if complaints:
        raise TrocarError(f"the {name} device gives poses that the trainer cannot use: {complaints[0]}")


def record(
    script: Annotated[
        str, typer.Argument(help="press, slide, lift or press-slide-lift.", show_default=False)
    ],
    out: Annotated[Path, typer.Option(help="The recording to write.", show_default=False)],
    seed: Seed = None,
    tremor_mm: Tremor = None,
    noise_mm: Noise = None,
    rate_hz: Annotated[float, typer.Option(help="Moments in a second.")] = 50.0,
) -> None:
    """Write what the simulated hands do as a recording that the recorded device plays back."""
    from trocar.devices.catalogue import device
    from trocar.devices.recorder import moments_of, thinned
    from trocar.devices.recording import write_recording

    made = device("simulated", **_given(script, seed, tremor_mm, noise_mm))
    write_recording(out, thinned(moments_of(made, seconds=made.duration, rate=rate_hz)))
    typer.echo(f"{out}: {made.duration:g} s of {script}")


def _given(
    script: str | None, seed: int | None, tremor_mm: float | None, noise_mm: float | None
) -> dict[str, Any]:
    """Return the options that were given, in SI, as the simulated device takes them."""
    from trocar.units import MILLIMETRE

    return _only(
        script=script,
        seed=seed,
        tremor=None if tremor_mm is None else tremor_mm * MILLIMETRE,
        noise=None if noise_mm is None else noise_mm * MILLIMETRE,
    )


def _only(**options: Any) -> dict[str, Any]:
    return {option: value for option, value in options.items() if value is not None}


def _print_json(content: object) -> None:
    typer.echo(json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False))


def _table(*columns: str) -> Table:
    from rich import box
    from rich.table import Table

    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, show_edge=False)
    for column in columns:
        table.add_column(column, overflow="fold")
    return table


def _findings_table(found: tuple[Findings, Findings]) -> Table:
    from trocar.units import MILLIMETRE

    table = _table("", *(each.instrument for each in found))
    for column in table.columns[1:]:
        column.justify = "right"
    rows: tuple[tuple[str, Callable[[Findings], str]], ...] = (
        ("in the hand, share of the time", lambda f: f"{100 * f.present:.0f} %"),
        ("changes of the pose in a second", lambda f: f"{f.changes:.0f}"),
        ("fastest tip, mm/s", lambda f: f"{f.fastest_tip / MILLIMETRE:.1f}"),
        ("fastest handle, mm/s", lambda f: f"{f.fastest_handle / MILLIMETRE:.1f}"),
        ("lowest tip, mm", lambda f: "" if f.lowest_tip is None else f"{f.lowest_tip / MILLIMETRE:.2f}"),
        ("jaw, least to largest", lambda f: "" if f.jaw is None else f"{f.jaw[0]:.2g} to {f.jaw[1]:.2g}"),
    )
    for name, text in rows:
        table.add_row(name, *(text(each) for each in found))
    return table
