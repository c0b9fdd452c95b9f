"""The metrics of an attempt, each with its unit, formula, source and what it cannot tell.

Sums run over the instruments that were used. None of these scores has been validated on people with this trainer.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import isfinite, nan

import numpy as np

from trocar.model import FloatArray
from trocar.training.metrics.attempt import ROLL, SHAFT, WITHDRAWN, Attempt
from trocar.training.metrics.cuts import cut_deviation, cut_deviation_most, cut_share
from trocar.training.metrics.forces import (
    impulse,
    peak_force,
    peak_stress_ratio,
    rms_force,
    time_over_limit,
    work_on_tissue,
)
from trocar.training.metrics.motion import RATE, STRIDE, SmoothPath, strides, time_above
from trocar.training.metrics.smoothness import (
    MOVING,
    integrated_jerk,
    log_dimensionless_jerk,
    sparc_of_movements,
)

_TURN = 10 * STRIDE  # [rad]


@dataclass(frozen=True, kw_only=True)
class Measure:
    """How one metric is found.

    Attributes:
        name: as in tables, files and the score card.
        unit: SI; 1 where there is none.
        formula: in words and letters.
        source: who defined it so.
        cannot_tell: what it must not be taken for.
        of: the metric of an attempt; nan where it does not exist.
    """

    name: str
    unit: str
    formula: str
    source: str
    cannot_tell: str
    of: Callable[[Attempt], float]


def measured(attempt: Attempt) -> dict[str, float]:
    """Return every metric of an attempt by name."""
    return {measure.name: measure.of(attempt) for measure in MEASURES}


def path_length(attempt: Attempt) -> float:
    """Return how far the tips went [m]."""
    return sum(tip.length() for tip in attempt.tips.values())


def angular_path(attempt: Attempt) -> float:
    """Return how far the shafts turned about their ports and about themselves [rad]."""
    swung = sum(_turned(shaft.places) for shaft in attempt.of_used(SHAFT).values())
    return swung + sum(roll.length(_TURN) for roll in attempt.of_used(ROLL).values())


def _turned(directions: FloatArray) -> float:
    kept = directions[strides(directions, _TURN)]
    ones, others = kept[:-1], kept[1:]
    across = np.linalg.norm(np.cross(ones, others), axis=1)
    return float(np.arctan2(across, (ones * others).sum(axis=1)).sum())


def economy_of_motion(attempt: Attempt) -> float:
    """Return the shortest way over the way taken [1]."""
    taken = path_length(attempt)
    return attempt.ideal_length / taken if taken > 0 else nan


def depth_perception(attempt: Attempt) -> float:
    """Return how far the shafts slid through their ports, in and out [m]."""
    return sum(shaft.length() for shaft in attempt.of_used(WITHDRAWN).values())


def _worst(
    attempt: Attempt, of: Callable[[SmoothPath], float], worst: Callable[[list[float]], float]
) -> float:
    found = [of(tip) for tip in attempt.tips.values()]
    return worst(found) if found else nan


def _most(values: list[float]) -> float:
    """Return the largest of the values that exist; nan where none does."""
    return max((value for value in values if isfinite(value)), default=nan)


def _least(values: list[float]) -> float:
    """Return the least of the values that exist; nan where none does."""
    return min((value for value in values if isfinite(value)), default=nan)


def idle_time(attempt: Attempt) -> float:
    """Return how long the tips stood, on average over the instruments used [s]."""
    return _worst(
        attempt,
        lambda tip: tip.duration - time_above(tip.times, tip.speed, MOVING),
        lambda each: float(np.mean(each)),
    )


def bimanual_dexterity(attempt: Attempt) -> float:
    """Return how far both tips' speeds rise and fall together, -1 to 1; nan with one instrument."""
    speeds = _both_speeds(attempt)
    if speeds is None:
        return nan
    together = np.prod(speeds - speeds.mean(axis=1, keepdims=True), axis=0)
    total = float(np.abs(together).sum())
    return float(together.sum()) / total if total > 0 else nan


def both_moving(attempt: Attempt) -> float:
    """Return the share of the time in which both tips move; nan with one instrument."""
    speeds = _both_speeds(attempt)
    if speeds is None:
        return nan
    times = np.arange(speeds.shape[1]) / RATE
    return time_above(times, speeds.min(axis=0), MOVING) / float(times[-1])


def _both_speeds(attempt: Attempt) -> FloatArray | None:
    """Return speeds while both are there, shape (2, n)."""
    if len(attempt.tips) < 2:
        return None
    left, right = attempt.tips.values()
    begin, end = max(left.times[0], right.times[0]), min(left.times[-1], right.times[-1])
    times = np.arange(begin, end, 1.0 / RATE)
    if len(times) < 2:
        return None
    return np.stack([np.interp(times, tip.times, tip.speed) for tip in (left, right)])


