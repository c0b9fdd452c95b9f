"""The server: bind, hand back the address with its token, beat the source, and leave nothing behind.

It listens on this machine alone unless another address is given, and another address only under TLS: the
token and the cookie would cross the network in clear otherwise, and a headset's browser offers WebXR to no
page without it.
"""

from __future__ import annotations

import asyncio
import signal
import socket
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from ipaddress import ip_address
from pathlib import Path
from typing import Any

import uvicorn
from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol

from trocar.web.address import bound, checked_tls
from trocar.web.application import CLIENT, application
from trocar.web.conversation import FAREWELL_TIME, StreamLimits
from trocar.web.doors import Doors
from trocar.web.lessons import Lessons
from trocar.web.live import Live
from trocar.web.sessions import Sessions
from trocar.web.source import LiveSource

BEAT_PERIOD = 0.01  # [s]; a source must hear a beat every 20 ms, and lets its forces fall after 50 ms
_BEATS_PER_ANNOUNCEMENT = 5
_SHUTDOWN_TIME = 2  # for connections that do not close when the server stops [s]
_LARGEST_HEADERS = 16384
_SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
_DEFAULT_PORT = {"http": 80, "https": 443}


@dataclass(frozen=True, kw_only=True)
class Served:
    """A server that accepts connections.

    Args:
        address: to be opened in a browser; it holds the token, so it is shown to the user and never logged.
        origin: scheme, host and port.
        port: the port that was bound.
        stop: ends the server from any thread; `serve` then returns.
    """

    address: str = field(repr=False)
    origin: str
    port: int
    stop: Callable[[], None] = field(repr=False)


def serve(
    source: LiveSource,
    lessons: Lessons | None = None,
    *,
    on_ready: Callable[[Served], None],
    host: str = "127.0.0.1",
    port: int = 0,
    cert: Path | None = None,
    key: Path | None = None,
    limits: StreamLimits | None = None,
    client: Path = CLIENT,
) -> None:
    """Serve the live trainer until it is stopped: by `Served.stop`, or in the main thread by Ctrl-C, SIGTERM, SIGHUP.

    Args:
        source: what moves the tissue; it is beaten every 10 ms and not closed.
        lessons: tasks to do with it; not closed.
        on_ready: called once connections are accepted, from the server's own thread, so it has to be quick; what it
            raises ends the server. Nothing is printed here.
        host: address or name of this machine to listen on.
        port: 0 takes a free one.
        cert: certificate chain (PEM), with `key`; needed for every host but this machine itself.
        key: private key (PEM).
        limits: what clients are held to.
        client: folder of the built browser client.

    Raises:
        InputError: host, cert and key do not go together, or cannot be used.
        TrocarError: the address cannot be bound.
    """
    secure = checked_tls(cert, key)
    listener = bound(host, port, secure=secure)
    with listener:
        limits = limits or StreamLimits()
        live, sessions = Live(source, limits), Sessions()
        ip, bound_port = listener.getsockname()[:2]
        scheme = "https" if secure else "http"
        hosts = _host_values(host, ip, bound_port, scheme)
        cookie = f"{'__Host-' if secure else ''}trocar-{bound_port}"
        doors = Doors(
            application(live, lessons, client=client),
            sessions=sessions,
            hosts=hosts,
            cookie=cookie,
            secure=secure,
        )
        config = uvicorn.Config(
            doors,
            loop="asyncio",
            http="h11",
            ws=_Stream,
            ws_per_message_deflate=False,  # it costs more time than it saves on a local network
            ws_max_size=limits.message_bytes,
            ws_ping_interval=None,  # a client that says nothing is dropped; pings would only hide it
            h11_max_incomplete_event_size=_LARGEST_HEADERS,
            lifespan="off",
            log_config=None,
            log_level="critical",  # whoever knocks could fill it; what fails behind the doors, the doors log
            access_log=False,  # a line of it would hold the token
            server_header=False,
            proxy_headers=False,
            timeout_graceful_shutdown=_SHUTDOWN_TIME,
            ssl_certfile=cert,
            ssl_keyfile=key,
        )
        origin = f"{scheme}://{_bracketed(host)}:{bound_port}"
        server = _Server(config, live)
        served = Served(
            address=f"{origin}/?token={sessions.token}", origin=origin, port=bound_port, stop=server.stop
        )
        server.on_started = lambda: on_ready(served)
        asyncio.run(_run(server, listener, live))


