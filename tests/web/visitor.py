"""A server on a free port of loopback, and the plain clients that visit it."""

import http.client
import json
import logging
import socket
import time
from contextlib import contextmanager
from urllib.parse import urlsplit

import pytest
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from trocar.web.serve import serving


class Visitor:
    """Knows the address of one server, and visits it with or without manners."""

    def __init__(self, served):
        self.served = served
        self.origin = served.origin
        self.host = urlsplit(served.origin).netloc
        self.target = served.address.removeprefix(served.origin)
        self.cookie = self.get(self.target)["set-cookie"].partition(";")[0]

    def request(self, method, path, headers=None, body=b"", timeout=5.0):
        """Return an answer's headers (lower case), its "status" and its "body"."""
        connection = http.client.HTTPConnection("127.0.0.1", self.served.port, timeout=timeout)
        try:
            connection.putrequest(method, path, skip_host=True, skip_accept_encoding=True)
            for name, value in ({"Host": self.host} | (headers or {})).items():
                if value is not None:
                    connection.putheader(name, value)
            if body:
                connection.putheader("Content-Length", str(len(body)))
                connection.putheader("Content-Type", "application/json")
            connection.endheaders(body)
            response = connection.getresponse()
            found = {name.lower(): value for name, value in response.getheaders()}
            return found | {"status": response.status, "body": response.read().decode("latin-1")}
        finally:
            connection.close()

    def get(self, path, headers=None):
        """Request a page without a cookie."""
        return self.request("GET", path, headers)

    def get_inside(self, path):
        """Request a page with the cookie."""
        return self.get(path, {"Cookie": self.cookie})

    def ask(self, path, body=None):
        """Ask the REST interface, as the page does; return the status and what came, out of JSON if it was."""
        headers = {"Cookie": self.cookie, "Origin": self.origin}
        if body is None:
            found = self.request("GET", path, headers, timeout=60)
        else:
            data = body if isinstance(body, bytes) else json.dumps(body).encode()
            found = self.request("POST", path, headers, data, timeout=60)
        is_json = found.get("content-type", "").startswith("application/json")
        text = found["body"].encode("latin-1")
        return found["status"], json.loads(text) if is_json else text

    def handshake(self, headers=None, path="/live"):
        """Return the status with which a WebSocket is answered, for exactly these headers."""
        with self._upgrading(path, headers or {}) as plain, plain.makefile("rb") as stream:
            return int(stream.readline().split()[1])

    def upgraded(self, receive_buffer=None):
        """Return a plain socket inside the live stream, nothing read of it yet but the answer's head."""
        plain = self._upgrading("/live", {"Cookie": self.cookie, "Origin": self.origin}, receive_buffer)
        head = b""
        while not head.endswith(b"\r\n\r\n"):
            head += plain.recv(1)
        assert head.startswith(b"HTTP/1.1 101 ")
        return plain

    def _upgrading(self, path, headers, receive_buffer=None):
        upgrade = {
            "Host": self.host,
            "Connection": "Upgrade",
            "Upgrade": "websocket",
            "Sec-WebSocket-Version": "13",
            "Sec-WebSocket-Key": "AAAAAAAAAAAAAAAAAAAAAA==",
        }
        lines = [f"GET {path} HTTP/1.1"]
        lines += [f"{name}: {value}" for name, value in (upgrade | headers).items() if value is not None]
        plain = socket.socket()
        if receive_buffer is not None:
            plain.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, receive_buffer)
        plain.settimeout(5)
        plain.connect(("127.0.0.1", self.served.port))
        plain.sendall(("\r\n".join(lines) + "\r\n\r\n").encode("latin-1"))
        return plain

    def enter(self):
        """Return a connection to the live stream, nothing read of it yet."""
        return connect(
            self.origin.replace("http", "ws", 1) + "/live",
            origin=self.origin,
            additional_headers={"Cookie": self.cookie},
            compression=None,
            proxy=None,
            close_timeout=1,
            open_timeout=5,
        )

    @contextmanager
    def live(self):
        """Enter the live stream and yield the connection and the greeting."""
        with self.enter() as stream:
            yield stream, json.loads(stream.recv(timeout=5))


def drain(stream):
    """Take what comes, acknowledging nothing, until the connection is closed: raises ConnectionClosed."""
    while True:
        stream.recv(timeout=5)


def farewell(stream):
    """Wait for the close, and return its code and reason; None where none came."""
    with pytest.raises(ConnectionClosed) as caught:
        drain(stream)
    close = caught.value.rcvd
    return (close.code, close.reason) if close is not None else (None, None)


def until(holds, timeout=5.0):
    """Wait until something holds; that it never does is a failure, not when it does."""
    deadline = time.monotonic() + timeout
    while not holds():
        assert time.monotonic() < deadline
        time.sleep(0.005)


@contextmanager
def served(source, **options):
    """Serve a source in a thread, yield what it is served as, stop it and see that nothing went wrong."""
    records = []
    listening = logging.Handler(logging.WARNING)
    listening.emit = records.append
    loggers = [logging.getLogger(name) for name in ("asyncio", "trocar", "uvicorn.error")]
    for logger in loggers:
        logger.addHandler(listening)
    try:
        with serving(source, **options) as made:
            yield made
    finally:
        for logger in loggers:
            logger.removeHandler(listening)
    if records:
        pytest.fail("the server logged:\n" + "\n".join(map(logging.Formatter().format, records)))
