"""An attempt to be looked at again: pictures of the tissue and the instruments, a few a second, out of its poses."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from trocar.model import FloatArray
from trocar.simulation import RECORD
from trocar.simulation.kind import kind_of
from trocar.training.metrics.attempt import Attempt
from trocar.training.session import Recording, judged, scene_of
from trocar.training.tasks.progress import Progress
from trocar.training.tasks.task import Task

EVERY = 40  # ticks between pictures: 25 a second


@dataclass(frozen=True, kw_only=True)
class Film:
    """Pictures one after the other.

    Attributes:
        every: time from one to the next [s]; the first is one such time after the start.
        records: of both instruments, shape (n, 2, RECORD).
        amplitudes: what is shown: of the waves, or of a sheet [m], shape (n, layers, M, N).
        attempt, progress: what the task saw of it.
    """

    every: float
    records: FloatArray
    amplitudes: npt.NDArray[np.float32]
    attempt: Attempt
    progress: Progress

    def __len__(self) -> int:
        return len(self.records)


def film(task: Task, recording: Recording) -> Film:
    """Play a recording in its task's scene and keep a picture every 40 ticks.

    Raises:
        InputError: nobody holds an instrument in it.
    """
    scene = scene_of(task)
    count = len(recording.poses) // EVERY
    pictures = np.zeros((count, scene.layers, *scene.modes), np.float32)
    records = np.zeros((len(recording.poses), 2, RECORD))
    resets = np.zeros(len(recording.poses), np.bool_)
    resets[list(recording.resets)] = True
    picture = np.zeros(pictures.shape[1:])
    kind = kind_of(scene)
    state = kind.at_rest(scene)
    ends = sorted({*range(EVERY, len(resets), EVERY), *np.flatnonzero(resets).tolist(), len(resets)} - {0})
    for begin, end in pairwise([0, *ends]):
        if resets[begin]:
            kind.come_to_rest(scene, state)
        kind.play(scene, state, recording.poses[begin:end], records[begin:end])
        if end % EVERY == 0:
            kind.amplitudes(scene, state, picture)
            pictures[end // EVERY - 1] = picture
    attempt, progress = judged(task, recording.times, records)
    return Film(
        every=EVERY * recording.dt,
        records=records[EVERY - 1 :: EVERY],
        amplitudes=pictures,
        attempt=attempt,
        progress=progress,
    )
