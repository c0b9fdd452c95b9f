"""How long a pose takes through the server: sent by a plain client on loopback until its frame is received there.

The client is a process of its own and reads the same monotonic clock, so one way can be told from the other:

| part | from | to |
|---|---|---|
| in | the client sends a pose | the source is given it |
| wait | the source is given it | the source is asked for the snapshot that shows it |
| out | the source is asked | the frame has arrived at the client |

The wait holds what the source takes to consume the pose and, for the most part, the time until the next frame is
due: anything up to one frame period. Poses come a little less often than frames, so that they fall on every phase of
the period evenly.
"""

from __future__ import annotations

import asyncio
import json
import multiprocessing
import time
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import suppress
from dataclasses import dataclass
from http.client import HTTPConnection
from typing import Any

import numpy as np
from numpy.typing import NDArray
from websockets.asyncio.client import connect
from websockets.exceptions import ConnectionClosedOK

from trocar.errors import TrocarError
from trocar.web.conversation import StreamLimits
from trocar.web.messages import Guiding, Hello, Notice
from trocar.web.serve import serving
from trocar.web.source import LEFT, LiveSource, Pose, Snapshot
from trocar.web.wire import HEADER, encode_pose

_PHASE_DRIFT = 0.93  # poses for each frame: no small fraction, so that their phases spread
_WARM_UP = 1.0  # left out of the figures [s]

Times = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class StreamLatency:
    """What each pose took, part by part; all arrays have shape (poses,).

    Args:
        frame_period: the shortest time between two frames [s].
        total: from the client and back to it [s].
        inward: client to source [s].
        wait: at the source, until its next frame [s].
        outward: source to client [s].
    """

    frame_period: float
    total: Times
    inward: Times
    wait: Times
    outward: Times


class TimedSource:
    """Pass everything on to a source and note when poses come and which pose each snapshot shows.

    Args:
        source: what moves the tissue.
    """

    def __init__(self, source: LiveSource) -> None:
        self._source = source
        self.taken: dict[int, float] = {}  # pose sequence: when it came [s]
        self.shown: dict[int, float] = {}  # pose sequence: when a snapshot first showed it [s]

    def hello(self) -> Hello:
        """Return the source's own."""
        return self._source.hello()

    def latest(self) -> Snapshot:
        """Return the source's own, and note what it shows."""
        asked = time.perf_counter()
        snapshot = self._source.latest()
        self.shown.setdefault(snapshot.pose_sequence[LEFT], asked)
        return snapshot

    def pose(self, instrument: int, pose: Pose, /) -> None:
        """Pass a pose on, and note when it came."""
        self.taken[pose.sequence] = time.perf_counter()
        self._source.pose(instrument, pose)

    def reset(self) -> None:
        """Pass it on."""
        self._source.reset()

    def guiding(self) -> Guiding | None:
        """Return nothing: nobody attempts anything."""
        return None

    def notices(self) -> Sequence[Notice]:
        """Return the source's own."""
        return self._source.notices()

    def beat(self) -> None:
        """Pass it on."""
        self._source.beat()


def stream_latency(source: LiveSource, *, seconds: float = 10.0, frame_rate: float = 90.0) -> StreamLatency:
    """Serve a source on loopback, send it poses of the left instrument from another process, and time them.

    Args:
        source: what moves the tissue; its snapshots must name the poses they show.
        seconds: how long to measure [s].
        frame_rate: most frames in a second [Hz].

    Raises:
        TrocarError: the client failed, or not one pose came back.
    """
    timed = TimedSource(source)
    hello = source.hello()
    pose = Pose(
        instrument=LEFT, sequence=0, present=True, handle=hello.instruments[LEFT].handle_m, roll=0.0, jaw=0.0
    )
    interval = 1.0 / (_PHASE_DRIFT * frame_rate)
    with (
        serving(timed, limits=StreamLimits(frame_rate=frame_rate)) as served,
        ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as pool,
    ):
        talk = pool.submit(
            _client, served.address, served.origin, encode_pose(pose), seconds + _WARM_UP, interval
        )
        try:
            sent, received = talk.result()
        except Exception as error:
            raise TrocarError(f"the client that measures failed: {error}") from error
    return _evaluated(timed, sent, received, frame_period=1.0 / frame_rate)


def _evaluated(
    timed: TimedSource, sent: dict[int, float], received: dict[int, float], *, frame_period: float
) -> StreamLatency:
    """Match poses with the first frame that shows them or a later one."""
    shown = np.array(sorted(set(received) & set(timed.shown)))
    begun = min(sent.values(), default=0.0) + _WARM_UP
    poses = [number for number, at in sent.items() if at >= begun and number in timed.taken]
    places = np.searchsorted(shown, poses)
    rows = [
        (sent[number], timed.taken[number], timed.shown[int(shown[place])], received[int(shown[place])])
        for number, place in zip(poses, places, strict=True)
        if place < len(shown)
    ]
    if not rows:
        raise TrocarError("no pose came back in a frame; measure for longer")
    left, taken, asked, arrived = np.array(rows).T
    return StreamLatency(
        frame_period=frame_period,
        total=arrived - left,
        inward=taken - left,
        wait=asked - taken,
        outward=arrived - asked,
    )


def _client(
    address: str, origin: str, pose: bytes, seconds: float, interval: float
) -> tuple[dict[int, float], dict[int, float]]:
    """Send poses and acknowledge frames; return when each pose left and when a frame first showed it [s]."""
    return asyncio.run(_talk(address, origin, pose, seconds, interval))


async def _talk(
    address: str, origin: str, pose: bytes, seconds: float, interval: float
) -> tuple[dict[int, float], dict[int, float]]:
    sent: dict[int, float] = {}
    received: dict[int, float] = {}
    stream: Any
    headers = {"Cookie": _cookie(address, origin)}
    async with connect(
        f"{origin.replace('http', 'ws', 1)}/live",
        origin=origin,  # type: ignore[arg-type]  # a plain string to everyone but the type checker
        additional_headers=headers,
        compression=None,
        proxy=None,
    ) as stream:

        async def send() -> None:
            begun = time.perf_counter()
            for number in range(1, int(seconds / interval) + 1):
                await asyncio.sleep(begun + number * interval - time.perf_counter())
                sent[number] = time.perf_counter()
                await stream.send(pose[:4] + number.to_bytes(4, "little") + pose[8:])
            await asyncio.sleep(0.2)  # the last frames
            await stream.close()

        sending = asyncio.create_task(send())
        with suppress(
            ConnectionClosedOK
        ):  # it is closed above, maybe between a frame and its acknowledgement
            async for message in stream:
                arrived = time.perf_counter()
                if isinstance(message, bytes):
                    header = np.frombuffer(message, HEADER, 1)[0]
                    received.setdefault(int(header["pose_sequence"][LEFT]), arrived)
                    await stream.send(json.dumps({"type": "ack", "sequence": int(header["sequence"])}))
        await sending
    return sent, received


def _cookie(address: str, origin: str) -> str:
    connection = HTTPConnection(origin.partition("//")[2], timeout=5)
    try:
        connection.request("GET", address.removeprefix(origin))
        return str(connection.getresponse().headers["set-cookie"]).partition(";")[0]
    finally:
        connection.close()
