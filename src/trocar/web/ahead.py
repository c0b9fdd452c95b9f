"""Machine code made ahead: what tasks need is compiled once and kept in numba's caches, so that nobody waits for it.

What moves a block, an organ and a sheet are different machine codes, and each takes a minute or so to compile. The
trainer compiles what it shows at its start; the rest this module does, beside it and at the lowest priority.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from multiprocessing import get_context
from typing import Any

import numpy as np
from numba import typeof as untyped_typeof

from trocar.realtime.child import start_deaf
from trocar.realtime.physics import compiled
from trocar.realtime.privileges import die_with_parent, ignore_interrupts
from trocar.simulation import POSE, RECORD
from trocar.simulation.kind import kind_of
from trocar.training.tasks.catalogue import TASKS, task
from trocar.training.tasks.task import Task
from trocar.web.stage import Stage, stage_of
from trocar.web.trainer import servo_of

typeof: Any = untyped_typeof
_LOWEST = 19  # priority


def of_each_kind() -> dict[str, Task]:
    """Return one task done on each kind of scene, by what it is done on."""
    kinds: dict[str, Task] = {}
    for one in map(task, TASKS):
        kinds.setdefault(_ground(one), one)
    return kinds


def prepare(say: Callable[[str, float], None] = lambda what, share: None) -> None:
    """Compile what every task needs, or find it in the caches.

    Args:
        say: takes what is being done and the share of the whole that is behind, 0 to 1 [1].
    """
    kinds = of_each_kind()
    for number, (ground, one) in enumerate(kinds.items()):
        say(f"compiling what moves {ground}", number / len(kinds))
        stage = stage_of(one)
        servo_of(stage).compile()
        say(f"compiling what marks an attempt on {ground}", (number + 0.8) / len(kinds))
        compile_marking(stage)


def compile_marking(stage: Stage) -> None:
    """Compile what plays an attempt again, for its card and its film."""
    kind = kind_of(stage.scene)
    history = np.zeros((0, 2, POSE)), np.zeros((0, 2, RECORD))
    values = (stage.scene, kind.at_rest(stage.scene), *history)
    compiled(kind.play, tuple(typeof(value) for value in values))


@contextmanager
def preparing() -> Iterator[None]:
    """Let a process of the lowest priority do it for as long as the block runs.

    To be used in the main thread: the process is killed with the thread that starts it.
    """
    process = get_context("spawn").Process(
        target=_beside, args=(os.getpid(),), name="trocar ahead", daemon=True
    )
    start_deaf(process)
    try:
        yield
    finally:
        process.kill()  # what it had not kept yet is lost, and nothing else: caches are written whole
        process.join()


def _ground(one: Task) -> str:
    return "a sheet" if one.sheet is not None else "an organ" if one.organ is not None else "a block"


def _beside(parent: int) -> None:
    """Be the process; what goes wrong is told where the code is needed, or by `trocar prepare`."""
    ignore_interrupts()
    die_with_parent()
    os.nice(_LOWEST)
    if os.getppid() == parent:
        with suppress(Exception):
            prepare()
