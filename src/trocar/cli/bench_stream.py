"""`trocar bench stream`: how long a pose takes to the frame that shows its effect, part by part."""

from __future__ import annotations

import json
from typing import Annotated

import typer
from rich import box
from rich.console import Console
from rich.table import Table

_PARTS = (
    ("inward", "client to servo"),
    ("wait", "to the next frame"),
    ("outward", "frame to client"),
    ("total", "all"),
)
_MILLISECOND = 1e-3  # [s]


def stream(
    seconds: Annotated[float, typer.Option(min=1.0, max=600.0, help="How long to measure.")] = 10.0,
    tissue: Annotated[str, typer.Option("--tissue", help="A preset; see trocar tissues list.")] = "skin",
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON alone.")] = False,
) -> None:
    """Send poses to a live trainer from a plain client on loopback, and time them until their frames are there."""
    import numpy as np

    from trocar.web.latency import stream_latency
    from trocar.web.stage import set_stage
    from trocar.web.trainer import Trainer

    log = Console(stderr=True, highlight=False)
    with log.status("starting a trainer ..."):
        trainer = Trainer(set_stage(tissue))
        try:
            trainer.open()
            found = stream_latency(trainer, seconds=seconds)
        finally:
            trainer.close()
    rows = {
        name: {
            "p50_ms": float(np.median(values)) / _MILLISECOND,
            "p99_ms": float(np.percentile(values, 99)) / _MILLISECOND,
            "max_ms": float(values.max()) / _MILLISECOND,
        }
        for name, values in ((name, getattr(found, name)) for name, _ in _PARTS)
    }
    period = found.frame_period / _MILLISECOND
    if as_json:
        typer.echo(json.dumps({"poses": len(found.total), "frame_period_ms": period, **rows}, indent=2))
        return
    table = Table(
        box=box.SIMPLE_HEAD,
        title=f"{len(found.total)} poses, a frame every {period:.2f} ms",
        title_justify="left",
        pad_edge=False,
        show_edge=False,
    )
    table.add_column("ms")
    for column in ("p50", "p99", "max"):
        table.add_column(column, justify="right")
    for name, words in _PARTS:
        table.add_row(words, *(f"{rows[name][key]:.2f}" for key in ("p50_ms", "p99_ms", "max_ms")))
    Console(highlight=False).print(table)
