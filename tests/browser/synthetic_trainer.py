"""A trainer made of a few lines: serves the built client and speaks the live stream, with a tissue that only obeys.

Tips come from the page's hands, or from a script where the trainer steers; `obedient_tissue` follows them. Besides, a
dent of its own wanders where `wander` says. Nothing here is the real server's code: the client is judged by the
contract as it is written down.
"""

from __future__ import annotations

import json
import mimetypes
import struct
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from http import HTTPStatus
from pathlib import Path

import numpy as np
from websockets.datastructures import Headers
from websockets.exceptions import ConnectionClosed
from websockets.http11 import Response
from websockets.sync.server import serve

from browser.obedient_tissue import NODES, SIZE, Touch, bump

STATIC = Path(__file__).parents[2] / "src" / "trocar" / "web" / "static"
POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src 'self'; "
    "font-src 'self'; worker-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
LAYERS = (("epidermis", 0.0001), ("dermis", 0.0015), ("fat", 0.012))
LINEAR = 0.4  # [N]
UNACKNOWLEDGED = 2
PERIOD = 1 / 60  # between frames [s]


def instrument(name: str, tip: str, port: tuple[float, float, float], at: tuple[float, float, float]) -> dict:
    """Describe an instrument whose tip starts at a point [m]."""
    length = 0.31
    shaft = np.subtract(at, port)
    handle = at - length * shaft / np.linalg.norm(shaft)
    return {
        "name": name,
        "port_m": port,
        "length_m": length,
        "shaft_radius_m": 0.0025,
        "tip": tip,
        "handle_m": handle.tolist(),
    }


def hello(left: str = "grasper", right: str = "probe", steered_by: str = "page") -> dict:
    """Return the greeting, with tips of some kinds."""
    return {
        "type": "hello",
        "protocol": 1,
        "tissue": {
            "name": "skin",
            "size_m": [SIZE, SIZE],
            "layers": [{"name": name, "thickness_m": thickness} for name, thickness in LAYERS],
        },
        "grid": [NODES, NODES],
        "under_m": 0.0,
        "instruments": [
            instrument("left", left, (-0.05, -0.01, 0.1), (0.018, 0.028, 0.006)),
            instrument("right", right, (0.11, -0.01, 0.1), (0.042, 0.030, 0.006)),
        ],
        "camera": {"port_m": [0.03, -0.07, 0.11], "target_m": [0.03, 0.03, 0.0]},
        "linear_force_n": LINEAR,
        "rate_hz": 1000,
        "lessons": False,
        "steered_by": steered_by,
    }


@dataclass(frozen=True)
class Hand:
    """Where a script holds an instrument."""

    tip: tuple[float, float, float]  # [m]
    jaw: float = 1.0
    roll: float = 0.0
    present: bool = True


@dataclass
class Pose:
    """A pose as it came."""

    sequence: int
    present: bool
    handle: np.ndarray
    roll: float
    jaw: float