class _Stream(WebSocketsSansIOProtocol):
    """uvicorn's WebSocket with two faults less.

    It raises when the server stops while its client is just closing it; and where a message breaks the protocol it
    closes with the rest unread, upon which the kernel resets the connection and the farewell may be lost with it.
    """

    _refused = False

    def shutdown(self) -> None:
        if not self.transport.is_closing():
            super().shutdown()

    def data_received(self, data: bytes) -> None:
        if not self._refused:
            super().data_received(data)

    def handle_parser_exception(self) -> None:
        """Say why, and read on unheeded until the client has left, or not for long."""
        self._refused = self.close_sent = True
        assert self.conn.close_sent is not None
        code, reason = self.conn.close_sent.code, self.conn.close_sent.reason
        self.queue.put_nowait({"type": "websocket.disconnect", "code": code, "reason": reason})
        self.transport.write(b"".join(self.conn.data_to_send()))
        if self.transport.can_write_eof():
            self.transport.write_eof()
        self.close_timer = self.loop.call_later(FAREWELL_TIME, self.transport.close)


class _Server(uvicorn.Server):
    """uvicorn's server, stopping as ours does: a signal ends it and is not raised again, clients are told why."""

    on_started: Callable[[], None]

    def __init__(self, config: uvicorn.Config, live: Live) -> None:
        super().__init__(config)
        self._live = live

    def stop(self) -> None:
        self.should_exit = True

    @contextmanager
    def capture_signals(self) -> Iterator[None]:
        if threading.current_thread() is not threading.main_thread():
            yield
            return
        before = {number: signal.signal(number, self.handle_exit) for number in _SIGNALS}
        try:
            yield
        finally:
            for number, action in before.items():
                signal.signal(number, action)

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        await super().startup(sockets)
        try:
            self.on_started()
        except BaseException:
            await self.shutdown(sockets)
            raise

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        await self._live.stop()  # clients hear why before their connections are shut
        await super().shutdown(sockets)


@contextmanager
def serving(source: LiveSource, lessons: Lessons | None = None, **options: Any) -> Iterator[Served]:
    """Serve in a thread of its own for as long as the block runs; options as for `serve`.

    What ends the server early is raised at the end of the block, or instead of it.
    """
    found: list[Served] = []
    failures: list[BaseException] = []
    ready = threading.Event()

    def take(served: Served) -> None:
        found.append(served)
        ready.set()

    def run() -> None:
        try:
            serve(source, lessons, on_ready=take, **options)
        except BaseException as error:  # noqa: BLE001 - raised in the other thread
            failures.append(error)
        finally:
            ready.set()

    thread = threading.Thread(target=run, name="server")
    thread.start()
    ready.wait()
    try:
        if found:
            yield found[0]
    finally:
        if found:
            found[0].stop()
        thread.join()
    if failures:
        raise failures[0]


async def _run(server: _Server, listener: socket.socket, live: Live) -> None:
    beating = asyncio.create_task(_beat(live))
    beating.add_done_callback(lambda _: server.stop())  # a source that fails its beat ends the server
    try:
        await server.serve(sockets=[listener])
    finally:
        beating.cancel()
        with suppress(asyncio.CancelledError):
            await beating


async def _beat(live: Live) -> None:
    count = 0
    while True:
        live.source.beat()
        if count % _BEATS_PER_ANNOUNCEMENT == 0:
            live.announce()
        count += 1
        await asyncio.sleep(BEAT_PERIOD)


def _host_values(host: str, ip: str, port: int, scheme: str) -> set[str]:
    names = {_bracketed(host.lower()), _bracketed(ip)}
    if ip_address(ip.partition("%")[0]).is_loopback:
        names.add("localhost")
    values = {f"{name}:{port}" for name in names}
    return values | names if port == _DEFAULT_PORT[scheme] else values


def _bracketed(host: str) -> str:
    return f"[{host}]" if ":" in host else host
