"""trocar train: the live trainer in a browser."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from trocar.cli.options import options_named
from trocar.errors import InputError

if TYPE_CHECKING:
    from trocar.devices.device import Device
    from trocar.tissues.nodule import Nodule
    from trocar.web.serve import Served

_PORT = 0
_PAGE = "web"
_OPTIONS = {  # what the library calls them
    **{name: f"--{name}" for name in ("tissue", "ports", "model", "mesh", "device", "script", "recording")},
    **{name: f"--{name}" for name in ("task", "level", "skill", "seed")},
    **{name: f"--mesh-{name}" for name in ("unit", "up", "held", "touched")},
    "drop_unused": "--mesh-drop-unused",
    "host": "--listen",
    "cert and key": "--cert and --key",
}


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command(epilog="Example: trocar train --tissue liver --ports oblique")(train)


@options_named(_OPTIONS)
def train(
    tissue: Annotated[
        str, typer.Option(help="A preset (trocar tissues list), or a tissue file.toml.")
    ] = "skin",
    ports: Annotated[
        str, typer.Option(help="Where the ports are: usual, oblique, one-sided, scissors, or a file.toml.")
    ] = "usual",
    model: Annotated[str, typer.Option(help="What moves: wave-membrane or wave-solid.")] = "wave-membrane",
    nodule: Annotated[
        list[str] | None,
        typer.Option(
            metavar="X,Y,DEPTH,RADIUS,KPA",
            help="A stiffer ball in it: its middle, depth and radius [mm], Young's modulus [kPa]; up to four.",
            show_default=False,
        ),
    ] = None,
    mesh: Annotated[
        str | None,
        typer.Option(
            help="An organ in place of the block: liver, or a mesh file, of the tissue's lowest layer.",
            show_default=False,
        ),
    ] = None,
    mesh_unit: Annotated[
        str | None, typer.Option(help="Of the file's lengths: m, cm, mm or um.", show_default="mm")
    ] = None,
    mesh_up: Annotated[
        str | None, typer.Option(help="Which axis of the file looks up, as in +z.", show_default="+z")
    ] = None,
    mesh_held: Annotated[
        str | None, typer.Option(help="The group of its faces that does not move.", show_default="below")
    ] = None,
    mesh_touched: Annotated[
        str | None, typer.Option(help="The group of its faces to press.", show_default="above")
    ] = None,
    mesh_drop_unused: Annotated[
        bool, typer.Option("--mesh-drop-unused", help="Leave out nodes of the file that no element has.")
    ] = False,
    device: Annotated[
        str, typer.Option(help="What moves the instruments: web (the page), simulated, recorded.")
    ] = _PAGE,
    script: Annotated[
        str | None, typer.Option(help="What the simulated hands do.", show_default="press-slide-lift")
    ] = None,
    seed: Annotated[
        int | None, typer.Option(min=0, help="Of the simulated hands' chances.", show_default="0")
    ] = None,
    headless: Annotated[
        bool, typer.Option("--headless", help="Let a scripted trainee do a task, without a browser.")
    ] = False,
    task: Annotated[
        str | None, typer.Option(help="What it does; see trocar tasks.", show_default=False)
    ] = None,
    level: Annotated[int | None, typer.Option(help="Of the task.", show_default="1")] = None,
    skill: Annotated[
        str | None, typer.Option(help="How well: expert or novice.", show_default="expert")
    ] = None,
    real_time: Annotated[bool, typer.Option("--real-time", help="No faster than a person.")] = False,
    out: Annotated[
        Path | None, typer.Option(help="Where the attempt's recording goes.", show_default=False)
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print the score card as JSON alone.")] = False,
    recording: Annotated[
        Path | None, typer.Option(help="What the recorded device plays back.", show_default=False)
    ] = None,
    port: Annotated[int, typer.Option(min=0, max=65535, help="To serve on; 0 takes a free one.")] = _PORT,
    listen: Annotated[
        str,
        typer.Option(help="Address to listen on; another than this machine's own needs --cert and --key."),
    ] = "127.0.0.1",
    cert: Annotated[
        Path | None, typer.Option(help="Certificate chain (PEM), for HTTPS.", show_default=False)
    ] = None,
    key: Annotated[Path | None, typer.Option(help="Its private key (PEM).", show_default=False)] = None,
    no_browser: Annotated[bool, typer.Option("--no-browser", help="Print the address only.")] = False,
) -> None:
    """Press, slide on and lift live tissue with two instruments, in the browser. Ctrl-C ends it."""
    attempted = {
        "task": task,
        "level": level,
        "skill": skill,
        "out": out,
        "real-time": real_time or None,
        "json": as_json or None,
    }
    if headless:
        live = {"tissue": tissue != "skin", "ports": ports != "usual", "model": model != "wave-membrane"}
        live |= {
            "mesh": mesh is not None,
            "nodule": bool(nodule),
            "script": script is not None,
            "recording": recording is not None,
        }
        for option in (option for option, given in live.items() if given):
            raise typer.BadParameter(
                f"--{option} does not go with --headless: the task says what it is done on"
            )
        if device not in (_PAGE, "simulated"):
            raise typer.BadParameter(f"--headless goes with --device simulated alone, not {device}")
        if task is None:
            raise typer.BadParameter("--headless needs --task; trocar tasks lists them")
        options = {"level": level, "skill": skill, "seed": seed}
        _attempt(
            task,
            {name: value for name, value in options.items() if value is not None},
            out,
            real_time,
            as_json,
        )
        return
    for option in (option for option, given in attempted.items() if given is not None):
        raise typer.BadParameter(f"--{option} is for --headless: on the page, tasks are chosen there")

    from trocar.web.address import check_address

    check_address(listen, port, cert, key)  # a mistake is told before what takes seconds to import
    nodules = tuple(_nodule(text) for text in nodule or ())
    reading: dict[str, Any] = {"unit": mesh_unit, "up": mesh_up, "held": mesh_held, "touched": mesh_touched}
    reading["drop_unused"] = mesh_drop_unused or None
    reading = {option: value for option, value in reading.items() if value is not None}
    if mesh is None:
        for option in reading:
            raise typer.BadParameter(f"{_OPTIONS[option]} goes with --mesh")
    elif model != "wave-membrane":
        raise typer.BadParameter("--model is for a block; a mesh moves by its own modes")
    elif device == "simulated":
        raise typer.BadParameter(
            "--device simulated presses a level block; with --mesh take the page's hands"
        )
    else:
        from trocar.waves.mesh.organ_name import check_organ

        check_organ(mesh, **{name: reading[name] for name in ("unit", "up") if name in reading})

    from rich.console import Console

    from trocar.cli.doing import doing
    from trocar.cli.organ import organ_stage
    from trocar.records.store import Records
    from trocar.web.ahead import preparing
    from trocar.web.lessons import Lessons
    from trocar.web.serve import serve
    from trocar.web.stage import set_stage
    from trocar.web.trainer import Trainer

    hands = _device(device, ports, script=script, seed=seed, recording=recording)
    log = Console(stderr=True, highlight=False)
    with doing(log, "laying the tissue and its waves out") as work:
        if mesh is None:
            stage = set_stage(tissue, ports=ports, model=model, nodules=nodules)
        else:
            stage = organ_stage(mesh, tissue, ports, nodules, reading, log, work)
        if stage.tissue.large_deformation:
            log.print(
                "The trainer's waves are linear: of the layers' laws for large strain they take the beginning. "
                "The mark on the bars of force tells how far that is right."
            )
        records = Records.open()
        if records.note:
            log.print(records.note)
        trainer = Trainer(stage, device=hands, lessons=True)
        try:
            work.at("starting the servo; the first time its code is compiled, a minute or so")
            trainer.open()
        except BaseException:
            trainer.close()
            raise

    def ready(served: Served) -> None:
        typer.echo(served.address)
        log.print("The trainer is open. Ctrl-C ends it.")
        if not no_browser:
            _open(served.address)

    lessons = Lessons(trainer, records)
    try:
        with preparing():
            serve(trainer, lessons, on_ready=ready, host=listen, port=port, cert=cert, key=key)
    finally:
        lessons.close()
        trainer.close()
        records.close()
    log.print("The trainer has stopped.")


def _nodule(text: str) -> Nodule:
    """Return the nodule that five numbers tell."""
    from trocar.tissues.nodule import Nodule
    from trocar.units import KILOPASCAL, MILLIMETRE

    try:
        x, y, depth, radius, modulus = map(float, text.split(","))
    except ValueError:
        raise InputError(
            "--nodule",
            "five numbers between commas: x, y, depth and radius [mm], Young's modulus [kPa]",
            text,
            "as in --nodule 30,30,8,5,300",
        ) from None
    return Nodule(
        x=x * MILLIMETRE,
        y=y * MILLIMETRE,
        depth=depth * MILLIMETRE,
        radius=radius * MILLIMETRE,
        young_modulus=modulus * KILOPASCAL,
    )


def _device(name: str, ports: str, **given: Any) -> Device | None:
    """Make the device named; None is the page's hands."""
    from trocar.contact.port_sets import instruments_through
    from trocar.devices.catalogue import device, entry
    from trocar.simulation.live import LIVE_SIZE

    options = {option: value for option, value in given.items() if value is not None}
    entry(name)
    if name == _PAGE:
        for option in options:
            raise typer.BadParameter(f"--{option} is for devices other than web")
        return None
    if name == "simulated":
        options["instruments"] = instruments_through(ports, LIVE_SIZE)
    return device(name, **options)


def _attempt(task: str, options: dict[str, Any], out: Path | None, real_time: bool, as_json: bool) -> None:
    """Let a scripted trainee do a task and print the score card."""
    from rich.console import Console
    from rich.progress import Progress

    from trocar.cli.score_card import print_card
    from trocar.records.scripted import attempt_on_record
    from trocar.records.store import Records
    from trocar.training.tape import write_attempt

    with Records.open() as records, Progress(console=Console(stderr=True), transient=True) as bar:
        work = bar.add_task(task, total=None)
        done = attempt_on_record(
            records,
            task,
            real_time=real_time,
            watch=lambda time, limit: bar.update(work, completed=time, total=limit),
            **options,
        )
    if out is not None:
        write_attempt(out, done.recording)
    print_card(
        done.card,
        done.task.marking.pass_score,
        as_json=as_json,
        besides={"skill": done.skill, "seed": done.seed},
    )


def _open(address: str) -> None:
    """Open a browser, and do not wait for it: `on_ready` has to be quick."""
    import threading
    import webbrowser

    threading.Thread(target=webbrowser.open, args=(address,), daemon=True).start()
