"""Which process writes an attempt, and whether it is still there.

A process's number is given to another one sooner or later, so it is named together with the time it started at, and
both with the boot of the machine that they belong to and the namespace they are counted in::

    boot id / namespace of process numbers / number / start [clock ticks since boot]

Assumes Linux's /proc. A process in another container on the same machine cannot be looked for from here; it is taken to
be there until the machine starts anew.
"""

from __future__ import annotations

import os
from functools import cache
from pathlib import Path

_PROC = Path("/proc")
_STATE, _START = 0, 19  # among the fields after the name in /proc/PID/stat (proc(5): fields 3 and 22)
_DEAD = {"Z", "X", "x"}  # a zombie has ended; only its parent has not asked how


def this_process() -> str:
    """Return the name of the process that asks, different from every other's on any machine at any time."""
    return f"{_boot()}/{_namespace()}/{os.getpid()}/{_start(os.getpid())}"


def is_gone(owner: str) -> bool:
    """Return whether the process of that name has ended, as far as can be told from here."""
    parts = owner.split("/")
    if len(parts) != 4 or not parts[2].isdecimal():
        return True
    boot, namespace, number, start = parts
    if boot != _boot():
        return True
    if namespace != _namespace():
        return False
    return _start(int(number)) != start


def _start(number: int) -> str | None:
    """Return when a process started, or None if there is none that lives."""
    try:
        stat = (_PROC / str(number) / "stat").read_text(encoding="utf-8", errors="replace")
    except OSError:
        return None
    fields = stat.rpartition(")")[2].split()  # the name before may hold spaces and brackets
    return None if fields[_STATE] in _DEAD else fields[_START]


@cache
def _boot() -> str:
    try:
        return (_PROC / "sys/kernel/random/boot_id").read_text(encoding="ascii").strip()
    except OSError:  # a sandbox that has none
        return ""


@cache
def _namespace() -> str:
    try:
        return (_PROC / "self/ns/pid").readlink().name
    except OSError:  # a sandbox that has none
        return ""
