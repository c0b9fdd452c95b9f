"""An attempt from beginning to end: a task's scene, a player or a recording in it, and the score card that follows.

A score is a function of the recording alone: the poses as they were, tick by tick. They are played through the scene
once more, forces come out of that, and task and metrics see nothing else.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cache, lru_cache
from math import inf, isfinite, nan

import numpy as np

from trocar.contact.instrument import Instrument
from trocar.contact.tips import largest_sections
from trocar.errors import InputError
from trocar.model import FloatArray
from trocar.simulation import DT, POSE, RECORD, Scene, make_scene
from trocar.simulation.kind import AnyScene, kind_of
from trocar.simulation.live import live_model
from trocar.simulation.organ import make_organ_scene, surface_heights
from trocar.simulation.phantom import Phantom
from trocar.simulation.sheet_scene import make_sheet_scene
from trocar.tissues.catalogue import tissue
from trocar.tissues.nodule import Nodule
from trocar.tissues.tissue import Tissue
from trocar.training.metrics.attempt import Attempt
from trocar.training.metrics.measures import MEASURES, measured
from trocar.training.players import Ground, Player, level
from trocar.training.score import score
from trocar.training.tasks.moment import Moment
from trocar.training.tasks.progress import TOO_MUCH, Mistake, Progress
from trocar.training.tasks.task import Task
from trocar.waves.membrane import WaveMembrane
from trocar.waves.sheet.sheet import Sheet
from trocar.waves.solid import WaveSolid

LONGEST = 600.0  # [s] of an attempt without an end


@dataclass(frozen=True, kw_only=True)
class Recording:
    """What was done, tick by tick.

    Attributes:
        poses: of both handles as the scene consumed them, shape (n, 2, POSE).
        dt: length of a tick [s].
        resets: numbers of the ticks, from 0, before which the tissue was put to rest once more.
        skipped: ticks that a servo missed meanwhile; the tissue's time stood still for them.
    """

    poses: FloatArray
    dt: float = DT
    resets: tuple[int, ...] = ()
    skipped: int = 0

    def __post_init__(self) -> None:
        if self.poses.ndim != 3 or self.poses.shape[1:] != (2, POSE):
            raise InputError("recording: poses", f"shape (n, 2, {POSE})", self.poses.shape)
        if not np.isfinite(self.poses).all():
            raise InputError("recording: poses", "finite numbers alone", "one that is not")

    def played(self, scene: AnyScene) -> FloatArray:
        """Return the records of both instruments in every tick, from rest, shape (n, 2, RECORD)."""
        stretches = np.split(self.poses, list(self.resets))
        return np.concatenate([kind_of(scene).played(scene, stretch) for stretch in stretches])

    @property
    def times(self) -> FloatArray:
        """Of the ticks' ends [s], shape (n,)."""
        return np.asarray(self.dt * np.arange(1, len(self.poses) + 1), dtype=np.float64)


@dataclass(frozen=True, kw_only=True)
class Card:
    """A score card.

    Attributes:
        task: name.
        level: of it.
        score: 0 to 100 and, for who is quicker than the scripted expert, above.
        passed: whether the score is high enough and every step was done.
        completed: whether every step was done.
        duration: [s].
        metrics: by name; nan where one does not exist.
        mistakes: in order.
        advice: what to do better, the most useful first.
        skipped: time the servo missed meanwhile [s]; the tissue's clock, by which an attempt is timed, stood still.
    """

    task: str
    level: int
    score: float
    passed: bool
    completed: bool
    duration: float
    metrics: Mapping[str, float]
    mistakes: tuple[Mistake, ...]
    advice: tuple[str, ...]
    skipped: float = 0.0

    def as_dict(self) -> dict[str, object]:
        """Return it as JSON takes it; a metric that does not exist is left out."""
        units = {measure.name: measure.unit for measure in MEASURES}
        return {
            "task": self.task,
            "level": self.level,
            "score": self.score,
            "passed": self.passed,
            "completed": self.completed,
            "duration_s": self.duration,
            "skipped_s": self.skipped,
            "metrics": {
                name: {"value": value, "unit": units[name]}
                for name, value in self.metrics.items()
                if isfinite(value)
            },
            "mistakes": [
                {"time_s": one.time, "step": one.step + 1, "words": one.words} for one in self.mistakes
            ],
            "advice": list(self.advice),
        }


@cache
def _model(name: str) -> WaveMembrane | WaveSolid:
    return live_model(tissue(name))


def scene_of(task: Task) -> AnyScene:
    """Return the scene a task is done in."""
    return _scene(task.tissue, task.instruments, task.nodules, task.sheet, task.organ)


@lru_cache(maxsize=8)
def _scene(
    name: str,
    instruments: tuple[Instrument, Instrument],
    nodules: tuple[Nodule, ...],
    sheet: Sheet | None,
    organ: Phantom | None,
) -> AnyScene:
    if organ is not None:
        return make_organ_scene(organ.organ, instruments)
    if sheet is not None:
        return make_sheet_scene(sheet, instruments)
    return make_scene(_model(name), tissue(name), instruments, nodules=nodules)


def _stuff(task: Task) -> Tissue:
    return tissue(task.tissue) if task.organ is None else task.organ.stuff


def ground_of(task: Task) -> Ground:
    """Return how high the surface of what a task is done on lies at rest."""
    if task.organ is None:
        return level
    scene = scene_of(task)
    assert isinstance(scene, Scene)
    return surface_heights(scene)


