"""One case through one model: deflection of every layer against time, and what it cost."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass, replace
from time import process_time
from typing import Any

import numpy as np
from scipy.interpolate import PchipInterpolator

from trocar.model import FloatArray, Load, State
from trocar.study.cases.experiment import Case
from trocar.study.deflection import deflections, points_over
from trocar.study.linear_range import LinearRange, linear_range, range_on_mesh
from trocar.study.models import AnyModel
from trocar.study.rigid import RigidTips
from trocar.study.stated_range import departures
from trocar.waves.stretch.stretching_waves import StretchingWaves

Progress = Callable[[float], None]
_FORCES = 14  # of one rigid tip that are computed; depth is a smooth power of the force in between
_SAME = 1e-6  # forces that differ by less are one
_FORCE_RATIO = 300.0  # from the largest of them to the smallest
_MOST_CREEPING_STEPS = 400  # without inertia: between corners of the load, creep is smooth
_MOST_STEPS = 4000  # in one case: a longer one takes longer steps, its load being slower too


@dataclass(frozen=True, kw_only=True)
class History:
    """What one model says of one case.

    Attributes:
        model: its name.
        time: samples [s], shape (n,).
        force: of all tools together, along their axes [N], shape (n,).
        deflection: largest of each face [m], of layers their upper ones, top first, each of shape (n,).
        cpu_seconds: processor time of building the model and of all samples [s].
        setup_seconds: the part of it spent before the first sample [s].
        dofs: unknowns solved for.
        linear_range: how far the largest load of all tools together lies from the end of the linear range.
        fit_error: how far a fitted model missed what it was fitted to [1]; 0 where nothing was fitted.
        departures: why, linearity aside, the model is not stated for this case; empty where it is.
        large_deformation: whether the model follows it, and the linear range says nothing against its numbers.
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
    large_deformation: bool = False

    @property
    def in_range(self) -> bool:
        """Whether the model is stated for this case."""
        return (self.large_deformation or self.linear_range.inside) and not self.departures

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
    model: Any = build(case)
    times = case.sample_times()
    layers = case.faces
    peaks = tuple(tool.press(tool.peak) for tool in case.tools)
    furthest: State | None = None
    large = getattr(model, "large_deformation", False)
    if case.rigid:
        depths, setup, peaks = _rigid(case, model, times, progress)
    elif case.sampling.dynamic or case.tissue.relaxation_times:
        depths, setup, furthest = _moving(case, model, times, progress)
    elif large:
        depths, setup = _following(case, model, times, progress)
    else:
        depths, setup = _quasi_static(case, model, times, progress)
    done = process_time()
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
        departures=departures(
            case,
            name,
            fit_error=fit_error,
            modes=getattr(model, "modes", None),
            deformation=model.deformation(furthest or model.static(peaks))
            if hasattr(model, "deformation") and large
            else None,
            dent=float(np.max(depths)) if isinstance(model, StretchingWaves) else None,
        ),
        linear_range=_range_at_small_strain(case, build, peaks)
        if large
        else linear_range(model, case.tissue, peaks, furthest)
        if case.mesh is None
        else range_on_mesh(case.mesh, case.faces[0], peaks),
        large_deformation=large,
    )


def _quasi_static(
    case: Case, model: AnyModel, times: FloatArray, progress: Progress
) -> tuple[FloatArray, float]:
    """Superpose each tool's response to 1 N: the models are linear, so equilibria add and scale."""
    load = case.load_at(0.0)
    points = points_over(case)
    layers = case.faces
    units = []
    for i, press in enumerate(load):
        units.append(deflections(model, model.static((press.with_force(1.0),)), points, layers))
        progress((i + 1) / len(load))
    setup = process_time()
    forces = np.array([[press.force for press in case.load_at(t)] for t in times])
    if len(units) == 1:
        return np.outer(units[0].max(axis=1), forces[:, 0]), setup
    depths = np.empty((len(layers), len(times)))
    for i, at in enumerate(forces):
        depths[:, i] = np.tensordot(at, np.stack(units), 1).max(axis=1)
    return depths, setup


