"""The stream to one client: frames out, at most two of them unacknowledged; poses and acknowledgements in.

A browser cannot push back on a WebSocket: what a slow page does not take piles up before it and is old when
it arrives. So the client acknowledges frames, and the server encodes the next one only when fewer than two
are on their way, from the newest state there is. A slow page loses frames and nobody waits for it.
"""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass

from starlette.websockets import WebSocket, WebSocketDisconnect

from trocar.errors import InputError
from trocar.web.closing import Closing, Farewell
from trocar.web.messages import Acknowledgement, Guiding, Hello, Message, read_client_message
from trocar.web.source import LiveSource, Pose
from trocar.web.wire import Block, RangeError, decode_pose, encode

_NOTICES_KEPT = 16  # for a client that does not take them; older ones are dropped
FAREWELL_TIME = 1.0  # for the close frame of a client that may have stopped reading [s]


@dataclass(frozen=True, kw_only=True)
class StreamLimits:
    """What clients are held to.

    Args:
        clients: conversations at one time.
        frame_rate: most frames sent to a client in a second [Hz].
        unacknowledged: most frames on their way to a client.
        message_bytes: largest message of a client.
        message_rate: messages of a client in a second, averaged over one second [Hz].
        idle: longest silence of a client [s].
        send: longest wait for a client to take what is sent [s].
    """

    clients: int = 4
    frame_rate: float = 90.0
    unacknowledged: int = 2
    message_bytes: int = 4096
    message_rate: float = 400.0
    idle: float = 10.0
    send: float = 2.0


class Allowance:
    """Count messages against a rate: a bucket that holds one second's worth and fills steadily.

    After a pause of the machine up to one second's worth may come at once; more than the rate does not pass for long.

    Args:
        rate: messages in a second [Hz].
        now: the time [s].
    """

    def __init__(self, rate: float, now: float) -> None:
        self._rate = rate
        self._left = rate
        self._last = now

    def take(self, now: float) -> bool:
        """Take one message out at a time [s], and return whether it was still there."""
        self._left = min(self._rate, self._left + self._rate * (now - self._last)) - 1.0
        self._last = now
        return self._left >= 0.0


