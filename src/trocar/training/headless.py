"""A scripted trainee does a task with nobody present, and is marked like anybody else."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

from trocar.errors import InputError
from trocar.simulation import DT
from trocar.training.players import ScriptedPlayer, Skill
from trocar.training.session import Card, Recording, assess, perform
from trocar.training.tasks.catalogue import task as task_by_name
from trocar.training.tasks.task import Task

_TOLD_EVERY = 0.1  # [s] of the attempt


@dataclass(frozen=True, kw_only=True)
class Attempted:
    """What came of it.

    Attributes:
        task: that was attempted.
        skill: whose attempt it was.
        seed: of its chances.
        recording: what was done.
        card: how it was marked.
    """

    task: Task
    skill: Skill
    seed: int
    recording: Recording
    card: Card


def attempt(
    name: str,
    *,
    level: int = 1,
    skill: str = Skill.EXPERT,
    seed: int = 0,
    real_time: bool = False,
    watch: Callable[[float, float], None] = lambda time, limit: None,
) -> Attempted:
    """Let a scripted trainee do a task.

    Args:
        name: of the task.
        level: of it.
        skill: "expert" or "novice".
        seed: of the trainee's chances, 0 or above.
        real_time: whether it may be no faster than a person.
        watch: told the attempt's time and the most it can be [s], ten times a second of its own.

    Raises:
        InputError: there is no such task, level or skill, or the seed is negative.
    """
    if skill not in list(Skill):
        raise InputError("skill", " or ".join(Skill), skill)
    task = task_by_name(name, level)
    player = ScriptedPlayer(task.instruments, Skill(skill), seed, dt=DT)
    began, told = time.monotonic(), 0.0

    def look(now: float) -> None:
        nonlocal told
        if now - told >= _TOLD_EVERY:
            told = now
            watch(now, task.marking.cutoff)
            if real_time:
                time.sleep(max(0.0, began + now - time.monotonic()))

    recording = perform(task, player, watch=look)
    return Attempted(
        task=task, skill=Skill(skill), seed=seed, recording=recording, card=assess(task, recording)
    )