MEASURES = (
    Measure(
        name="time",
        unit="s",
        formula="last tick less first",
        source="every trainer; separates experts from novices in JIGSAWS knot tying (AUC 0.99)",
        cannot_tell="care: whoever hurries may do harm",
        of=lambda attempt: attempt.duration,
    ),
    Measure(
        name="path_length",
        unit="m",
        formula="sum of |r(i+1) - r(i)| over both tips, in strides of 0.1 mm",
        source="EndoViS code and others",
        cannot_tell="skill: it does not separate experts from novices in JIGSAWS (AUC 0.64)",
        of=path_length,
    ),
    Measure(
        name="angular_path",
        unit="rad",
        formula="sum of the angles between shaft directions, and of |roll(i+1) - roll(i)|, in strides of 1 mrad",
        source="PMC5845064, table 2, which adds up roll, elevation and azimuth",
        cannot_tell="more than path length, where the task needs no roll",
        of=angular_path,
    ),
    Measure(
        name="economy_of_motion",
        unit="1",
        formula="length of the task's straight ways, seen from above, over path length; only of completed attempts",
        source="the definition of MIST-VR; others report the path length under this name",
        cannot_tell="anything beside path length: it is the same fact, made comparable between tasks",
        of=economy_of_motion,
    ),
    Measure(
        name="depth_perception",
        unit="m",
        formula="sum of |s(i+1) - s(i)|, s the shaft's length outside the port, in strides of 0.1 mm",
        source="as of TrEndo; the EndoViS code means another thing by this name",
        cannot_tell="whether depth was seen: it is a path length along the shaft",
        of=depth_perception,
    ),
    Measure(
        name="integrated_jerk",
        unit="1",
        formula="sqrt(T^5/(2 L^2) int |j|^2 dt), the jerk less noise's, L the path length; the larger of both tips",
        source="EndoViS code, with the dt that it leaves out",
        cannot_tell="anything that time did not: they are correlated by 0.93",
        of=lambda attempt: _worst(attempt, integrated_jerk, _most),
    ),
    Measure(
        name="log_dimensionless_jerk",
        unit="1",
        formula="-ln(T^3/v_max^2 int |j|^2 dt), the jerk less noise's; the lesser of both tips",
        source="Balasubramanian et al. 2015, with the jerk instead of the speed's second derivative",
        cannot_tell="anything that integrated jerk did not",
        of=lambda attempt: _worst(attempt, log_dimensionless_jerk, _least),
    ),
    Measure(
        name="sparc_per_movement",
        unit="1",
        formula="median spectral arc length of the movements above 5 mm/s for 0.4 s, the lesser of both tips",
        source="Balasubramanian et al. 2015",
        cannot_tell="skill: descriptive only; over whole tasks it separates nobody",
        of=lambda attempt: _worst(attempt, sparc_of_movements, _least),
    ),
    Measure(
        name="idle_time",
        unit="s",
        formula="time with a tip's speed at most 5 mm/s, mean of the instruments used",
        source="threshold of EndoViS; separates experts from novices in JIGSAWS knot tying (AUC 1.00)",
        cannot_tell="thinking from waiting, or from work slower than that",
        of=idle_time,
    ),
    Measure(
        name="bimanual_dexterity",
        unit="1",
        formula="sum of (vL - mean vL)(vR - mean vR) over the sum of its absolute values",
        source="EndoViS; not Pearson's r",
        cannot_tell="who leads; two hands that rest together count too",
        of=bimanual_dexterity,
    ),
    Measure(
        name="both_moving",
        unit="1",
        formula="share of the time in which both tips are faster than 5 mm/s",
        source="separates experts from novices in JIGSAWS knot tying (AUC 0.95)",
        cannot_tell="whether they work together",
        of=both_moving,
    ),
    Measure(
        name="peak_force",
        unit="N",
        formula="max |F| over both tips",
        source="doi 10.1089/end.2017.0894",
        cannot_tell="for how long",
        of=peak_force,
    ),
    Measure(
        name="rms_force",
        unit="N",
        formula="sqrt(mean |F|^2) of all forces above 1 mN of both tips",
        source="as peak force",
        cannot_tell="a task that needs force from a hand that gives too much",
        of=rms_force,
    ),
    Measure(
        name="impulse",
        unit="N s",
        formula="int (|F_left| + |F_right|) dt",
        source="as peak force",
        cannot_tell="a light long touch from a hard short one",
        of=impulse,
    ),
    Measure(
        name="time_over_limit",
        unit="s",
        formula="time in which either force is above the task's limit",
        source="this trainer's tasks",
        cannot_tell="by how much",
        of=time_over_limit,
    ),
    Measure(
        name="peak_stress_ratio",
        unit="1",
        formula="max |F|/(A sigma), A the largest section of the tip, sigma the weakest layer's tensile strength",
        source="this trainer's; for harm by stress: De et al. 2007, Int J Robot Res 26:1159",
        cannot_tell="harm: the stress is the least it can be, and living tissue suffers long before it tears",
        of=peak_stress_ratio,
    ),
    Measure(
        name="work_on_tissue",
        unit="J",
        formula="max over touches of -sum (F dr + M dtheta) of both tips since neither touched",
        source="mechanics; the live contact gives back no more than was put in",
        cannot_tell="what the tissue stored from what friction and damping took",
        of=work_on_tissue,
    ),
    Measure(
        name="cut_deviation",
        unit="m",
        formula="mean distance from the line of places 0.1 mm apart along all snips that cut something, at rest",
        source="this trainer's; FLS measures its circle by the area between cut and line",
        cannot_tell="how far the cut came, or whether the sheet was torn",
        of=cut_deviation,
    ),
    Measure(
        name="cut_deviation_most",
        unit="m",
        formula="the largest of these distances",
        source="as cut deviation",
        cannot_tell="a slip from a whole cut that lies beside",
        of=cut_deviation_most,
    ),
    Measure(
        name="cut_share",
        unit="1",
        formula="share of the line's points that a snip goes by, within the line's width",
        source="as cut deviation",
        cannot_tell="how near; and points at both ends count alike",
        of=cut_share,
    ),
    Measure(
        name="errors",
        unit="1",
        formula="number of mistakes that the task's steps saw",
        source="this trainer's tasks",
        cannot_tell="small from great ones; it is in the score already",
        of=lambda attempt: float(attempt.errors),
    ),
)
