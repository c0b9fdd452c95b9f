"""trocar records: what was attempted, by whom and how well; one attempt, a learning curve, exports, opinions."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from trocar.cli.records_shown import print_attempt, print_attempts, print_history, print_opinions, say
from trocar.cli.records_trainees import remove, rename, trainee_of

if TYPE_CHECKING:
    from trocar.records.store import Records

AsJson = Annotated[bool, typer.Option("--json", help="Print JSON alone on stdout.")]
Trainee = Annotated[str | None, typer.Option(help="Whose attempts alone.", show_default=False)]
STDOUT = Path("-")


def register(app: typer.Typer) -> None:
    """Add `trocar records`."""
    group = typer.Typer(help="List attempts, oldest first; show one, a learning curve, exports, opinions.")
    group.callback(invoke_without_command=True, epilog="Example: trocar records --trainee Anna --json")(
        list_attempts
    )
    group.command(epilog="Example: trocar records show 7 --json")(show)
    group.command(epilog="Example: trocar records history Anna palpate --level 2")(history)
    group.command(epilog="Example: trocar records export --csv attempts.csv --pseudonymous")(export)
    group.command(epilog="Example: trocar records opinions --group-a novice --group-b expert")(opinions)
    group.command(epilog="Example: trocar records rename Ana Anna")(rename)
    group.command(epilog="Example: trocar records remove Anna --yes")(remove)
    app.add_typer(group, name="records")


def list_attempts(
    context: typer.Context,
    trainee: Trainee = None,
    task: Annotated[str | None, typer.Option(help="Attempts at it alone.", show_default=False)] = None,
    as_json: AsJson = False,
) -> None:
    """List attempts, oldest first, also while one runs. Then show one, a learning curve, exports, opinions."""
    if context.invoked_subcommand is not None:
        given = {"json": as_json, "trainee": trainee, "task": task}
        for option in (option for option, value in given.items() if value):
            raise typer.BadParameter(f"--{option} stands behind {context.invoked_subcommand}, if it takes it")
        return
    with _opened() as records:
        found = records.attempts(trainee=trainee, task=task)
        if as_json:
            _print_json([row.as_dict() for row in found])
            return
        if not found:
            _say_what_to_do(records, trainee, task)
            return
    print_attempts(found)


def show(
    number: Annotated[int, typer.Argument(metavar="ID", help="Of the attempt; trocar records lists them.")],
    as_json: AsJson = False,
) -> None:
    """Print an attempt with its score card."""
    with _opened() as records:
        kept = records.attempt(number)
    if as_json:
        _print_json(kept.as_dict())
    else:
        print_attempt(kept)


def history(
    name: Annotated[str, typer.Argument(help="Of the trainee.", show_default=False)],
    task: Annotated[str, typer.Argument(help="Which was attempted.", show_default=False)],
    level: Annotated[int, typer.Option(help="Of the task.")] = 1,
    as_json: AsJson = False,
) -> None:
    """Print a trainee's learning curve at a task: scores, the CUSUM chart, and what remains."""
    with _opened() as records:
        found = records.history(trainee_of(records, name).name, task, level)
        if not found.rows and not records.attempts(task=task):  # of a task of one's own there are some
            from trocar.training.tasks.catalogue import task as known_task

            known_task(task, level)
    if as_json:
        _print_json(found.as_dict())
    else:
        print_history(found)


