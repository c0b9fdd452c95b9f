"""An attempt as a table: every tick of both instruments, poses, what they felt and how far the task had come.

A plain CSV that spreadsheets and pandas read as they are, one line per tick and instrument, and beside it a JSON with
what does not change: `attempt.csv` and `attempt.task.json`. Numbers are written in the shortest form that reads back
as the same float64. It ends with the last step, as the score card does, so every metric of the card follows from
these two files alone; `bench/recompute_metrics.py` finds them so, with none of this package's code.
"""

from __future__ import annotations

import csv
import json
import os
from collections.abc import Iterator
from dataclasses import dataclass
from math import isfinite
from pathlib import Path
from typing import TextIO

import numpy as np

from trocar.contact.instrument import NAMES
from trocar.errors import InputError
from trocar.model import FloatArray
from trocar.simulation import (
    CUT,
    DEPTH,
    DIRECTION,
    FORCE,
    HANDLE,
    JAW,
    MOMENT,
    OUTSIDE,
    ROLL,
    TIP,
    TOUCH,
    TOUCH_HOLDING,
    TOUCH_PRESENT,
    TOUCH_TOUCHING,
)
from trocar.training.metrics.attempt import Attempt
from trocar.training.session import Recording, replayed
from trocar.training.tasks.progress import Progress
from trocar.training.tasks.task import Task
from trocar.whole_file import write_whole

_POSE = {
    "handle_x_m": HANDLE,
    "handle_y_m": HANDLE + 1,
    "handle_z_m": HANDLE + 2,
    "roll_rad": ROLL,
    "jaw": JAW,
}
_FELT = {
    **{f"tip_{axis}_m": TIP + at for at, axis in enumerate("xyz")},
    **{f"shaft_{axis}": DIRECTION + at for at, axis in enumerate("xyz")},
    "outside_m": OUTSIDE,
    **{f"force_{axis}_n": FORCE + at for at, axis in enumerate("xyz")},
    **{f"moment_{axis}_n_m": MOMENT + at for at, axis in enumerate("xyz")},
    "depth_m": DEPTH,
    "cut_links": CUT,
    "cut_from_x_m": CUT + 1,
    "cut_from_y_m": CUT + 2,
    "cut_to_x_m": CUT + 3,
    "cut_to_y_m": CUT + 4,
}
_FLAGS = {"present": TOUCH_PRESENT, "touching": TOUCH_TOUCHING, "holding": TOUCH_HOLDING}
COLUMNS = ("tick", "time_s", "instrument", *_FLAGS, *_POSE, *_FELT, "step", "mistakes")


@dataclass(frozen=True, kw_only=True)
class AttemptTable:
    """An attempt, tick by tick.

    Attributes:
        rows: of `COLUMNS`: tick from 1; time of the tick's end [s]; "left" or "right"; whether the instrument is in
            the hand, touches and holds (1 or 0); pose of the handle [m, rad, 0 closed to 1 open]; end of the tip [m];
            direction of the shaft towards it; shaft outside the port [m]; force of the tissue on the tip [N] and
            moment about its end [N m]; depth of the tip below the surface at rest [m]; what its blades cut last, for a
            while after it: how many links, and both ends at rest [m]; number of the step that is on, from 1; mistakes
            so far.
        constants: what does not change, as `write_table` puts it into the JSON.
    """

    rows: list[tuple[float | int | str, ...]]
    constants: dict[str, object]


def attempt_table(task: Task, recording: Recording) -> AttemptTable:
    """Play a recording through its task's scene, and return every tick up to the last step's end.

    Raises:
        InputError: nobody holds an instrument in it, or its ticks are not the scene's.
    """
    attempt, progress = replayed(task, recording)
    return AttemptTable(
        rows=list(_rows(recording.poses, attempt, progress)),
        constants=_constants(task, recording.dt, attempt, progress),
    )


def write_table(path: str | os.PathLike[str], task: Task, recording: Recording) -> Path:
    """Write the table and, beside it, what does not change; each is whole or not there, and replaces an older one.

    Returns:
        The place of the JSON: that of the table with `.task.json` for its ending.

    Raises:
        InputError: `path` is a folder or a JSON, or as for `attempt_table`.
        OSError: the place cannot be written to.
    """
    place = Path(path)
    if place.is_dir() or place.suffix.lower() == ".json":
        raise InputError(
            f"table: {place}", "a name for a CSV file", "a folder" if place.is_dir() else "a JSON"
        )
    beside = place.with_suffix(".task.json")
    table = attempt_table(task, recording)
    place.parent.mkdir(parents=True, exist_ok=True)

    def as_csv(stream: TextIO) -> None:
        lines = csv.writer(stream, lineterminator="\n")
        lines.writerow(COLUMNS)
        lines.writerows(table.rows)

    write_whole(place, as_csv)
    write_whole(beside, lambda stream: json.dump(table.constants, stream, indent=2, allow_nan=False))
    return beside


def _rows(poses: FloatArray, attempt: Attempt, progress: Progress) -> Iterator[tuple[float | int | str, ...]]:
    times = attempt.times
    steps = np.searchsorted(progress.ended, times, side="left") + 1
    mistakes = np.searchsorted([one.time for one in progress.mistakes], times, side="right")
    bits = attempt.records[:, :, TOUCH].astype(np.int64).tolist()
    posed = poses[: len(times), :, list(_POSE.values())].tolist()
    felt = attempt.records[:, :, list(_FELT.values())].tolist()
    ticks = zip(times.tolist(), bits, posed, felt, steps.tolist(), mistakes.tolist(), strict=True)
    for tick, (time, both, pose, touch, step, so_far) in enumerate(ticks, 1):
        for hand, name in enumerate(NAMES):
            flags = (int(both[hand] & bit != 0) for bit in _FLAGS.values())
            yield (tick, time, name, *flags, *pose[hand], *touch[hand], step, so_far)


def _constants(task: Task, dt: float, attempt: Attempt, progress: Progress) -> dict[str, object]:
    marking = task.marking
    found: dict[str, float] = {
        "dt_s": dt,
        "force_limit_n": task.force_limit,
        "ideal_length_m": task.ideal_length,
        "tensile_strength_pa": attempt.strength,
        "cutoff_s": marking.cutoff,
        "expert_time_s": marking.expert_time,
        "pass_score": marking.pass_score,
        "seconds_per_mistake": marking.per_error,
        "seconds_per_second_over_limit": marking.per_second_over_limit,
        "seconds_per_metre_off": marking.per_metre_off,
    }
    return {
        "task": task.name,
        "level": task.level,
        "tissue": task.tissue,
        "ports": task.ports,
        "steps": [step.words for step in task.steps],
        "completed": progress.done,
        "mistakes": [
            {"time_s": one.time, "step": one.step + 1, "words": one.words} for one in progress.mistakes
        ],
        **{name: value if isfinite(value) else None for name, value in found.items()},
        "line_m": [list(point) for point in task.line.points] if task.line is not None else None,
        "line_width_m": task.line.width if task.line is not None else None,
        "tip_sections_m2": [float(area) for area in attempt.sections],
    }
