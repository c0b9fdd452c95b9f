"""The fit: damped Gauss-Newton in free coordinates, noise found on the way.

Sought are free coordinates x (`parameter`) with the least

    sum over rows of ((reading - prediction(x) - offset)/sigma)^2 + sum of ((x - start)/3)^2.

Offsets, one for each depth, are linear and are eliminated: residuals and their derivatives lose their mean. The second
sum is a prior so wide (a factor of twenty each way) that it is felt only where data are silent; there it keeps a
parameter at its start. sigma is estimated from the residual of each series and the fit repeated until it stays. Where a
force's noise is stated too, sigma^2 = sigma_u^2 + (response to a force at once)^2 sigma_F^2, which makes the least
squares those of a line with errors in both coordinates (D. York 1966, Can. J. Phys. 44:1079).

Derivatives are forward differences. A prediction is one static solve or some twenty, smooth and good to 1e-10, so a
step of 1e-4 leaves an error of 1e-4 in a derivative, which changes how a Gauss-Newton step goes but not where it ends.
An adjoint would save solves that cost milliseconds, and complex steps do not go through the compiled float64 kernels.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from trocar.model import FloatArray
from trocar.study.calibration.measurement import Measurement
from trocar.study.calibration.noise import Noise, assess, white_noise
from trocar.study.calibration.parameter import Parameter, Specimen
from trocar.study.calibration.probes import Probes
from trocar.study.calibration.response import Response

PRIOR = 3.0  # standard deviation of a free coordinate before the data: a factor of twenty
STEP = 1e-4
STEP_OF_SHEETS = 1e-2  # sheets are fitted to their layers anew, which is smooth to 1e-5 or so
_SETTLED = 0.03  # change of every sigma's logarithm at which the fit is not repeated
_SETTLED_ALONE = 0.5  # where all rows share one, which then weighs against nothing but the prior
_MOST_ROUNDS = 4
_MOST_EVALUATIONS = 60
_ENDS = 1e-7  # relative: a sum of squares of a hundred is then minimal within a hundredth of a standard error
_LEAST_NOISE = 1e-6  # of a series' range: data without noise are still rounded

Watch = Callable[[str], None]


@dataclass(frozen=True, kw_only=True)
class Problem:
    """What is fitted to what.

    Attributes:
        measurement: the data.
        probes: where its rows look.
        response: predicts the rows.
        parameters: sought.
        start: specimen the fit begins with.
        used: rows the fit may see, shape (n,).
        noise_force: standard deviation of the force's noise [N]; None where unknown.
        noise_depth: that of the readings [m]; None where unknown.
        zeroed: whether depths are trusted to be zero without force.
        step: of differences.
    """

    measurement: Measurement
    probes: Probes
    response: Response
    parameters: tuple[Parameter, ...]
    start: Specimen
    used: np.ndarray
    noise_force: float | None = None
    noise_depth: float | None = None
    zeroed: bool = False
    step: float = STEP

    @property
    def first(self) -> FloatArray:
        """Free coordinates of the start."""
        return np.array([item.free(item.get(self.start)) for item in self.parameters])

    def specimen(self, free: FloatArray) -> Specimen:
        """Return the specimen at free coordinates."""
        made = self.start
        for item, x in zip(self.parameters, free.tolist(), strict=True):
            made = item.put(made, item.value(x))
        return made

    def readings(self) -> FloatArray:
        """Return all readings [m], shape (n,)."""
        return np.concatenate([series.value for series in self.measurement.series])

    def offset(self, part: int) -> bool:
        """Return whether a series has an unknown zero."""
        return self.measurement.series[part].has_offset and not self.zeroed


@dataclass(frozen=True, kw_only=True)
class Fitted:
    """Where the fit ended.

    Attributes:
        free: coordinates, shape (p,).
        rows: predicted, offsets left out [m], shape (n,).
        at_once: response of each row to a force at once [m/N], shape (n,).
        slopes: of `rows` over the coordinates [m], shape (n, p).
        offsets: of each series [m].
        noise: of each series.
        at_bound: which parameters ended at a bound, shape (p,).
        evaluations: predictions made.
    """

    free: FloatArray
    rows: FloatArray
    at_once: FloatArray
    slopes: FloatArray
    offsets: FloatArray
    noise: tuple[Noise, ...]
    at_bound: np.ndarray
    evaluations: int


def fit(problem: Problem, watch: Watch = lambda _: None) -> Fitted:
    """Fit.

    Args:
        problem: data, model and parameters.
        watch: told what goes on.

    Raises:
        SolverError: a model could not be solved.
    """
    work = _Work(problem, watch)
    bounds = np.array([item.bounds(item.get(problem.start)) for item in problem.parameters])
    margin = 1e-6 * (bounds[:, 1] - bounds[:, 0])
    first = np.clip(problem.first, bounds[:, 0] + margin, bounds[:, 1] - margin)
    free = first
    sigmas = work.first_noise(free)
    for _ in range(_MOST_ROUNDS):
        work.sigmas = sigmas
        found = least_squares(
            work.misfit,
            free,
            jac=work.misfit_slopes,
            bounds=(bounds[:, 0], bounds[:, 1]),
            xtol=_ENDS,
            ftol=_ENDS,
            gtol=_ENDS,
            max_nfev=_MOST_EVALUATIONS,
        )
        free = np.asarray(found.x, dtype=np.float64)
        settled = np.array([one.rms for one in work.noise(free)])
        if problem.noise_depth is not None:
            break
        settled = work.without_force(settled, free)
        changed = np.abs(np.log(settled / sigmas)).max()
        sigmas = settled
        if changed < (_SETTLED_ALONE if len(settled) == 1 and problem.noise_force is None else _SETTLED):
            break
    rows, at_once = work.predict(free)
    offsets = work.offsets(rows)
    return Fitted(
        free=free,
        rows=rows,
        at_once=at_once,
        slopes=work.slopes(free),
        offsets=offsets,
        noise=work.noise(free),
        at_bound=(free < bounds[:, 0] + 1e3 * margin) | (free > bounds[:, 1] - 1e3 * margin),
        evaluations=work.evaluations,
    )


class _Work:
    """Predictions as least squares want them; each is kept until the next."""

    def __init__(self, problem: Problem, watch: Watch) -> None:
        self._problem, self._watch = problem, watch
        self._readings = problem.readings()
        self._known: dict[bytes, tuple[FloatArray, FloatArray]] = {}
        self.sigmas = np.empty(0)
        self.evaluations = 0

    def predict(self, free: FloatArray) -> tuple[FloatArray, FloatArray]:
        key = free.tobytes()
        if key not in self._known:
            if len(self._known) > 4 * (len(free) + 2):
                self._known.clear()
            self._known[key] = self._problem.response(self._problem.specimen(free))
            self.evaluations += 1
            self._watch(f"{self.evaluations} predictions")
        return self._known[key]

    def slopes(self, free: FloatArray) -> FloatArray:
        rows, _ = self.predict(free)
        return np.stack(
            [(self.predict(at)[0] - rows) / self._problem.step for at in self._stepped(free)], axis=1
        )

    def _stepped(self, free: FloatArray) -> FloatArray:
        return np.asarray(free + self._problem.step * np.eye(len(free)), dtype=np.float64)

    def _parts(self) -> list[tuple[int, np.ndarray]]:
        """Return the rows of each series that the fit may see."""
        every = np.arange(len(self._readings))
        return [
            (i, every[part][self._problem.used[part]]) for i, part in enumerate(self._problem.probes.parts)
        ]

    def offsets(self, rows: FloatArray) -> FloatArray:
        left = self._readings - rows
        return np.array([left[at].mean() if self._problem.offset(i) else 0.0 for i, at in self._parts()])

    def misfit(self, free: FloatArray) -> FloatArray:
        rows, at_once = self.predict(free)
        left = self._readings - rows
        offsets = self.offsets(rows)
        force = self._problem.noise_force or 0.0
        parts = [
            (left[at] - offsets[i]) / np.sqrt(self.sigmas[i] ** 2 + (force * at_once[at]) ** 2)
            for i, at in self._parts()
        ]
        return np.concatenate([*parts, (free - self._problem.first) / PRIOR])

    def misfit_slopes(self, free: FloatArray) -> FloatArray:
        here = self.misfit(free)
        return np.stack([(self.misfit(at) - here) / self._problem.step for at in self._stepped(free)], axis=1)

    def first_noise(self, free: FloatArray) -> FloatArray:
        """Return what to begin with [m]: what was stated, else what changes from row to row."""
        series, given = self._problem.measurement.series, self._problem.noise_depth
        sigmas = [white_noise(one.value) if given is None else given for one in series]
        return self.without_force(np.array(sigmas), free)

    def without_force(self, sigmas: FloatArray, free: FloatArray) -> FloatArray:
        """Return the readings' own part of their noise [m], never quite none."""
        force = self._problem.noise_force or 0.0
        _, at_once = self.predict(free)
        least = np.array([max(_LEAST_NOISE * one.range, 1e-12) for one in self._problem.measurement.series])
        if self._problem.noise_depth is not None or force == 0:
            return np.asarray(np.maximum(sigmas, least), dtype=np.float64)
        shares = np.array([np.mean((force * at_once[at]) ** 2) for _, at in self._parts()])
        return np.asarray(np.sqrt(np.maximum(sigmas**2 - shares, least**2)), dtype=np.float64)

    def noise(self, free: FloatArray) -> tuple[Noise, ...]:
        rows, at_once = self.predict(free)
        left, offsets = self._readings - rows, self.offsets(rows)
        whole = sum(len(at) for _, at in self._parts())
        problem, found = self._problem, []
        for i, at in self._parts():
            given = None
            if problem.noise_depth is not None:
                force = (problem.noise_force or 0.0) * at_once[at]
                given = float(np.sqrt(problem.noise_depth**2 + np.mean(force**2)))
            series = problem.measurement.series[i]
            found.append(
                assess(
                    series.name,
                    left[at] - offsets[i],
                    fitted=problem.offset(i) + len(free) * len(at) / whole,
                    given=given,
                    spread=series.range,
                    serial=series.places is None,
                )
            )
        return tuple(found)
