"""A scripted trainee's attempt, kept on record like anybody's."""

from __future__ import annotations

from collections.abc import Callable

from trocar.records.store import Records
from trocar.simulation import DT
from trocar.training.headless import Attempted, attempt
from trocar.training.players import Skill, skill_of
from trocar.training.strip import header
from trocar.training.tasks.catalogue import task as task_by_name


def attempt_on_record(
    records: Records,
    name: str,
    *,
    level: int = 1,
    skill: str = Skill.EXPERT,
    seed: int = 0,
    trainee: str | None = None,
    real_time: bool = False,
    watch: Callable[[float, float], None] = lambda time, limit: None,
) -> Attempted:
    """Let a scripted trainee do a task as `training.headless.attempt` does, and keep it as it goes.

    Args:
        records: open for writing.
        name: of the task.
        level: of it.
        skill: "expert" or "novice".
        seed: of the trainee's chances, 0 or above.
        trainee: under whose name it is kept; "scripted expert" or "scripted novice" if not given.
        real_time: whether it may be no faster than a person.
        watch: told the attempt's time and the most it can be [s], ten times a second of its own.

    Raises:
        InputError: there is no such task, level or skill, or the seed is negative.
        RecordsError: it cannot be kept.
    """
    task = task_by_name(name, level)
    number = records.begin(
        records.trainee(trainee) if trainee else records.scripted_trainee(skill_of(skill)),
        task=task.name,
        level=level,
        device="simulated",
        header=header(DT, None),
        dt=DT,
    )
    try:
        done = attempt(
            name,
            level=level,
            skill=skill,
            seed=seed,
            real_time=real_time,
            watch=watch,
            keep=lambda data, ticks: records.add(number, data, ticks),
        )
    except BaseException as error:
        records.interrupt(number, str(error) or "it was stopped from outside")
        raise
    records.finish(number, done.card)
    return done
