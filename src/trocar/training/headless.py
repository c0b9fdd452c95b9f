"""A scripted trainee does a task with nobody present, and is marked like anybody else."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from trocar.model import FloatArray
from trocar.simulation import DT
from trocar.training.players import ScriptedPlayer, Skill, skill_of
from trocar.training.session import Card, Recording, assess, ground_of, perform
from trocar.training.strip import KEEP_EVERY, told_tick_by_tick, write_piece
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
    keep: Callable[[bytes, int], None] = lambda data, ticks: None,
) -> Attempted:
    """Let a scripted trainee do a task.

    Args:
        name: of the task.
        level: of it.
        skill: "expert" or "novice".
        seed: of the trainee's chances, 0 or above.
        real_time: whether it may be no faster than a person.
        watch: told the attempt's time and the most it can be [s], ten times a second of its own.
        keep: takes each piece of the attempt's strip (`strip`) and how many ticks it holds, twice a second or so.

    Raises:
        InputError: there is no such task, level or skill, or the seed is negative.
    """
    task, kind = task_by_name(name, level), skill_of(skill)
    player = ScriptedPlayer(task.instruments, kind, seed, dt=DT, ground=ground_of(task))
    began = kept = time.monotonic()
    told = 0.0
    unkept: list[FloatArray] = []

    def store() -> None:
        nonlocal kept
        kept = time.monotonic()
        if unkept:
            keep(write_piece(told_tick_by_tick(np.stack(unkept))), len(unkept))
            unkept.clear()

    def look(now: float, poses: FloatArray) -> None:
        nonlocal told
        unkept.append(poses)
        if time.monotonic() - kept >= KEEP_EVERY:
            store()
        if now - told >= _TOLD_EVERY:
            told = now
            watch(now, task.marking.cutoff)
            if real_time:
                time.sleep(max(0.0, began + now - time.monotonic()))

    recording = perform(task, player, watch=look)
    store()
    return Attempted(task=task, skill=kind, seed=seed, recording=recording, card=assess(task, recording))