def _following(
    case: Case, model: AnyModel, times: FloatArray, progress: Progress
) -> tuple[FloatArray, float]:
    """Find equilibria that do not superpose: few of a load that keeps its direction, else every one."""
    points = points_over(case)
    setup = process_time()
    totals = np.array([[press.force for press in case.load_at(t)] for t in times])
    distinct, places = np.unique(totals, axis=0, return_inverse=True)
    sizes = distinct.max(axis=1)
    direction = distinct[np.argmax(sizes)] / sizes.max()
    alike = bool(np.allclose(distinct, np.outer(sizes, direction), rtol=_SAME, atol=_SAME * sizes.max()))
    forces = np.outer(_spread(sizes), direction) if alike else distinct
    depths = np.zeros((len(forces), len(case.faces)))
    load = case.load_at(0.0)
    for i, at in enumerate(forces):
        if at.any():
            pressed = tuple(press.with_force(float(force)) for press, force in zip(load, at, strict=True))
            depths[i] = deflections(model, model.static(pressed), points, case.faces).max(axis=1)
        progress((i + 1) / len(forces))
    if alike:
        depths = _between(forces.max(axis=1), depths, sizes)
    return depths[places.ravel()].T, setup


def _range_at_small_strain(case: Case, build: Callable[[Case], AnyModel], peaks: Load) -> LinearRange:
    """Judge the same layers at small strain: the force at which linear models leave their range."""
    linear = replace(case, tissue=case.tissue.linearised)
    return linear_range(build(linear), linear.tissue, peaks)


def _rigid(case: Case, model: Any, times: FloatArray, progress: Progress) -> tuple[FloatArray, float, Load]:
    """Press rigid tips to every distinct set of forces; return too what the linear range is judged by."""
    tips = RigidTips(model, case.tools)
    setup = process_time()
    points = points_over(case)
    layers = len(case.faces)
    totals = np.array([[tool.force(t) for tool in case.tools] for t in times])
    distinct, places = np.unique(totals, axis=0, return_inverse=True)
    forces = distinct if len(case.tools) > 1 else _spread(distinct[:, 0])[:, None]
    depths = np.zeros((len(forces), layers))
    if tips.linear:
        depths = np.outer(forces[:, 0], tips.press(np.ones(1)).deflections(points))
    else:
        for i in range(len(forces) - 1, -1, -1):  # from the deepest, which tells where the next will touch
            if forces[i].any():
                depths[i] = tips.press(forces[i]).deflections(points)
            progress(1 - i / len(forces))
    if len(case.tools) == 1:
        depths = _between(forces[:, 0], depths, distinct[:, 0])
    peaks = tips.load(np.array([tool.peak for tool in case.tools]))
    return depths[places.ravel()].T, setup, peaks


def _spread(forces: FloatArray) -> FloatArray:
    """Return few forces that span those of one tool, ascending."""
    above: FloatArray = forces[forces > 0]
    above = above[np.append(np.diff(above) > _SAME * above[1:], True)]
    if len(above) <= _FORCES:
        return np.asarray(above, dtype=np.float64)
    return np.geomspace(max(above.min(), above.max() / _FORCE_RATIO), above.max(), _FORCES)


def _between(known: FloatArray, depths: FloatArray, forces: FloatArray) -> FloatArray:
    """Interpolate depths, shape (n, layers), in the logarithms of force and depth; a power of the force below."""
    result = np.zeros((len(forces), depths.shape[1]))
    above = forces > 0
    logs = np.log(depths)
    if len(known) > 1:
        curve = PchipInterpolator(np.log(known), logs, extrapolate=False)
        low = np.log(np.minimum(forces[above] / known[0], 1.0))
        power = (logs[1] - logs[0]) / np.log(known[1] / known[0])
        result[above] = np.exp(
            curve(np.log(np.clip(forces[above], known[0], known[-1]))) + np.outer(low, power)
        )
    else:
        result[above] = np.outer(forces[above] / known[0], depths[0])
    return result


def _moving(
    case: Case, model: AnyModel, times: FloatArray, progress: Progress
) -> tuple[FloatArray, float, State]:
    """Step through the load; return the state of the largest deflection too."""
    points = points_over(case)
    layers = case.faces
    state = furthest = model.init()
    most = _MOST_STEPS if case.sampling.dynamic else _MOST_CREEPING_STEPS
    longest = max(model.longest_step, case.duration / most)
    depths = np.zeros((len(layers), len(times)))
    setup = process_time()
    for i, (start, end) in enumerate(itertools.pairwise(times)):
        count = max(1, int(np.ceil((end - start) / longest - 1e-9)))
        marks = np.linspace(start, end, count + 1)
        for t0, t1 in itertools.pairwise(marks):
            dt = float(
                f"{t1 - t0:.12g}"
            )  # steps that differ by rounding are one to whoever keeps what a step needs
            state = model.step(state, case.load_at(t0), case.load_at(t1), dt)
        depths[:, i + 1] = deflections(model, state, points, layers).max(axis=1)
        if depths[:, i + 1].max() > depths[:, : i + 1].max():
            furthest = state
        progress((i + 1) / (len(times) - 1))
    return depths, setup, furthest
