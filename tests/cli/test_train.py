"""`trocar train` as a user starts and ends it: one address on stdout, and nothing left behind however it ends."""

import os
import signal
import socket
import sys
from pathlib import Path
from urllib.parse import urlsplit
from urllib.request import urlopen

import pytest

from live_process import training
from trocar.cli import main
from trocar.contact.port_sets import PORT_SETS, USUAL
from web.visitor import until

PATIENCE = 240.0  # [s]: the first start compiles, on a machine that does other things
RECORDING = Path(__file__).parents[2] / "examples" / "press-slide-lift.csv"


def children(number):
    """Return the processes a process has started that still run."""
    path = Path(f"/proc/{number}/task/{number}/children")
    return [int(word) for word in path.read_text().split()] if path.exists() else []


def runs(number):
    """Return whether a process runs; a zombie does not."""
    try:
        return Path(f"/proc/{number}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except (FileNotFoundError, ProcessLookupError):
        return False


@pytest.mark.parametrize("ending", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGKILL])
def test_however_it_ends_nothing_stays_behind(ending):
    with training("--device", "recorded", "--recording", str(RECORDING)) as (process, address):
        parts = urlsplit(address)
        assert parts.hostname == "127.0.0.1"
        assert parts.query.startswith("token=")
        with urlopen(f"http://{parts.netloc}/healthz", timeout=10) as answer:
            assert answer.status == 200
        servos = children(process.pid)
        assert servos
        if ending is signal.SIGINT:
            os.killpg(process.pid, ending)  # as a terminal does it: to all of them
        else:
            process.send_signal(ending)
        code = process.wait(PATIENCE)
        assert code == (-ending if ending is signal.SIGKILL else 0)
        until(lambda: not any(map(runs, servos)), PATIENCE)
        out, err = process.communicate()
        assert out == ""  # the address was all
        assert "Traceback" not in err


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--tissue", "granite"], "--tissue: expected one of"),
        (["--model", "fea"], "wave-membrane or wave-solid"),
        (["--ports", "oblik"], "did you mean oblique?"),
        (["--mesh", "kidney"], "liver, or a file that ends in"),
        (["--mesh", "liver", "--tissue", "liver", "--ports", "oblik"], "did you mean oblique?"),
        (["--mesh", "none.stl"], "a mesh file that can be read"),
        (["--mesh-up", "+y"], "--mesh-up goes with --mesh"),
        (["--mesh", "liver", "--nodule", "1,1,8,5,300"], "a place over the organ"),
        (["--mesh", "liver", "--model", "wave-solid"], "--model is for a block"),
        (["--mesh", "liver", "--device", "simulated"], "presses a level block"),
        (["--headless", "--task", "palpate", "--mesh", "liver"], "--mesh does not go with --headless"),
        (["--device", "phantom"], "expected one of simulated, recorded, web"),
        (["--device", "recorded"], "recording"),
        (["--device", "recorded", "--recording", "none.csv"], "none.csv"),
        (["--device", "recorded", "--script", "press", "--recording", str(RECORDING)], "script"),
        (["--device", "simulated", "--script", "juggle"], "juggle"),
        (["--script", "press"], "--script is for devices other than web"),
        (["--mesh-drop-unused"], "--mesh-drop-unused goes with --mesh"),
        (["--listen", "192.0.2.1"], "--listen: expected this machine alone without cert and key"),
        (["--listen", "0.0.0.0"], "one address of this machine"),
        (["--cert", "none.pem"], "both or neither"),
        (["--port", "70000"], "70000"),
        (["--nodule", "30,30,8"], "five numbers between commas"),
        (["--nodule", "30,30,5,8,300"], "less than its depth"),
        (["--nodule", "30,30,8,4,1"], "a nodule stiffer than fat"),
    ],
)
def test_mistakes_are_refused_before_anything_is_started(options, words, capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "200")
    code = main(["train", "--no-browser", *options])
    out, err = capsys.readouterr()
    assert (code, out) == (2, "")
    assert words in " ".join(err.split())
    assert "Traceback" not in err


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--mesh", "none.stl"], "a mesh file that can be read"),
        (["--mesh", "kidney"], "liver, or a file that ends in"),
        (["--mesh", "liver", "--mesh-unit", "inch"], "--mesh-unit: expected one of m, cm, mm, um"),
        (["--mesh", "liver", "--mesh-up", "z"], "--mesh-up: expected one of +z, -z"),
    ],
)
def test_a_mistake_about_a_mesh_is_told_before_what_takes_seconds_to_import(
    options, words, capsys, monkeypatch
):
    monkeypatch.setitem(sys.modules, "trocar.web.serve", None)  # to import it fails
    assert main(["train", "--no-browser", *options]) == 2
    assert words in " ".join(capsys.readouterr().err.split())


def test_a_busy_port_is_told_before_what_takes_minutes(capsys, monkeypatch):
    monkeypatch.setitem(sys.modules, "trocar.web.serve", None)  # to import it fails
    with socket.create_server(("127.0.0.1", 0)) as other:
        port = other.getsockname()[1]
        assert main(["train", "--no-browser", "--port", str(port)]) == 1
    assert f"port {port}: Address already in use; choose another port" in capsys.readouterr().err


def test_the_help_names_every_set_of_ports(capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "200")
    assert main(["train", "--help"]) == 0
    sets = ", ".join((USUAL, *PORT_SETS))
    assert f"Where the ports are: {sets}, or a file.toml." in " ".join(capsys.readouterr().out.split())
