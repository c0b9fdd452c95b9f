"""A fit against readings it has not seen: the end of its record, or another record."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trocar.model import FloatArray
from trocar.study.calibration.fit import Fitted, Problem
from trocar.study.calibration.identifiability import Knowledge
from trocar.study.calibration.measurement import Measurement
from trocar.study.report.table import percent
from trocar.units import MILLIMETRE

HOLDS = 2.0  # errors of this many times what was to be expected are still called expected
_SMALL = 0.01  # of the range: nor is a smaller one a failure, whatever the noise


@dataclass(frozen=True, kw_only=True)
class HeldOut:
    """How a fit predicts what it was not fitted to, in the tool's depth.

    Attributes:
        source: where the readings are.
        time: [s], shape (n,).
        reading: [m], offset taken off, shape (n,).
        predicted: [m], shape (n,).
        force: [N], shape (n,).
        expected: standard deviation of their difference, noise and the parameters' errors together [m], shape (n,).
        own_zero: whether the readings' own zero offset was estimated, as another record's is.
    """

    source: str
    time: FloatArray
    reading: FloatArray
    predicted: FloatArray
    force: FloatArray
    expected: FloatArray
    own_zero: bool

    @property
    def rms(self) -> float:
        """Root mean square of the error [m]."""
        return float(np.sqrt(np.mean((self.reading - self.predicted) ** 2)))

    @property
    def share(self) -> float:
        """The error over the largest reading [1]."""
        return self.rms / float(np.abs(self.reading).max())

    @property
    def ratio(self) -> float:
        """The error over what was to be expected [1]."""
        return float(np.sqrt(np.mean(((self.reading - self.predicted) / self.expected) ** 2)))

    @property
    def holds(self) -> bool:
        """Whether the error is no larger than noise and the parameters' errors explain."""
        return self.ratio < HOLDS or self.share < _SMALL

    @property
    def sentence(self) -> str:
        """The verdict in words."""
        verdict = (
            "which is what its noise and the intervals let expect"
            if self.ratio < HOLDS
            else "more than its noise and the intervals let expect, but little"
            if self.holds
            else f"{self.ratio:.0f} times what its noise and the intervals let expect: do not trust the values beyond "
            "the rows they were fitted to"
        )
        zero = ", its own zero taken off" if self.own_zero else ""
        return (
            f"In {self.source}, which the fit did not see{zero}, the depth is predicted to "
            f"{self.rms / MILLIMETRE:.2g} mm ({percent(self.share)} of its largest), {verdict}."
        )


def rest_of_record(problem: Problem, fitted: Fitted, known: Knowledge) -> HeldOut | None:
    """Judge by the rows the fit did not use; None where it used all."""
    part = problem.probes.parts[0]
    unseen = ~problem.used[part]
    if not unseen.any():
        return None
    depth = problem.measurement.series[0]
    return _judged(
        f"the last {percent(unseen.mean())} of {problem.measurement.source}",
        problem.measurement,
        depth.value[unseen] - fitted.offsets[0],
        fitted.rows[part][unseen],
        fitted.slopes[part][unseen],
        unseen,
        fitted,
        known,
        own_zero=False,
    )


def other_record(problem: Problem, other: Problem, fitted: Fitted, known: Knowledge) -> HeldOut:
    """Judge by another record.

    Args:
        problem: what was fitted.
        other: the same with the other record's measurement, probes and response.
        fitted: where the fit ended.
        known: what it knows.
    """
    part = other.probes.parts[0]
    rows = other.response(problem.specimen(fitted.free))[0][part]
    slopes = np.stack(
        [
            (other.response(problem.specimen(at))[0][part] - rows) / problem.step
            for at in fitted.free + problem.step * np.eye(len(fitted.free))
        ],
        axis=1,
    )
    reading = other.measurement.series[0].value
    offset = 0.0 if problem.zeroed else float((reading - rows).mean())
    every = np.ones(len(reading), dtype=bool)
    return _judged(
        other.measurement.source,
        other.measurement,
        reading - offset,
        rows,
        slopes,
        every,
        fitted,
        known,
        own_zero=not problem.zeroed,
    )


def _judged(
    source: str,
    measurement: Measurement,
    reading: FloatArray,
    rows: FloatArray,
    slopes: FloatArray,
    which: np.ndarray,
    fitted: Fitted,
    known: Knowledge,
    *,
    own_zero: bool,
) -> HeldOut:
    spread = np.einsum("np,pq,nq->n", slopes, known.covariance, slopes)
    return HeldOut(
        source=source,
        time=measurement.time[which],
        reading=reading,
        predicted=rows,
        force=measurement.force[which],
        expected=np.sqrt(fitted.noise[0].used ** 2 + spread),
        own_zero=own_zero,
    )
