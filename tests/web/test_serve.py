"""The server: where it listens and where it refuses to, its beat, its end, and the page it shows."""

import asyncio
import json
import logging
import os
import signal
import socket
import ssl
import subprocess
import sys
import threading
import urllib.request
from pathlib import Path
from unittest.mock import Mock

import pytest
from websockets.asyncio.client import connect
from websockets.frames import Frame, Opcode

from trocar.errors import InputError, TrocarError
from trocar.web.closing import Closing
from trocar.web.serve import _host_values, serve
from web.scripted_source import ScriptedSource
from web.visitor import Visitor, farewell, served, until


@pytest.fixture(scope="session")
def pair(tmp_path_factory):
    """A certificate for this machine and its key, made for these tests and thrown away."""
    folder = tmp_path_factory.mktemp("tls")
    cert, key = folder / "cert.pem", folder / "key.pem"
    request = "req -x509 -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes -days 2 -subj /CN=trocar"
    names = "subjectAltName=DNS:localhost,IP:127.0.0.1"
    command = ["openssl", *request.split(), "-addext", names, "-keyout", key, "-out", cert]
    subprocess.run(command, check=True, capture_output=True, timeout=30)
    return cert, key


def refused(**options):
    """Try to serve, and see that it never gets ready."""
    serve(ScriptedSource(), on_ready=lambda made: pytest.fail(f"listens on {made.origin}"), **options)


@pytest.mark.parametrize("host", ["0.0.0.0", "::"])
def test_it_does_not_listen_on_every_address(host):
    with pytest.raises(InputError, match="one address of this machine"):
        refused(host=host)


def test_it_does_not_listen_beyond_this_machine_without_tls():
    with pytest.raises(InputError, match="cert and key"):
        refused(host="192.0.2.1")


@pytest.mark.parametrize("host", ["", "a" * 300, "no.such.host"])
def test_a_host_that_is_none_of_ours_is_named(host, monkeypatch):
    if host == "no.such.host":  # what a name server says, without asking one
        monkeypatch.setattr(
            socket, "getaddrinfo", Mock(side_effect=socket.gaierror(-2, "Name or service not known"))
        )
    with pytest.raises(TrocarError, match="host"):
        refused(host=host)


def test_cert_without_key(tmp_path):
    with pytest.raises(InputError, match="both or neither"):
        refused(cert=tmp_path / "cert.pem")


def test_cert_and_key_that_cannot_be_read(tmp_path):
    with pytest.raises(InputError, match="PEM"):
        refused(cert=tmp_path / "cert.pem", key=tmp_path / "key.pem")
    for name in ("cert.pem", "key.pem"):
        (tmp_path / name).write_text("no PEM")
    with pytest.raises(InputError, match="PEM"):
        refused(cert=tmp_path / "cert.pem", key=tmp_path / "key.pem")


def test_a_port_in_use_is_said_so(visitor):
    with pytest.raises(TrocarError, match=f"port {visitor.served.port}"):
        refused(port=visitor.served.port)


def test_a_browser_leaves_the_usual_port_out():
    assert _host_values("127.0.0.1", "127.0.0.1", 80, "http") >= {"127.0.0.1", "127.0.0.1:80", "localhost"}
    assert _host_values("Station.example", "192.0.2.1", 8443, "https") == {
        "station.example:8443",
        "192.0.2.1:8443",
    }
    assert _host_values("::1", "::1", 5000, "http") == {"[::1]:5000", "localhost:5000"}


def test_neither_token_nor_session_is_shown_or_logged(visitor, caplog):
    caplog.set_level(logging.DEBUG)
    token = visitor.target.partition("=")[2]
    session = visitor.cookie.partition("=")[2]
    visitor.get(visitor.target)
    visitor.get_inside("/nowhere")
    with visitor.live():
        assert token not in repr(visitor.served)
    lines = [
        record.getMessage() for record in caplog.records if record.name != "websockets.client"
    ]  # the visitor
    assert not any(token in line or session in line for line in lines)


def test_the_source_is_beaten_while_the_server_lives(guest, source):
    before = source.beats
    until(lambda: source.beats > before + 20)


def test_a_source_that_fails_ends_the_server(source):
    over = threading.Event()
    caught = []

    def run():
        try:
            serve(source, on_ready=lambda _: setattr(source, "failing", True))
        except OSError as error:
            caught.append(str(error))
        over.set()

    threading.Thread(target=run).start()
    assert over.wait(10)
    assert caught == ["the servo is gone"]


def test_what_the_caller_raises_when_it_is_ready_ends_the_server(source):
    made = []

    def fail(served):
        made.append(served)
        raise ValueError("no browser")

    with pytest.raises(ValueError, match="no browser"):
        serve(source, on_ready=fail)
    with served(source, port=made[0].port) as again:
        assert again.port == made[0].port


def test_what_fails_behind_the_doors_is_logged_and_the_page_told(source, monkeypatch):
    def fail():
        raise OSError("no tissue")

    logger, records = logging.getLogger("trocar.web.doors"), []
    listening = logging.Handler()
    listening.emit = records.append
    monkeypatch.setattr(logger, "propagate", False)  # the other tests' servers want to hear of no error
    logger.addHandler(listening)
    with served(source) as made:
        visitor = Visitor(made)
        monkeypatch.setattr(source, "hello", fail)
        assert visitor.get_inside("/api/hello")["status"] == 500
    logger.removeHandler(listening)
    assert [record.getMessage() for record in records] == ["http /api/hello failed"]
    assert "no tissue" in str(records[0].exc_info[1])


