"""Film the trainer's stream, without a browser, and choose the moments worth a picture."""

from __future__ import annotations

import json
import math
import time
from collections.abc import Sequence
from dataclasses import dataclass

from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from trocar.web.source import InstrumentState, Touch
from trocar.web.wire import decode_frame

SLIDING = 2e-3  # across the surface, from which on a touch is a slide [m/s]
EVERY = 0.03  # of the tissue's time: a moment is kept so often [s]


@dataclass(frozen=True)
class Moment:
    """One frame and what it shows.

    Args:
        frame: as it came.
        instruments: left and right.
        time: the tissue's [s].
        speed: of the faster touching tip across the surface [m/s]; 0 where none touches.
    """

    frame: bytes
    instruments: tuple[InstrumentState, InstrumentState]
    time: float
    speed: float = 0.0

    @property
    def touch(self) -> Touch:
        """What either instrument does."""
        return self.instruments[0].touch | self.instruments[1].touch

    def depth(self, doing: Touch) -> float:
        """Return how deep the deepest tip is that does something [m], minus infinity where none does."""
        return max((each.depth for each in self.instruments if doing in each.touch), default=-math.inf)

    def height(self, doing: Touch) -> float:
        """Return how high the highest tip is that does something [m], minus infinity where none does."""
        return max((each.tip[2] for each in self.instruments if doing in each.touch), default=-math.inf)


def film(address: str, cookie: str, seconds: float) -> list[Moment]:
    """Listen to a trainer for some time, or until it ends.

    Args:
        address: scheme, host and port, as a browser names the origin.
        cookie: what the token was exchanged for, as a header.
        seconds: how long [s].
    """
    moments: list[Moment] = []
    stream = address.replace("http", "ws", 1).rstrip("/") + "/live"
    end = time.monotonic() + seconds
    headers = {"Cookie": cookie} if cookie else {}
    with connect(stream, origin=address.rstrip("/"), additional_headers=headers, compression=None) as socket:
        try:
            while (left := end - time.monotonic()) > 0:
                message = socket.recv(timeout=left)
                if isinstance(message, bytes):
                    sequence, state = decode_frame(message)
                    socket.send(json.dumps({"type": "ack", "sequence": sequence}))
                    if not moments or not 0 <= state.time - moments[-1].time < EVERY:
                        before = moments[-1] if moments else None
                        speed = across(before, state.instruments, state.time)
                        moments.append(Moment(message, state.instruments, state.time, speed))
        except (ConnectionClosed, TimeoutError):
            pass  # a recording that is over may take its trainer with it
    return moments


def across(before: Moment | None, now: Sequence[InstrumentState], when: float) -> float:
    """Return how fast the faster tip that goes on touching moves across the surface [m/s]."""
    if before is None or when <= before.time:
        return 0.0
    went = [
        math.dist(here.tip[:2], there.tip[:2])
        for here, there in zip(now, before.instruments, strict=True)
        if Touch.TOUCHING in here.touch & there.touch
    ]
    return max(went, default=0.0) / (when - before.time)


def choose(moments: Sequence[Moment]) -> dict[str, Moment]:
    """Return the best moment of rest, press, slide and lift, as far as the film holds them."""
    free = [each for each in moments if not each.touch & (Touch.TOUCHING | Touch.HOLDING)]
    held = [each for each in moments if each.touch & Touch.HOLDING]
    pressed = [each for each in moments if each.touch & Touch.TOUCHING and not each.touch & Touch.HOLDING]
    still = [each for each in pressed if each.speed < SLIDING]
    slid = [each for each in pressed if each.speed >= SLIDING]
    found = {}
    if free:
        found["rest"] = free[0]
    if still:
        found["press"] = max(still, key=lambda each: each.depth(Touch.TOUCHING))
    if slid:
        found["slide"] = max(slid, key=lambda each: each.depth(Touch.TOUCHING))
    if held:
        found["lift"] = max(held, key=lambda each: each.height(Touch.HOLDING))
    return found