def export(
    csv: Annotated[
        Path | None,
        typer.Option(help="A table, one row for each attempt, goes there; - is stdout.", show_default=False),
    ] = None,
    xapi: Annotated[
        Path | None,
        typer.Option(help="xAPI statements, one JSON array, go there; - is stdout.", show_default=False),
    ] = None,
    recording: Annotated[
        Path | None,
        typer.Option(help="The recording of --attempt, every tick, goes there.", show_default=False),
    ] = None,
    attempt: Annotated[
        int | None, typer.Option(help="With --recording: number of the attempt.", show_default=False)
    ] = None,
    trainee: Trainee = None,
    pseudonymous: Annotated[bool, typer.Option("--pseudonymous", help="Numbers instead of names.")] = False,
    home_page: Annotated[
        str | None,
        typer.Option(
            help="With --xapi: address of whose the names are.", show_default="https://trocar.invalid/"
        ),
    ] = None,
) -> None:
    """Write attempts and their metrics for a spreadsheet or a learning record store, or one attempt's recording."""
    from trocar.records.tidy import ABOUT, table
    from trocar.records.xapi import HOME_PAGE, statements

    if [csv, xapi, recording].count(None) != 2:
        raise typer.BadParameter("expected one of --csv, --xapi and --recording")
    if (recording is None) != (attempt is None):
        raise typer.BadParameter("--recording and --attempt go together")
    if recording is not None and attempt is not None:
        if trainee is not None or pseudonymous or home_page is not None:
            raise typer.BadParameter("a recording names nobody: it takes --attempt alone")
        _write_recording(recording, attempt)
        return
    if xapi is None and home_page is not None:
        raise typer.BadParameter("--home-page is for --xapi")
    with _opened() as records:
        name = None if trainee is None else trainee_of(records, trainee).name
        rows, metrics = records.attempts(trainee=name), records.metrics()
    if csv is not None:
        _write(csv, table(rows, metrics, pseudonymous=pseudonymous), ",".join(ABOUT), "attempt", len(rows))
        return
    made = statements(rows, metrics, home_page=home_page or HOME_PAGE, pseudonymous=pseudonymous)
    text = json.dumps(made, indent=2, allow_nan=False) + "\n"
    _write(xapi or STDOUT, text, '[\n  {\n    "id": "' if made else "[]", "statement", len(made))


def opinions(
    group_a: Annotated[
        str, typer.Option(help="The first of the two groups that are compared: novice, resident or expert.")
    ] = "novice",
    group_b: Annotated[str, typer.Option(help="The second.")] = "expert",
    as_json: AsJson = False,
) -> None:
    """Print what trainees think of the trainer: each item's median and quartiles, and how two groups differ."""
    from trocar.records.opinions import consistency, differences, middles
    from trocar.records.questionnaire import ITEMS

    with _opened() as records:
        sheets = records.answers()
    between = differences(sheets, group_a, group_b)
    lie, together = middles(sheets), consistency(sheets)
    if as_json:
        _print_json(
            {
                "items": dict(ITEMS),
                "answers": [one.as_dict() for one in lie],
                "cronbach_alpha": together.as_dict(),
                "group_a": group_a,
                "group_b": group_b,
                "differences": [one.as_dict() for one in between],
            }
        )
        return
    if not sheets:
        say("Nobody has answered yet. The trainer asks after an attempt.")
        return
    print_opinions(lie, together, between, group_a, group_b)


def _opened() -> Records:
    from trocar.records.store import Records

    return Records.open(writing=False)


def _write(out: Path, text: str, beginning: str, what: str, how_many: int) -> None:
    from trocar.records.export import write_export

    if out == STDOUT:
        typer.echo(text, nl=False)
        return
    write_export(out, text, beginning)
    typer.echo(f"{out}: {how_many} {what}{'' if how_many == 1 else 's'}")


def _write_recording(out: Path, number: int) -> None:
    from trocar.training.strip import recorded
    from trocar.training.tape import write_attempt

    with _opened() as records:
        row, kept = records.attempt(number).row, recorded(*records.chunks(number))
    write_attempt(out, kept)
    seconds = len(kept.poses) * kept.dt
    typer.echo(f"{out}: attempt {number}, {seconds:.1f} s, {row.task}, level {row.level}")


def _say_what_to_do(records: Records, trainee: str | None, task: str | None) -> None:
    """Say why the list is empty."""
    known = records.attempts()
    if not known:
        say(f"No attempts yet in {records.path.parent}.", "Start one: trocar train")
        return
    asked = " and ".join(
        f"{kind} {name}" for kind, name in (("trainee", trainee), ("task", task)) if name is not None
    )
    names = ", ".join(dict.fromkeys(row.trainee for row in known))
    tasks = ", ".join(dict.fromkeys(row.task for row in known))
    say(f"No attempts of {asked}.", f"There are some of trainees {names} and tasks {tasks}.")


def _print_json(content: object) -> None:
    typer.echo(json.dumps(content, indent=2, allow_nan=False))
