"""A whole calibration: check, fit, assess, hold against unseen readings."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import isfinite
from typing import Any

import numpy as np

from trocar.errors import InputError
from trocar.study.calibration.diagnosis import warnings
from trocar.study.calibration.fit import STEP, STEP_OF_SHEETS, Fitted, Problem, Watch, fit
from trocar.study.calibration.held_out import HeldOut, other_record, rest_of_record
from trocar.study.calibration.identifiability import Estimate, Knowledge, knowledge
from trocar.study.calibration.measurement import Measurement
from trocar.study.calibration.memory import at_rate
from trocar.study.calibration.parameter import Specimen, parameters
from trocar.study.calibration.plausibility import check_scale, check_seen
from trocar.study.calibration.response import builder, check_model, first_specimen, lowest_points, response
from trocar.study.cases.experiment import Case
from trocar.study.linear_range import linear_range
from trocar.study.rigid import RigidTips
from trocar.units import MILLIMETRE

_MOST_PLACES = 3  # fits, each reading depths where the faces of the one before are lowest
_MOVED = 0.05  # of the tool's diameter: a lowest point that moved less is still where the depth is read
HOLD_OUT = 0.25  # of a record's time: its end, which the fit does not see
MODEL_ERROR = {"wave-solid": 0.002, "wave-membrane": 0.03, "fea": 0.002}
"""Share of a deflection each model may be off by [1]: by its mesh, against finite elements, by its sheets' misfit."""


@dataclass(frozen=True, kw_only=True)
class Calibration:
    """What came of it.

    Attributes:
        case: block, starting layers and tool.
        model: name.
        problem: what was fitted to what.
        fitted: where the fit ended.
        known: what the data tell.
        held_out: against unseen readings; None where there were none.
        warnings: sentences to be read before the values are used.
        force_limit: where the fitted tissue leaves its linear range [N].
        model_error: counted in the intervals [1].
    """

    case: Case
    model: str
    problem: Problem
    fitted: Fitted
    known: Knowledge
    held_out: HeldOut | None
    warnings: tuple[str, ...]
    force_limit: float
    model_error: float

    @property
    def specimen(self) -> Specimen:
        """The fitted layers, or sheets."""
        return self.problem.specimen(self.fitted.free)

    def as_dict(self) -> dict[str, Any]:
        """Return plain values for JSON, in the units of each name."""
        return {
            "data": self.problem.measurement.source,
            "case": self.case.title,
            "model": self.model,
            "parameters": {item.parameter.name: _plain(item) for item in self.known.estimates},
            "correlation": np.round(self.known.correlation, 6).tolist(),
            "combinations": [
                {
                    "exponents": np.round(one.exponents, 6).tolist(),
                    "relative_error": one.error if isfinite(one.error) else None,
                }
                for one in self.known.combinations
            ],
            "told": list(self.known.sentences),
            "noise": {
                noise.name: {
                    "rms_mm": noise.rms / MILLIMETRE,
                    "given_mm": None if noise.given is None else noise.given / MILLIMETRE,
                    "rows": noise.rows,
                    "independent_rows": noise.worth,
                    "offset_mm": offset / MILLIMETRE,
                }
                for noise, offset in zip(self.fitted.noise, self.fitted.offsets.tolist(), strict=True)
            },
            "model_error": self.model_error,
            "held_out": None
            if self.held_out is None
            else {
                "source": self.held_out.source,
                "rms_mm": self.held_out.rms / MILLIMETRE,
                "share": self.held_out.share,
                "over_expected": self.held_out.ratio,
                "holds": self.held_out.holds,
            },
            "linear_range_n": self.force_limit,
            "warnings": list(self.warnings),
            "predictions": self.fitted.evaluations,
        }


def _plain(item: Estimate) -> dict[str, Any]:
    factor = item.parameter.factor
    return {
        "unit": item.parameter.unit,
        "start": item.start / factor,
        "value": item.value / factor,
        "low": None if item.low is None else item.low / factor,
        "high": None if item.high is None else item.high / factor,
        "told": item.told,
        "at_bound": item.at_bound,
        "error_from_noise": item.from_noise,
        "error_from_model": item.from_model,
    }


