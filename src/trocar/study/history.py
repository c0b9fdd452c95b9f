"""One case through one model: deflection of every layer against time, and what it cost."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass
from time import process_time

import numpy as np

from trocar.model import FloatArray, State
from trocar.study.cases.experiment import Case
from trocar.study.deflection import deflections, search_points
from trocar.study.linear_range import LinearRange, linear_range
from trocar.study.models import AnyModel
from trocar.study.stated_range import departures

Progress = Callable[[float], None]
_MOST_STEPS = 4000  # in one case: a longer one takes longer steps, its load being slower too


@dataclass(frozen=True, kw_only=True)
class History:
    """What one model says of one case.

    Attributes:
        model: its name.
        time: samples [s], shape (n,).
        force: of all tools together, along their axes [N], shape (n,).
        deflection: largest of each layer's upper face [m], layers top first, each of shape (n,).
        cpu_seconds: processor time of building the model and of all samples [s].
        setup_seconds: the part of it spent before the first sample [s].
        dofs: unknowns solved for.
        linear_range: how far the largest load of all tools together lies from the end of the linear range.
        fit_error: how far a fitted model missed what it was fitted to [1]; 0 where nothing was fitted.
        departures: why, linearity aside, the model is not stated for this case; empty where it is.
    """

    model: str
    time: FloatArray
    force: FloatArray
    deflection: dict[str, FloatArray]
    cpu_seconds: float
    setup_seconds: float
    dofs: int
    linear_range: LinearRange
    fit_error: float
    departures: tuple[str, ...]

    @property
    def in_range(self) -> bool:
        """Whether the model is stated for this case."""
        return self.linear_range.inside and not self.departures

    @property
    def block(self) -> FloatArray:
        """Largest deflection of any face at each time [m], shape (n,)."""
        result: FloatArray = np.max(list(self.deflection.values()), axis=0)
        return result


def run(
    case: Case, name: str, build: Callable[[Case], AnyModel], progress: Progress = lambda _: None
) -> History:
    """Run a case through a model.

    Args:
        case: the experiment.
        name: of the model.
        build: makes the model for the case.
        progress: told the share done, 0 to 1.
    """
    began = process_time()
    model = build(case)
    times = case.sample_times()
    layers = case.tissue.layer_names
    follow = _moving if case.sampling.dynamic else _quasi_static
    depths, setup, furthest = follow(case, model, times, progress)
    done = process_time()
    peaks = tuple(tool.press(tool.peak) for tool in case.tools)
    fit_error = getattr(model, "fit_error", None) or 0.0
    return History(
        model=name,
        time=times,
        force=np.array([sum(press.force for press in case.load_at(t)) for t in times]),
        deflection=dict(zip(layers, depths, strict=True)),
        cpu_seconds=done - began,
        setup_seconds=setup - began,
        dofs=model.dofs,
        fit_error=fit_error,
        departures=departures(case, name, fit_error=fit_error, modes=getattr(model, "modes", None)),
        linear_range=linear_range(model, case.tissue, peaks, furthest),
    )


def _quasi_static(
    case: Case, model: AnyModel, times: FloatArray, progress: Progress
) -> tuple[FloatArray, float, None]:
    """Superpose each tool's response to 1 N: the models are linear, so equilibria add and scale."""
    load = case.load_at(0.0)
    points = search_points(case.size, load)
    layers = case.tissue.layer_names
    units = []
    for i, press in enumerate(load):
        units.append(deflections(model, model.static((press.with_force(1.0),)), points, layers))
        progress((i + 1) / len(load))
    setup = process_time()
    forces = np.array([[press.force for press in case.load_at(t)] for t in times])
    if len(units) == 1:
        return np.outer(units[0].max(axis=1), forces[:, 0]), setup, None
    depths = np.empty((len(layers), len(times)))
    for i, at in enumerate(forces):
        depths[:, i] = np.tensordot(at, np.stack(units), 1).max(axis=1)
    return depths, setup, None


def _moving(
    case: Case, model: AnyModel, times: FloatArray, progress: Progress
) -> tuple[FloatArray, float, State]:
    """Step through the load; return the state of the largest deflection too."""
    points = search_points(case.size, case.load_at(0.0))
    layers = case.tissue.layer_names
    state = furthest = model.init()
    longest = max(model.longest_step, case.duration / _MOST_STEPS)
    depths = np.zeros((len(layers), len(times)))
    setup = process_time()
    for i, (start, end) in enumerate(itertools.pairwise(times)):
        count = max(1, int(np.ceil((end - start) / longest - 1e-9)))
        marks = np.linspace(start, end, count + 1)
        for t0, t1 in itertools.pairwise(marks):
            state = model.step(state, case.load_at(t0), case.load_at(t1), t1 - t0)
        depths[:, i + 1] = deflections(model, state, points, layers).max(axis=1)
        if depths[:, i + 1].max() > depths[:, : i + 1].max():
            furthest = state
        progress((i + 1) / (len(times) - 1))
    return depths, setup, furthest
