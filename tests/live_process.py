"""`trocar train` as a process of its own, and what a second client sees of it."""

from __future__ import annotations

import json
import queue
import subprocess
import sys
import threading
from contextlib import contextmanager, suppress
from http.client import HTTPConnection
from urllib.parse import urlsplit

from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from trocar.web.wire import decode_frame


@contextmanager
def training(*options):
    """Start the trainer in a session of its own and yield the process and its address; it is killed at the end."""
    process = subprocess.Popen(
        [sys.executable, "-m", "trocar", "train", "--no-browser", *options],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    try:
        address = process.stdout.readline().strip()
        assert address.startswith("http"), process.stderr.read()
        yield process, address
    finally:
        process.kill()
        process.communicate()


@contextmanager
def watching(address):
    """Look on beside the page: what one client's hands do, every client sees."""
    parts = urlsplit(address)
    connection = HTTPConnection(parts.netloc, timeout=10)
    connection.request("GET", f"{parts.path}?{parts.query}")
    cookie = connection.getresponse().getheader("set-cookie").partition(";")[0]
    connection.close()
    with connect(
        f"ws://{parts.netloc}/live",
        origin=f"{parts.scheme}://{parts.netloc}",
        additional_headers={"Cookie": cookie},
        compression=None,
        proxy=None,
        open_timeout=10,
        close_timeout=1,
    ) as stream:
        watcher = Watcher(stream)
        try:
            yield watcher
        finally:
            stream.close()
            watcher.reading.join(30)


class Watcher:
    """A plain client of the stream: takes every frame from a thread of its own, so that it is never idle."""

    def __init__(self, stream):
        self._stream = stream
        self._newest = queue.Queue(1)
        self.hello = json.loads(stream.recv(timeout=30))
        self.notices = []
        self.guiding = None  # what the trainee is told to do
        self.reading = threading.Thread(target=self._read, daemon=True)
        self.reading.start()

    def look(self):
        """Return the next snapshot that comes; notices that come on the way are kept."""
        with suppress(queue.Empty):
            self._newest.get_nowait()  # an older one
        return self._newest.get(timeout=60)

    def _hear(self, message):
        match message["type"]:
            case "hello":
                self.hello = message
            case "guiding":
                self.guiding = message
            case _:
                self.notices.append(message["text"])

    def _read(self):
        with suppress(ConnectionClosed):
            while True:
                message = self._stream.recv()
                if isinstance(message, str):
                    self._hear(json.loads(message))
                    continue
                sequence, snapshot = decode_frame(message)
                self._stream.send(json.dumps({"type": "ack", "sequence": sequence}))
                with suppress(queue.Empty):
                    self._newest.get_nowait()
                self._newest.put(snapshot)