def calibrate(
    measurement: Measurement,
    case: Case,
    names: tuple[str, ...],
    *,
    model: str = "wave-solid",
    hold_out: float = HOLD_OUT,
    check: Measurement | None = None,
    noise_force: float | None = None,
    noise_depth: float | None = None,
    zeroed: bool = False,
    model_error: float | None = None,
    watch: Watch = lambda _: None,
) -> Calibration:
    """Fit parameters of a tissue to a measurement.

    Args:
        measurement: of a press on the case's block by its tool.
        case: what stays, and where the fit starts; its tool's force does not matter.
        names: of the parameters.
        model: "wave-solid", "wave-membrane" or "fea".
        hold_out: share of the record's time that is kept from the fit, its end [1].
        check: another record of the same press, to hold the fit against; nothing of the first is then held out.
        noise_force: standard deviation of the force's noise [N]; None where unknown.
        noise_depth: that of the displacements [m]; None: estimated from what the fit leaves.
        zeroed: whether a displacement is trusted to be zero without force; else its offset is fitted too.
        model_error: share of a deflection the model may be off by [1]; None for that of `MODEL_ERROR`.
        watch: told what goes on.

    Raises:
        InputError: case, names, numbers or data cannot be, alone or together.
        SolverError: a model could not be solved.
    """
    check_model(case, model)
    _check_numbers(hold_out, noise_force, noise_depth, model_error)
    start = first_specimen(case, model, names)
    wanted = parameters(names, start)
    share = 0.0 if check is not None else hold_out
    last = measurement.time[0] + (1 - share) * measurement.duration
    of_layers = model == "wave-membrane" and start.stack is None
    attempts, near = 0, start
    while True:
        predict, read = response(case, model, measurement, near, wanted)
        problem = Problem(
            measurement=measurement,
            probes=read,
            response=predict,
            parameters=wanted,
            start=start,
            used=read.time <= last * (1 + 1e-12),
            noise_force=noise_force,
            noise_depth=noise_depth,
            zeroed=zeroed,
            step=STEP_OF_SHEETS if of_layers else STEP,
        )
        if attempts == 0:
            check_seen(problem)
            check_scale(problem, predict(start)[0])
        fitted = fit(problem, watch)
        attempts, near = attempts + 1, problem.specimen(fitted.free)
        moved = read.moved(lowest_points(case, model, near), _MOVED * case.tools[0].diameter)
        if not moved or attempts == _MOST_PLACES:
            break
    error = MODEL_ERROR[model] if model_error is None else model_error
    known = knowledge(problem, fitted, error)
    if check is None:
        held = rest_of_record(problem, fitted, known)
    else:
        other, other_read = response(case, model, check, near, wanted)
        held = other_record(
            problem,
            replace(problem, measurement=check, probes=other_read, response=other),
            fitted,
            known,
        )
    limit = _force_limit(case, model, near, measurement.peak)
    return Calibration(
        case=case,
        model=model,
        problem=problem,
        fitted=fitted,
        known=known,
        held_out=held,
        warnings=warnings(problem, fitted, known, limit),
        force_limit=limit,
        model_error=error,
    )


def _check_numbers(
    hold_out: float, noise_force: float | None, noise_depth: float | None, model_error: float | None
) -> None:
    if not 0 <= hold_out <= 0.9:
        raise InputError("--hold-out", "a share from 0 to 0.9", hold_out)
    if model_error is not None and not 0 <= model_error <= 1:
        raise InputError("--model-error", "a share from 0 to 1", model_error)
    for flag, value in (("--noise-n", noise_force), ("--noise-mm", noise_depth)):
        if value is not None and not (isfinite(value) and value > 0):
            raise InputError(flag, "a finite number above 0", value)


def _force_limit(case: Case, model: str, specimen: Specimen, peak: float) -> float:
    """Return the force at which the fitted tissue, long after it is loaded, leaves its linear range [N]."""
    relaxed = at_rate(specimen, 0.0)
    built: Any = builder(case, model)(relaxed)
    load = RigidTips(built, case.tools).load(np.array([peak])) if case.rigid else (case.tools[0].press(peak),)
    return linear_range(built, relaxed.tissue, load).force_limit