class Conversation:
    """Talk to one accepted client until it leaves or has to.

    Args:
        websocket: accepted already.
        source: where states come from and poses go.
        limits: what the client is held to.
        on_pose: told of each good pose, after the source.
    """

    def __init__(
        self,
        websocket: WebSocket,
        source: LiveSource,
        limits: StreamLimits,
        on_pose: Callable[[Conversation, Pose], None],
    ) -> None:
        self._websocket = websocket
        self._source = source
        self._limits = limits
        self._on_pose = on_pose
        self._hello = source.hello()
        self._block = Block.of(self._hello.tissue)
        self._guiding = source.guiding()  # told before the first frame, so that a page knows what is on
        self._guiding_is_told = self._guiding is None
        self._sent = 0
        self._acknowledged = 0
        self._pose_sequence = [-1, -1]
        self._waiting: deque[Message] = deque([self._hello], maxlen=_NOTICES_KEPT)
        self._wake = asyncio.Event()
        self._ending = asyncio.Event()
        self._farewell = Farewell(Closing.STOPPED, "")

    def tell(self, message: Message) -> None:
        """Send a message before the next frame."""
        self._waiting.append(message)
        self._wake.set()

    def greet(self, hello: Hello) -> None:
        """Say what is shown, where it is another thing than before."""
        if hello is not self._hello:
            self._hello, self._block = hello, Block.of(hello.tissue)
            self.tell(hello)

    def guide(self, guiding: Guiding | None) -> None:
        """Say what to do now; only the newest is sent."""
        if guiding is not self._guiding:
            self._guiding, self._guiding_is_told = guiding, guiding is None
            self._wake.set()

    def end(self, farewell: Farewell) -> None:
        """End the conversation from outside."""
        self._farewell = farewell
        self._ending.set()

    async def run(self) -> None:
        """Speak and listen until either side ends it, then close with code and reason."""
        try:
            async with asyncio.TaskGroup() as tasks:
                tasks.create_task(self._speak())
                tasks.create_task(self._listen())
                tasks.create_task(self._until_ended())
        except* Farewell as farewells:
            await close(self._websocket, _first(farewells))
        except* WebSocketDisconnect:
            pass  # the client closed, or the library did

    async def _until_ended(self) -> None:
        await self._ending.wait()
        raise self._farewell

    async def _speak(self) -> None:
        loop = asyncio.get_running_loop()
        period = 1.0 / self._limits.frame_rate
        due = loop.time()
        while True:
            while self._waiting:
                await self._put(self._waiting.popleft().model_dump_json())
            if self._guiding is not None and not self._guiding_is_told:
                self._guiding_is_told = True
                await self._put(self._guiding.model_dump_json())
            now = loop.time()
            credit = self._sent - self._acknowledged < self._limits.unacknowledged
            if credit and now >= due:
                snapshot = self._source.latest()
                self.greet(self._source.hello())
                if self._waiting:  # it may be of another scene than the page knows
                    continue
                self._sent += 1
                due = due + period if now - due < period else now + period
                await self._put(encode(snapshot, self._sent))
                continue
            self._wake.clear()
            with suppress(TimeoutError):
                async with asyncio.timeout_at(due if credit else None):
                    await self._wake.wait()

    async def _put(self, message: str | bytes) -> None:
        try:
            async with asyncio.timeout(self._limits.send):
                if isinstance(message, str):
                    await self._websocket.send_text(message)
                else:
                    await self._websocket.send_bytes(message)
        except TimeoutError:
            reason = f"nothing was taken from the stream for {self._limits.send:g} s"
            raise Farewell(Closing.SLOW, reason) from None
        except (
            RuntimeError
        ):  # the library has just closed the connection, and the listener is about to learn of it
            raise WebSocketDisconnect(1006) from None

    async def _listen(self) -> None:
        clock = asyncio.get_running_loop().time
        allowance = Allowance(self._limits.message_rate, clock())
        while True:
            try:
                async with asyncio.timeout(self._limits.idle):
                    message = await self._websocket.receive()
            except TimeoutError:
                raise Farewell(Closing.IDLE, f"no message came for {self._limits.idle:g} s") from None
            if message["type"] == "websocket.disconnect":
                raise WebSocketDisconnect(message["code"])
            if not allowance.take(clock()):
                reason = f"more than {self._limits.message_rate:g} messages a second came"
                raise Farewell(Closing.TOO_MANY_MESSAGES, reason)
            text = message.get("text")
            if text is not None:
                self._take_text(text)
            else:
                self._take_pose(message["bytes"])

    def _take_text(self, text: str) -> None:
        try:
            message = read_client_message(text)
        except ValueError:
            raise Farewell(Closing.MALFORMED, "a text message was neither ack nor reset") from None
        if not isinstance(message, Acknowledgement):
            self._source.reset()
        elif message.sequence > self._sent:
            raise Farewell(Closing.MALFORMED, "a frame was acknowledged that was never sent")
        else:
            self._acknowledged = max(self._acknowledged, message.sequence)
            self._wake.set()

    def _take_pose(self, message: bytes) -> None:
        try:
            pose = decode_pose(message, self._block)
        except InputError as error:
            closing = Closing.OUT_OF_RANGE if isinstance(error, RangeError) else Closing.MALFORMED
            raise Farewell(closing, f"{error.where}: expected {error.expected}") from None
        if pose.sequence <= self._pose_sequence[pose.instrument]:
            raise Farewell(Closing.MALFORMED, "pose: expected a sequence number above the last one")
        self._pose_sequence[pose.instrument] = pose.sequence
        self._source.pose(pose.instrument, pose)
        self._on_pose(self, pose)


async def close(websocket: WebSocket, farewell: Farewell) -> None:
    """Close a connection with code and reason; one that cannot take them any more is left to the library."""
    with suppress(TimeoutError, RuntimeError, WebSocketDisconnect):
        async with asyncio.timeout(FAREWELL_TIME):
            await websocket.close(farewell.closing, farewell.reason)


def _first(group: BaseExceptionGroup[Farewell]) -> Farewell:
    leaf: BaseException = group
    while isinstance(leaf, BaseExceptionGroup):
        leaf = leaf.exceptions[0]
    assert isinstance(leaf, Farewell)
    return leaf