def test_when_it_stops_every_page_is_told(source):
    with served(source) as made:
        visitor = Visitor(made)
        with visitor.live() as (stream, _):
            made.stop()
            assert farewell(stream) == (Closing.STOPPED, "the trainer stops")
    with pytest.raises(ConnectionRefusedError), socket.create_connection(("127.0.0.1", made.port), timeout=5):
        pass
    beats = source.beats
    with served(source, port=made.port) as again:  # nothing is left that holds the port
        assert again.port == made.port
        assert again.address != made.address
    assert source.beats > beats


PROGRAM = """
from trocar.web.serve import serve
from web.scripted_source import ScriptedSource
serve(ScriptedSource(), on_ready=lambda made: print(made.address, flush=True))
print("ended", flush=True)
"""


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_ends_it_and_the_caller_goes_on(number):
    tests = Path(__file__).parent.parent
    paths = os.pathsep.join([str(tests), str(tests.parent / "src")])
    with subprocess.Popen(
        [sys.executable, "-c", PROGRAM],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=os.environ | {"PYTHONPATH": paths},
    ) as process:
        address = process.stdout.readline().strip()
        assert address.startswith("http://127.0.0.1:")
        process.send_signal(number)
        out, errors = process.communicate(timeout=20)
    assert (out, errors, process.returncode) == ("ended\n", "", 0)


def test_over_tls_the_cookie_is_secure_and_the_stream_runs(source, pair):
    cert, key = pair
    trust = ssl.create_default_context(cafile=cert)
    with served(source, cert=cert, key=key) as made:
        assert made.address.startswith("https://127.0.0.1:")
        opener = urllib.request.build_opener(urllib.request.HTTPSHandler(context=trust), Staying())
        with opener.open(made.address, timeout=5) as answer:
            cookie = answer.headers["set-cookie"]
        assert {"Secure", "HttpOnly", "SameSite=Strict"} <= set(cookie.split("; "))
        assert cookie.startswith(f"__Host-trocar-{made.port}=")
        cookie, address = cookie.partition(";")[0], made.origin.replace("https", "wss") + "/live"
        assert json.loads(asyncio.run(first_message(address, made.origin, cookie, trust)))["type"] == "hello"


def test_a_page_that_is_just_leaving_does_not_disturb_the_end(source, pair):
    cert, key = pair
    trust = ssl.create_default_context(cafile=cert)
    with served(source, cert=cert, key=key) as made:
        opener = urllib.request.build_opener(urllib.request.HTTPSHandler(context=trust), Staying())
        with opener.open(made.address, timeout=5) as answer:
            cookie = answer.headers["set-cookie"].partition(";")[0]
        plain = socket.create_connection(("127.0.0.1", made.port), timeout=5)
        with trust.wrap_socket(plain, server_hostname="127.0.0.1") as stream:
            lines = [
                "GET /live HTTP/1.1",
                f"Host: 127.0.0.1:{made.port}",
                f"Origin: {made.origin}",
                f"Cookie: {cookie}",
                "Connection: Upgrade",
                "Upgrade: websocket",
                "Sec-WebSocket-Version: 13",
                "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==",
            ]
            stream.sendall(("\r\n".join(lines) + "\r\n\r\n").encode())
            assert stream.recv(12) == b"HTTP/1.1 101"
            # It says goodbye and then never ends the TLS connection: the server still waits for that when it stops.
            stream.sendall(Frame(Opcode.CLOSE, b"\x03\xe8").serialize(mask=True))
            before = source.beats
            until(lambda: source.beats > before + 5)
            made.stop()
            until(lambda: ended(made.port))


def ended(port):
    """Return whether nobody listens any more."""
    with socket.socket() as plain:
        return plain.connect_ex(("127.0.0.1", port)) != 0


async def first_message(address, origin, cookie, trust):
    """Enter over TLS; in one thread, for before Python 3.13 two may not use one TLS connection at once."""
    headers = {"Cookie": cookie}
    async with connect(
        address,
        ssl=trust,
        origin=origin,
        additional_headers=headers,
        compression=None,
        proxy=None,
        close_timeout=1,
    ) as stream:
        return await asyncio.wait_for(stream.recv(), 5)


class Staying(urllib.request.HTTPRedirectHandler):
    """Take a redirect as the answer."""

    def http_error_303(self, request, answer, code, message, headers):
        return answer


def test_the_built_client_is_served(visitor):
    page = visitor.get_inside("/")
    assert (page["status"], page["content-type"]) == (200, "text/html; charset=utf-8")
    script = visitor.get_inside("/scene.js")
    assert (script["status"], script["content-type"].partition(";")[0]) == (200, "text/javascript")
    assert script["body"] == "export {};\n"


def test_a_client_that_is_not_built_is_said_so_with_what_to_do(source, tmp_path):
    with served(source, client=tmp_path / "nothing") as made:
        visitor = Visitor(made)
        page = visitor.get_inside("/")
        assert page["status"] == 503
        assert "npm run build" in page["body"]
        assert visitor.get_inside("/scene.js")["status"] == 404
        assert visitor.get_inside("/api/hello")["status"] == 200
        with visitor.live() as (_, hello):
            assert hello["protocol"] == 1


def test_the_interface_describes_itself(visitor):
    content = json.loads(visitor.get_inside("/api/openapi.json")["body"])
    assert set(content["paths"]) == {"/api/hello"}