@dataclass
class SyntheticTrainer:
    """What the server knows; the test looks into it and changes it while the page runs."""

    greeting: dict = field(default_factory=hello)
    wander: tuple[float, float, float] | None = None  # x, y, depth [m] of a dent of its own
    drag: tuple[float, float, float] | None = (
        None  # x, y of a place and how far it is drawn aside along x [m]
    )
    script: Callable[[float], tuple[Hand, Hand]] | None = (
        None  # of the time since the start [s], instead of poses
    )
    status: int = 1
    poses: dict[int, Pose] = field(default_factory=dict)
    acknowledged: list[int] = field(default_factory=list)
    texts: list[dict] = field(default_factory=list)
    errors: list[str] = field(default_factory=list)
    outstanding: int = 0  # most frames ever on their way
    notices: list[dict] = field(default_factory=list)
    port: int = 0
    answering: threading.Event = field(default_factory=threading.Event)
    _connections: list = field(default_factory=list)
    _touches: tuple[Touch, Touch] = field(default_factory=lambda: (Touch(), Touch()))
    _started: float = field(default_factory=time.monotonic)

    def __post_init__(self) -> None:
        self.answering.set()

    def hang_up(self) -> None:
        """Drop the page, and refuse it until `answering` is set."""
        self.answering.clear()
        for connection in self._connections:
            connection.close(1001, "the trainer stops")

    def tip(self, which: int) -> np.ndarray:
        """Return where an instrument's tip is [m], by the fulcrum."""
        shape = self.greeting["instruments"][which]
        pose = self.poses.get(which)
        handle = pose.handle if pose else np.array(shape["handle_m"])
        along = np.subtract(shape["port_m"], handle)
        return handle + shape["length_m"] * along / np.linalg.norm(along)

    def hands(self, now: float) -> tuple[Hand, Hand]:
        """Return both instruments at a time since the start [s]."""
        if self.script is not None:
            return self.script(now)
        left, right = (
            Hand(tuple(self.tip(which)), pose.jaw, pose.roll) if pose else Hand(tuple(self.tip(which)))
            for which, pose in ((which, self.poses.get(which)) for which in (0, 1))
        )
        return left, right

    def frame(self, sequence: int) -> bytes:
        """Return the present state as a frame."""
        now = time.monotonic() - self._started
        moved = np.zeros((3, NODES, NODES))
        if self.wander is not None:
            moved[2] -= self.wander[2] * bump(*self.wander[:2])
        if self.drag is not None:
            moved[0] += self.drag[2] * bump(*self.drag[:2])
        records = []
        for shape, touch, hand in zip(
            self.greeting["instruments"], self._touches, self.hands(now), strict=True
        ):
            tip = np.array(hand.tip)
            touch.follow(tip if hand.present else np.array(shape["port_m"]), hand.jaw)
            moved += touch.moved()
            along = np.subtract(tip, shape["port_m"])
            along /= np.linalg.norm(along)
            flags = touch.flags if hand.present else 0
            forces = (*touch.force, *touch.force)
            records.append(
                struct.pack("<8f6fIf", *tip, *along, hand.roll, hand.jaw, *forces, flags, touch.depth)
            )
        rest = np.array([0.0, *np.cumsum([thickness for _, thickness in LAYERS])])
        fade = 1 - rest[:-1] / rest[-1]  # deeper layers move less
        planes = np.concatenate([fade[:, None, None] * moved[2], moved[:2]])
        header = struct.pack(
            "<IIQd2IfIffI4HI", 0x314F5254, sequence, int(1e3 * now), now,
            *(self.poses[which].sequence if which in self.poses else 0 for which in (0, 1)),
            999.6, 3, 24.0, 61.0, self.status, len(LAYERS), NODES, NODES, 1, 0,
        )  # fmt: skip
        return header + b"".join(records) + (1e3 * planes).astype("<f2").tobytes()

    def converse(self, connection) -> None:
        """Talk to one page until it leaves."""
        self.poses.clear()
        self.acknowledged.clear()
        self._connections.append(connection)
        connection.send(json.dumps(self.greeting))
        listening = threading.Thread(target=self.listen, args=(connection,), daemon=True)
        listening.start()
        sequence = 0
        try:
            while listening.is_alive():
                while self.notices:
                    connection.send(json.dumps(self.notices.pop(0)))
                on_their_way = sequence - max(self.acknowledged, default=0)
                if on_their_way < UNACKNOWLEDGED:
                    sequence += 1
                    self.outstanding = max(self.outstanding, on_their_way + 1)
                    connection.send(self.frame(sequence))
                time.sleep(PERIOD)
        except ConnectionClosed:
            pass

    def listen(self, connection) -> None:
        """Take what the page sends until it leaves, politely or not."""
        with suppress(ConnectionClosed):
            self.take(connection)

    def take(self, messages) -> None:
        """Take what the page sends; what breaks the contract is kept as an error."""
        for message in messages:
            if isinstance(message, str):
                text = json.loads(message)
                if text["type"] == "ack":
                    self.acknowledged.append(text["sequence"])
                else:
                    self.texts.append(text)
                continue
            if len(message) != 48:
                self.errors.append(f"a pose of {len(message)} bytes")
                continue
            magic, sequence, which, flags, x, y, z, roll, jaw = struct.unpack("<4I3d2f", message)
            known = self.poses.get(which)
            if (
                magic != 0x45534F50
                or which > 1
                or not 0 <= jaw <= 1
                or not np.all(np.isfinite([x, y, z, roll]))
            ):
                self.errors.append(f"a pose that is none: {message.hex()}")
            elif known is not None and sequence <= known.sequence:
                self.errors.append(f"pose {sequence} after {known.sequence}")
            else:
                self.poses[which] = Pose(sequence, bool(flags & 1), np.array([x, y, z]), roll, jaw)

    def respond(self, connection, request) -> Response | None:
        """Serve the built client's files; anything for /live goes on to the WebSocket."""
        if request.path == "/live":
            return (
                None
                if self.answering.is_set()
                else connection.respond(HTTPStatus.SERVICE_UNAVAILABLE, "later\n")
            )
        path = STATIC / (request.path.partition("?")[0].lstrip("/") or "index.html")
        if STATIC not in path.resolve().parents or not path.is_file():
            return connection.respond(HTTPStatus.NOT_FOUND, "there is no such file\n")
        body = path.read_bytes()
        kind = mimetypes.guess_type(path.name)[0] or "application/octet-stream"
        headers = Headers(
            {"Content-Type": kind, "Content-Length": str(len(body)), "Content-Security-Policy": POLICY,
             "Cross-Origin-Opener-Policy": "same-origin", "Cross-Origin-Embedder-Policy": "require-corp",
             "X-Content-Type-Options": "nosniff", "Referrer-Policy": "no-referrer", "Connection": "close"}
        )  # fmt: skip
        return Response(200, "OK", headers, body)

    def start(self):
        """Serve on a free port of loopback; call `shutdown` of what is returned at the end."""
        server = serve(self.converse, "127.0.0.1", 0, process_request=self.respond, compression=None)
        self.port = server.socket.getsockname()[1]
        threading.Thread(target=server.serve_forever, daemon=True).start()
        return server
