"""The live stream as a whole: every client there is, and the one source they share."""

from __future__ import annotations

import asyncio
from dataclasses import replace

from starlette.websockets import WebSocket, WebSocketDisconnect

from trocar.web.closing import Closing, Farewell
from trocar.web.conversation import FAREWELL_TIME, Conversation, StreamLimits, close
from trocar.web.source import LiveSource, Pose


class Live:
    """Bring clients and source together.

    Any client may move an instrument; the newest pose counts. When the client that moved an instrument last is
    gone, the instrument is taken out of the tissue, so that nobody's absence keeps pressing.

    Args:
        source: what moves the tissue.
        limits: what clients are held to.
    """

    def __init__(self, source: LiveSource, limits: StreamLimits) -> None:
        self.source = source
        self._limits = limits
        self._clients: set[Conversation] = set()
        self._talks: set[asyncio.Task[None]] = set()
        self._last: dict[int, tuple[Conversation, Pose]] = {}
        self._stopped: Farewell | None = None

    async def converse(self, websocket: WebSocket) -> None:
        """Accept a client and talk to it until it is gone."""
        try:
            await websocket.accept()
        except (WebSocketDisconnect, RuntimeError):
            return  # it is gone already
        if self._stopped is not None:
            await close(websocket, self._stopped)
        elif len(self._clients) >= self._limits.clients:
            reason = f"{self._limits.clients} clients are connected; close another window first"
            await close(websocket, Farewell(Closing.FULL, reason))
        else:
            client = Conversation(websocket, self.source, self._limits, self._remember)
            talk = asyncio.current_task()
            assert talk is not None
            self._clients.add(client)
            self._talks.add(talk)
            try:
                await client.run()
            finally:
                self._talks.discard(talk)
                self._clients.discard(client)
                self._let_go(client)

    def announce(self) -> None:
        """Pass on what is new: another scene, what to do now, notices.

        While nobody is there to read notices the source keeps them.
        """
        if not self._clients:
            return
        hello, guiding = self.source.hello(), self.source.guiding()
        for client in self._clients:
            client.greet(hello)
            client.guide(guiding)
        for notice in self.source.notices():
            for client in self._clients:
                client.tell(notice)

    async def stop(self) -> None:
        """Say farewell to every client, and to each that still comes; return when all have been told."""
        self._stopped = Farewell(Closing.STOPPED, "the trainer stops")
        for client in self._clients:
            client.end(self._stopped)
        if self._talks:
            await asyncio.wait(self._talks, timeout=FAREWELL_TIME)

    def _remember(self, client: Conversation, pose: Pose) -> None:
        self._last[pose.instrument] = (client, pose)

    def _let_go(self, client: Conversation) -> None:
        for instrument, (mover, pose) in list(self._last.items()):
            if mover is client:
                del self._last[instrument]
                self.source.pose(
                    instrument, replace(pose, present=False, sequence=min(pose.sequence + 1, 2**32 - 1))
                )
