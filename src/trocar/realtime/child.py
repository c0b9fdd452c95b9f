"""How the trainer starts a process of its own: deaf to Ctrl-C from its first moment, and computing with one thread."""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from multiprocessing import resource_tracker
from multiprocessing.context import SpawnProcess

_THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")


def start_deaf(process: SpawnProcess) -> None:
    """Start a process that Ctrl-C does not reach before it ignores it itself (`privileges.ignore_interrupts`).

    Args:
        process: made by the context "spawn", not started.
    """
    resource_tracker.ensure_running()  # it would take SIGINT's block away below, were it started there
    blocked = signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])
    try:
        with _one_thread():
            process.start()
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, blocked)


@contextmanager
def _one_thread() -> Iterator[None]:
    """Let a process that is started now compute with one thread: those of a library wait for each other."""
    before = {name: os.environ.get(name) for name in _THREADS}
    os.environ.update(dict.fromkeys(_THREADS, "1"))
    try:
        yield
    finally:
        for name in _THREADS:
            del os.environ[name]
        os.environ.update({name: value for name, value in before.items() if value is not None})
