"""A lesson whose trainer, or whose servo, is killed at some moment: what is then on record?"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import threading
import time
from contextlib import suppress
from dataclasses import dataclass
from http.client import HTTPConnection
from pathlib import Path
from urllib.parse import urlsplit

from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from trocar.records.store import Records
from trocar.training.strip import recorded
from trocar.web.wire import decode_frame, encode_pose
from web.scripted_source import rest_pose

LAST = 1.0  # [s] so much may be missing at the end
PATIENCE = 60.0  # [s]


@dataclass(frozen=True)
class Left:
    """What was found.

    Attributes:
        status, reason: of the attempt, seen from another process.
        lived: from its beginning to the kill, the clock's [s].
        acknowledged: said to be kept before the kill [s].
        kept: what was found [s].
        ticks: that the recording gives back.
    """

    status: str
    reason: str | None
    lived: float
    acknowledged: float
    kept: float
    ticks: int

    @property
    def good(self) -> bool:
        """Whether all that was acknowledged is there, up to the last second, and marked so."""
        whole = self.ticks == round(1e3 * self.kept)
        return (
            self.status == "interrupted"
            and self.kept >= self.acknowledged
            and self.kept >= self.lived - LAST
            and whole
        )


class Trainer:
    """`trocar train` with one client that moves a hand and begins attempts."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.process = subprocess.Popen(
            [sys.executable, "-m", "trocar", "train", "--no-browser"],
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
            env=os.environ | {"TROCAR_DATA": str(folder)},
            start_new_session=True,
        )
        address = urlsplit(self.process.stdout.readline().strip())
        self.host, self.origin = address.netloc, f"http://{address.netloc}"
        connection = HTTPConnection(self.host, timeout=PATIENCE)
        connection.request("GET", f"/?{address.query}")
        self.cookie = connection.getresponse().getheader("set-cookie").partition(";")[0]
        connection.close()
        self.newest = None
        """The state that came last."""
        self._hand = threading.Thread(target=self._move, daemon=True)
        self._hand.start()

    def ask(self, method: str, path: str, body: dict | None = None) -> dict:
        connection = HTTPConnection(self.host, timeout=PATIENCE)
        headers = {"Cookie": self.cookie, "Origin": self.origin, "Content-Type": "application/json"}
        connection.request(method, path, None if body is None else json.dumps(body), headers)
        answer = json.loads(connection.getresponse().read())
        connection.close()
        return answer

    def servo(self) -> int:
        """Return the servo's number: the one child that was spawned."""
        for entry in Path("/proc").glob("[0-9]*"):
            with suppress(OSError):
                parent = int((entry / "stat").read_text().rpartition(")")[2].split()[1])
                if parent == self.process.pid and b"spawn_main" in (entry / "cmdline").read_bytes():
                    return int(entry.name)
        raise AssertionError("the trainer has no servo")

    def lesson(self, seconds: float, *, kill_servo: bool) -> Left:
        """Begin an attempt, kill something after so long [s], and look at what is on record."""
        row = self.ask("POST", "/api/attempts", {"trainee": "Ada", "task": "palpate"})
        number, began, acknowledged = row["id"], time.monotonic(), 0.0
        while time.monotonic() - began < seconds:
            acknowledged = self.ask("GET", f"/api/attempts/{number}")["duration_s"]
            time.sleep(0.02)
        lived = time.monotonic() - began
        os.kill(self.servo() if kill_servo else self.process.pid, signal.SIGKILL)
        if kill_servo:
            end = time.monotonic() + PATIENCE
            while (
                self.ask("GET", f"/api/attempts/{number}")["status"] == "running" and time.monotonic() < end
            ):
                time.sleep(0.05)
        else:
            self.process.wait()
        with Records.open(self.folder, writing=False) as records:
            found = records.attempt(number).row
            recording = recorded(*records.chunks(number))
        return Left(
            status=found.status.value,
            reason=found.reason,
            lived=lived,
            acknowledged=acknowledged,
            kept=found.duration,
            ticks=len(recording.poses),
        )

    def close(self) -> None:
        self.process.kill()
        self.process.communicate()
        self._hand.join(10.0)

    def _move(self) -> None:
        """Wave a hand, and take what comes."""
        try:
            with connect(
                f"ws://{self.host}/live",
                origin=self.origin,
                additional_headers={"Cookie": self.cookie},
                compression=None,
                proxy=None,
            ) as stream:
                sequence = 0
                while True:
                    message = stream.recv()
                    if isinstance(message, bytes):
                        taken, self.newest = decode_frame(message)
                        stream.send(json.dumps({"type": "ack", "sequence": taken}))
                        sequence += 1
                        stream.send(encode_pose(rest_pose(1, sequence, roll=0.01 * sequence)))
        except (ConnectionClosed, OSError, EOFError):
            pass
