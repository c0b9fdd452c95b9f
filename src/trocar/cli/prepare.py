"""trocar prepare: compile what the trainer needs, so that nobody waits for it later."""

from __future__ import annotations

import typer


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command(epilog="Example: trocar prepare && trocar train")(prepare)


def prepare() -> None:
    """Compile what the trainer's tasks need, once: some minutes. The trainer does it too, beside its work."""
    from rich.console import Console

    from trocar.cli.doing import doing
    from trocar.web.ahead import prepare as compile_everything

    log = Console(stderr=True, highlight=False)
    with doing(log, "compiling") as work:
        compile_everything(work.at)
    log.print("Every task begins within seconds now.")
