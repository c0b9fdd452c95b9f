"""Batter the doors of a live trainer while its servo works, and print the ticks it missed beside those of quiet rounds.

Run: python bench/doors.py [--seconds 10] [--rounds 3]. Quiet and battered rounds take turns, a quiet one at the end. In
a battered round one process after the other knocks with every wrong header, speaks every malformed message, sends
poses out of range, floods, and leaves frames half sent, all on loopback. Whoever is not refused as the tests say ends
the run with 1.
"""

from __future__ import annotations

import argparse
import socket
import sys
import time
from contextlib import closing, suppress
from multiprocessing import get_context
from multiprocessing.connection import Connection
from pathlib import Path
from types import SimpleNamespace

sys.path.insert(0, str(Path(__file__).parent.parent / "tests"))

from websockets.exceptions import ConnectionClosed

from trocar.devices.simulated import SimulatedDevice
from trocar.web.closing import Closing
from trocar.web.serve import serving
from trocar.web.stage import set_stage
from trocar.web.trainer import Trainer
from trocar.web.wire import encode_pose
from web.scripted_source import rest_pose
from web.test_doors import REQUESTS, WEBSOCKETS, filled
from web.test_refusals import MALFORMED, OUT_OF_RANGE
from web.visitor import Visitor, farewell

SETTLE = 2.0  # [s] before the first round


def batter(origin: str, port: int, cookie: str, seconds: float, told: Connection) -> None:
    """Do everything that is refused, again and again; send how often, and what was not refused as it should be."""
    visitor = Visitor.__new__(Visitor)  # a token lets in once, and it has been used
    visitor.served, visitor.origin = SimpleNamespace(port=port), origin
    visitor.host, visitor.cookie = origin.partition("//")[2], cookie
    refused, wrong = 0, []
    end = time.monotonic() + seconds

    def saw(what: str, found: object, expected: object) -> None:
        nonlocal refused
        refused += 1
        if found != expected:
            wrong.append(f"{what}: expected {expected}, got {found}")

    while time.monotonic() < end:
        for headers, status in WEBSOCKETS:
            if status != 101:
                saw(f"websocket {headers}", visitor.handshake(filled(visitor, headers)), status)
        for method, path, headers, status in REQUESTS:
            if status >= 400:
                answer = visitor.request(method, path, filled(visitor, headers))
                saw(f"{method} {path} {headers}", answer["status"], status)
        for messages, code in ((MALFORMED, Closing.MALFORMED), (OUT_OF_RANGE, Closing.OUT_OF_RANGE)):
            for name, message in messages.items():
                with visitor.live() as (stream, _):
                    stream.send(message)
                    saw(name, farewell(stream)[0], code)
        with visitor.live() as (stream, _):
            with suppress(ConnectionClosed):
                for sequence in range(1, 5000):
                    stream.send(encode_pose(rest_pose(0, sequence)))
            saw("a flood", farewell(stream)[0], Closing.TOO_MANY_MESSAGES)
        for _ in range(20):
            with closing(socket.create_connection(("127.0.0.1", port), timeout=5)) as plain:
                plain.sendall(b"\x16\x03\x01\x02\x00" + bytes(range(256)) * 16)
                plain.shutdown(socket.SHUT_WR)
                with suppress(OSError):  # refused with a reset, or with an answer
                    while plain.recv(65536):
                        pass
                refused += 1
    told.send((refused, wrong))


def round_of(trainer: Trainer, seconds: float, abuse: tuple[str, int, str] | None) -> tuple[int, int, int]:
    """Return ticks done, ticks missed and visits refused in a round.

    Raises:
        SystemExit: a visit was not refused as it should be.
    """
    before = trainer.servo.latest()
    refused = 0
    if abuse is None:
        time.sleep(seconds)
    else:
        context = get_context("spawn")
        found, told = context.Pipe(duplex=False)
        process = context.Process(target=batter, args=(*abuse, seconds, told), daemon=True)
        process.start()
        told.close()
        refused, wrong = found.recv()
        process.join()
        if wrong:
            raise SystemExit("\n".join(wrong))
    after = trainer.servo.latest()
    return after.tick - before.tick, after.missed - before.missed, refused


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seconds", type=float, default=10.0, help="of each round")
    parser.add_argument("--rounds", type=int, default=3, help="battered; one more is quiet")
    arguments = parser.parse_args()
    trainer = Trainer(set_stage("skin"), device=SimulatedDevice("press"))
    trainer.open()
    sums = {"quiet": [0, 0, 0], "battered": [0, 0, 0]}
    try:
        with serving(trainer) as served:
            visitor = Visitor(served)
            time.sleep(SETTLE)
            for number in range(2 * arguments.rounds + 1):
                kind = "battered" if number % 2 else "quiet"
                abuse = (served.origin, served.port, visitor.cookie) if number % 2 else None
                found = round_of(trainer, arguments.seconds, abuse)
                for place, value in enumerate(found):
                    sums[kind][place] += value
                print(f"{kind:9} {found[0]:7} ticks {found[1]:5} missed {found[2]:6} refused", flush=True)
    finally:
        trainer.close()
    for kind, (ticks, missed, refused) in sums.items():
        share = 100 * missed / max(ticks + missed, 1)
        print(f"all {kind:9} {ticks:7} ticks, missed {share:.3f} %, {refused} refused")


if __name__ == "__main__":  # its processes import this file
    main()
