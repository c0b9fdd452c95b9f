"""The command line: one file per command, each of which parses, calls one library function and renders.

A module of this package that has a function `register(app)` is a command; nothing else needs editing::

    def register(app: typer.Typer) -> None:
        app.command(epilog="Example: trocar compare case.toml --models wave-solid,fea")(compare)

Import the library inside the command, not above it, so that `trocar --help` stays quick. Raise `InputError`
for what the user got wrong; `exits` turns every error into one line and an exit code. With `--json`, print
JSON alone on stdout and all else on stderr.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from importlib import import_module
from pkgutil import iter_modules
from typing import Annotated

import typer

from trocar import __version__
from trocar.cli.exits import run

PROGRAM = "trocar"


def application() -> typer.Typer:
    """Return a fresh application with every command of this package registered."""
    app = typer.Typer(
        name=PROGRAM,
        help="Soft tissue as waves, and the laboratory that shows how far it can be trusted.",
        no_args_is_help=True,
        add_completion=False,
        pretty_exceptions_enable=False,
        context_settings={"help_option_names": ["-h", "--help"]},
    )
    app.callback()(_options)
    for module in iter_modules(__path__):
        register = getattr(import_module(f"{__name__}.{module.name}"), "register", None)
        if register is not None:
            register(app)
    return app


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit code, one of those in `trocar.cli.exits`.

    Args:
        arguments: what stands after the program's name; None takes them from the process.
    """
    # Linear algebra is many small steps here, and threads wait for each other longer than they work: with two of them a
    # liver's surface takes eight times as long. OpenBLAS reads this when numpy is imported, which commands do.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    command = typer.main.get_command(application())
    return run(command, PROGRAM, sys.argv[1:] if arguments is None else arguments)


def _print_version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"{PROGRAM} {__version__}")
        raise typer.Exit


def _options(
    version: Annotated[
        bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    """Take the options that stand before a command."""
