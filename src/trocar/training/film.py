"""An attempt to be looked at again: pictures of the tissue and the instruments, a few a second, out of its poses."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from numba import njit

from trocar.model import FloatArray
from trocar.simulation import RECORD, Scene, SceneState, advance, amplitudes, at_rest, come_to_rest
from trocar.training.session import Recording, scene_of
from trocar.training.tasks.moment import Moment
from trocar.training.tasks.progress import Mistake, Progress
from trocar.training.tasks.task import Task

EVERY = 40  # ticks between pictures: 25 a second


@dataclass(frozen=True, kw_only=True)
class Film:
    """Pictures one after the other.

    Attributes:
        every: time from one to the next [s]; the first is one such time after the start.
        records: of both instruments, shape (n, 2, RECORD).
        amplitudes: of the waves [m], shape (n, layers, M, N).
        steps: when each of the task's steps was done [s], as many as were.
        mistakes: in order.
    """

    every: float
    records: FloatArray
    amplitudes: npt.NDArray[np.float32]
    steps: tuple[float, ...]
    mistakes: tuple[Mistake, ...]

    def __len__(self) -> int:
        return len(self.records)


def film(task: Task, recording: Recording) -> Film:
    """Play a recording in its task's scene and keep a picture every 40 ticks."""
    scene = scene_of(task)
    count = len(recording.poses) // EVERY
    pictures = np.zeros((count, scene.layers, *scene.modes), np.float32)
    records = np.zeros((len(recording.poses), 2, RECORD))
    resets = np.zeros(len(recording.poses), np.bool_)
    resets[list(recording.resets)] = True
    picture = np.zeros(pictures.shape[1:])
    _expose(scene, at_rest(scene), recording.poses, resets, records, picture, pictures)
    progress, steps = Progress(task), []
    for time, both in zip(recording.times.tolist(), records, strict=True):
        done = progress.number
        progress.advance(Moment(time, both))
        if progress.number > done:
            steps.append(time)
    return Film(
        every=EVERY * recording.dt,
        records=records[EVERY - 1 :: EVERY],
        amplitudes=pictures,
        steps=tuple(steps),
        mistakes=tuple(progress.mistakes),
    )


@njit(cache=True, nogil=True)
def _expose(
    scene: Scene,
    state: SceneState,
    poses: FloatArray,
    resets: npt.NDArray[np.bool_],
    records: FloatArray,
    picture: FloatArray,
    pictures: npt.NDArray[np.float32],
) -> None:  # pragma: no cover - compiled
    for tick in range(len(poses)):
        if resets[tick]:
            come_to_rest(scene, state)
        advance(scene, state, poses[tick], records[tick])
        if (tick + 1) % EVERY == 0:
            amplitudes(scene, state, picture)
            pictures[tick // EVERY, :, :, :] = picture
