"""What is wrong with a fit, in sentences: parameters at their bounds, readings that the model cannot follow, and why.

Where what a depth leaves is like the prediction itself, no parameter could scale it. Else it is compared with three
shapes, each cleared of what the fit could take up itself: the square of the force (tissue that stiffens or softens),
the force's direction (a loop of loading and unloading), and the time since the force stood still (creep). The one that
explains most of it is named.
"""

from __future__ import annotations

import numpy as np

from trocar.model import FloatArray
from trocar.study.calibration.fit import Fitted, Problem
from trocar.study.calibration.identifiability import Knowledge
from trocar.study.report.table import percent
from trocar.units import MILLIMETRE

_ABOVE_NOISE = 3.0  # residual over noise, and
_OF_RANGE = 0.01  # over the range of the readings: a model that misses less is followed well enough
_EXPLAINED = 0.4  # share of the residual's squares one shape has to explain to be named
_STILL = 1e-3  # of the largest force: less change between rows is a hold
_OFFSET = 0.01  # of the range: a smaller zero offset is not worth a word
_FAR_START = 30.0  # a start whose prediction is this many times off


def warnings(problem: Problem, fitted: Fitted, known: Knowledge, limit: float) -> tuple[str, ...]:
    """Return what a reader must know before using the values.

    Args:
        problem: what was fitted.
        fitted: where it ended.
        known: what the data tell.
        limit: force at which the fitted tissue leaves its linear range [N].
    """
    said = []
    for item in known.estimates:
        if item.at_bound:
            unit = "" if item.parameter.unit == "1" else f" {item.parameter.unit}"
            said.append(
                f"{item.parameter.name} ran into the end of what may be tried, {item.value / item.parameter.factor:.3g}"
                f"{unit}: no value of it fits. Fit something else, or look at the data."
            )
    for i, noise in enumerate(fitted.noise):
        if noise.excess > _ABOVE_NOISE and noise.rms > _OF_RANGE * noise.range:
            said.append(
                f"The model cannot follow the {noise.name}: it leaves {noise.rms / MILLIMETRE:.2g} mm, "
                f"{percent(noise.rms / noise.range)} of its range and {noise.excess:.0f} times the noise. "
                f"{_reason(problem, fitted, i)}"
            )
    for noise, offset in zip(fitted.noise, fitted.offsets.tolist(), strict=True):
        if abs(offset) > _OFFSET * noise.range:
            said.append(
                f"The {noise.name} is {offset / MILLIMETRE:.3g} mm where the model has it zero: the offset was "
                "estimated and taken off."
            )
    if problem.measurement.peak > limit:
        said.append(
            f"The largest force, {problem.measurement.peak:.3g} N, is beyond the linear range of the fitted tissue, "
            f"which ends near {limit:.2g} N: its values are effective ones, for this load. Fit the part below for the "
            "tissue's own."
        )
    return tuple(said)


def _reason(problem: Problem, fitted: Fitted, part: int) -> str:
    series = problem.measurement.series[part]
    if series.places is not None:
        return "Are the markers in the block's coordinates, its corner the origin?"
    rows = problem.probes.parts[part]
    seen = problem.used[rows]
    left = (series.value - fitted.rows[rows] - fitted.offsets[part])[seen]
    force = np.interp(series.time, problem.measurement.time, problem.measurement.force)
    level = np.ones(seen.sum())
    scale = _explained(fitted.rows[rows][seen], [level], left)
    if abs(scale) > _EXPLAINED:
        return (
            f"The readings are {'larger' if scale > 0 else 'smaller'} than it can make them whatever "
            "the parameters: fit one that bears more of the load."
        )
    own = [fitted.rows[rows][seen], level, *fitted.slopes[rows][seen].T]
    shares = {name: _explained(shape[seen], own, left) for name, shape in _shapes(series.time, force).items()}
    best = max(shares, key=lambda name: abs(shares[name]))
    if abs(shares[best]) < _EXPLAINED:
        return "What is left has no shape known here; look at the report's residuals."
    if best == "curvature":
        stiffens = shares[best] < 0
        return (
            f"The tissue {'stiffens' if stiffens else 'softens'} as the force grows, and a linear model cannot: fit "
            "the part of small forces."
        )
    if best == "loop":
        return "It moves otherwise as the force rises than as it falls: let a layer remember (prony), or fit one way."
    return "It goes on while the force stands still: let a layer remember (prony = [[g, tau_s]]) and fit g and tau."


def _shapes(time: FloatArray, force: FloatArray) -> dict[str, FloatArray]:
    change = np.gradient(force, time)
    still = np.abs(change) * np.median(np.diff(time)) < _STILL * force.max()
    held = np.zeros(len(time))
    for i in range(1, len(time)):
        held[i] = held[i - 1] + (time[i] - time[i - 1]) if still[i] else 0.0
    return {
        "curvature": (force / force.max()) ** 2,
        "loop": np.where(still, 0.0, np.sign(change)) * force / force.max(),
        "creep": np.log1p(held / max(float(np.median(np.diff(time))), 1e-12)),
    }


def _explained(shape: FloatArray, own: list[FloatArray], left: FloatArray) -> float:
    """Return the share of the residual's squares that a shape explains beside the fit's own, with the slope's sign."""
    basis = np.stack(own, axis=1)
    basis = basis / np.maximum(np.abs(basis).max(axis=0), 1e-300)
    rest = shape - basis @ np.linalg.lstsq(basis, shape, rcond=None)[0]
    size = float(rest @ rest)
    if size < 1e-12 * float(shape @ shape):
        return 0.0
    along = float(rest @ left)
    return float(np.sign(along) * along**2 / size / max(float(left @ left), 1e-300))
