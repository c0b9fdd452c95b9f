"""The tasks there are. To add one, write a file like `palpate` and name it here; nothing else knows tasks by name."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from difflib import get_close_matches

from trocar.errors import InputError
from trocar.training.tasks.alternate import alternate
from trocar.training.tasks.bimanual_hold import bimanual_hold
from trocar.training.tasks.cut_line import cut_line
from trocar.training.tasks.find_nodule import find_nodule
from trocar.training.tasks.lift import lift
from trocar.training.tasks.oblique_reach import oblique_reach
from trocar.training.tasks.palpate import palpate
from trocar.training.tasks.palpate_organ import palpate_organ
from trocar.training.tasks.task import Task
from trocar.training.tasks.trace import trace

LEVELS = (1, 2, 3)

TASKS: Mapping[str, Callable[[int], Task]] = {
    "palpate": palpate,
    "trace": trace,
    "bimanual-hold": bimanual_hold,
    "oblique-reach": oblique_reach,
    "lift": lift,
    "alternate": alternate,
    "find-nodule": find_nodule,
    "cut-along-the-line": cut_line,
    "palpate-organ": palpate_organ,
}


def task(name: str, level: int = 1) -> Task:
    """Return a task at a level.

    Raises:
        InputError: there is no such task or level.
    """
    if name not in TASKS:
        close = get_close_matches(name, TASKS, 1)
        raise InputError("task", ", ".join(TASKS), name, f"did you mean {close[0]}?" if close else "")
    if level not in LEVELS:
        raise InputError("task: level", f"{LEVELS[0]} to {LEVELS[-1]}", level)
    return TASKS[name](level)
