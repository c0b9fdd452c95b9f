"""trocar records rename and remove: whose records they are."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from trocar.records.rows import Trainee
    from trocar.records.store import Records


def rename(
    old: Annotated[str, typer.Argument(help="The trainee's name.", show_default=False)],
    new: Annotated[str, typer.Argument(help="What it shall be; nobody else's.", show_default=False)],
) -> None:
    """Give a trainee another name, in every attempt and answer."""
    from trocar.records.store import Records

    known_trainee(old)
    with Records.open() as records:
        renamed = records.rename(old, new)
    typer.echo(f"{renamed.name}: {_attempts(renamed.attempts)}")


def remove(
    name: Annotated[str, typer.Argument(help="The trainee's name.", show_default=False)],
    yes: Annotated[bool, typer.Option("--yes", help="Do not ask.")] = False,
) -> None:
    """Remove a trainee with all attempts, recordings, metrics and answers; it cannot be undone."""
    from trocar.errors import InputError
    from trocar.records.store import Records

    found = known_trainee(name)
    what = f"{found.name} with {_attempts(found.attempts)}, recordings and answers"
    if not yes:
        if not sys.stdin.isatty():
            raise InputError("remove", "--yes where nobody can be asked", "none", f"it would remove {what}")
        if not typer.confirm(f"Remove {what}? It cannot be undone."):
            typer.echo("Nothing was removed.")
            return
    with Records.open() as records:
        gone = records.remove(name)
        typer.echo(f"{found.name} was removed with {_attempts(gone)}.")
        for copy in records.older_copies():
            typer.echo(
                f"{copy} is from before the records were brought to their schema, and still names everyone."
            )
        records.give_back_space()


def known_trainee(name: str) -> Trainee:
    """Return the trainee of a name.

    Raises:
        InputError: nobody is called so; the message offers the closest name.
    """
    from trocar.records.store import Records

    with Records.open(writing=False) as records:
        return trainee_of(records, name)


def trainee_of(records: Records, name: str) -> Trainee:
    """Return the trainee of a name, or refuse it as `known_trainee` does."""
    from difflib import get_close_matches

    from trocar.errors import InputError
    from trocar.records.names import as_kept

    known = {trainee.name: trainee for trainee in records.trainees()}
    if as_kept(name) not in known:
        close = get_close_matches(name, known, 1)
        advice = f"did you mean {close[0]}?" if close else "trocar records lists attempts"
        raise InputError("trainee", "one that has records", name, advice)
    return known[as_kept(name)]


def _attempts(count: int) -> str:
    return f"{count} attempt{'' if count == 1 else 's'}"