def perform(
    task: Task, player: Player, *, watch: Callable[[float, FloatArray], None] = lambda time, poses: None
) -> Recording:
    """Let a player do a task, and return what was done.

    Args:
        task: what to do.
        player: who does it.
        watch: told the time of the attempt [s] and both poses, shape (2, POSE), every tick.
    """
    scene = scene_of(task)
    kind, progress = kind_of(scene), Progress(task)
    state = kind.at_rest(scene)
    records = np.zeros((2, RECORD))
    moment = Moment(0.0, records)
    limit = min(LONGEST, task.marking.cutoff)
    poses: list[FloatArray] = []
    while not progress.done and moment.time < limit:
        poses.append(player.poses(moment, progress))
        kind.advance(scene, state, poses[-1], records)
        moment = Moment(scene.dt * len(poses), records)
        progress.advance(moment)
        watch(moment.time, poses[-1])
    return Recording(poses=np.stack(poses), dt=scene.dt)


def replayed(task: Task, recording: Recording) -> tuple[Attempt, Progress]:
    """Play a recording through the task's scene, up to its last step's end: what comes after is nobody's business.

    Raises:
        InputError: nobody holds an instrument in it, or its ticks are not the scene's.
    """
    scene = scene_of(task)
    if recording.dt != scene.dt:
        raise InputError("recording: dt", f"{scene.dt:g} s, the scene's tick", f"{recording.dt:g} s")
    return judged(task, recording.times, recording.played(scene))


def judged(task: Task, times: FloatArray, records: FloatArray) -> tuple[Attempt, Progress]:
    """Let a task see what came of an attempt, up to its last step's end.

    Args:
        task: what was attempted.
        times: of the ticks [s], shape (n,).
        records: of both instruments in the task's scene, shape (n, 2, RECORD).

    Raises:
        InputError: nobody holds an instrument in it.
    """
    progress = Progress(task)
    ticks = 0
    for time, both in zip(times, records, strict=True):
        if progress.done:
            break
        progress.advance(Moment(float(time), both))
        ticks += 1
    attempt = Attempt(
        times=times[:ticks],
        records=records[:ticks],
        force_limit=task.force_limit,
        ideal_length=task.ideal_length if progress.done else nan,
        errors=len(progress.mistakes),
        strength=nan if task.sheet is not None else _weakest(_stuff(task)),
        line=task.line,
        sections=largest_sections(scene_of(task).axes),
    )
    return attempt, progress


def assess(task: Task, recording: Recording) -> Card:
    """Play a recording through the task's scene and mark it.

    Raises:
        InputError: nobody holds an instrument in it, or its ticks are not the scene's.
    """
    card = marked(task, *replayed(task, recording))
    return replace(card, skipped=recording.skipped * recording.dt)


def marked(task: Task, attempt: Attempt, progress: Progress) -> Card:
    """Mark an attempt that was played."""
    metrics = measured(attempt)
    found = score(
        task.marking,
        time=attempt.duration,
        errors=len(progress.mistakes),
        over_limit=metrics["time_over_limit"],
        off=metrics["cut_deviation"] if isfinite(metrics["cut_deviation"]) else 0.0,
    ) * float(progress.done)
    passed = progress.done and found >= task.marking.pass_score
    return Card(
        task=task.name,
        level=task.level,
        score=found,
        passed=passed,
        completed=progress.done,
        duration=attempt.duration,
        metrics=metrics,
        mistakes=tuple(progress.mistakes),
        advice=tuple(_advice(task, progress, metrics)),
    )


def _weakest(layers: Tissue) -> float:
    """Return the least tensile strength that a layer states [Pa]; nan where none does."""
    return min(
        (layer.tensile_strength for layer in layers.layers if isfinite(layer.tensile_strength)), default=nan
    )


def _advice(task: Task, progress: Progress, metrics: Mapping[str, float]) -> list[str]:
    """Say what cost most first."""
    marking = task.marking
    costs = []
    if progress.done:
        costs.append((metrics["time"] - marking.expert_time, _SLOW))
    else:
        left = f"Go on to the end, or there are no points. What was left: {task.steps[progress.number].words}"
        costs.append((inf, left))
    for words in sorted({one.words for one in progress.mistakes}):
        times = sum(one.words == words for one in progress.mistakes)
        over = marking.per_second_over_limit * metrics["time_over_limit"] if words == TOO_MUCH else 0.0
        often = "once" if times == 1 else f"{times} times"
        costs.append((marking.per_error * times + over, f"You {words} {often}{_REMEDIES.get(words, '.')}"))
    costs.sort(key=lambda each: -each[0])
    return [words for cost, words in costs if cost > 0.1 * marking.expert_time] or [
        "Nothing cost you much. Try the next level, or be quicker with the same care."
    ]


_SLOW = "Time cost you much: go straight from mark to mark, and look for the next while you finish this one."
_REMEDIES = {
    TOO_MUCH: ": come down slowly, and stop when the bar is at its mark.",
    "pressed beside the mark": ": go over the mark before you come down.",
    "lifted off the line": ": keep the bar from reaching zero.",
    "pressed too hard on the line": ": press less where you move.",
    "left the line": ": go slower where it bends.",
    "worked on tissue that was not held down": ": look at the holding hand's bar before you press.",
    "took hold where nothing is": ": feel all around before you close the jaw, and compare.",
    "cut beside the line": ": bring the tip over the line before you close the blades, and bite less where it bends.",
    "took hold beside the mark": ": go over the mark before you close the jaw.",
}
