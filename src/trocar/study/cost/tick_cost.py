"""What one tick of the live tissue costs, beside what the machine could do at best and what else there is."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from itertools import pairwise
from time import perf_counter, perf_counter_ns

import numpy as np
from numba import njit

from trocar.model import FloatArray, Load, Press, Profile, Support
from trocar.reference import FEASolid
from trocar.study.cost.clock import cpu_time, empty_loop, triad_bandwidth
from trocar.tissues.tissue import Tissue
from trocar.waves.cutoff import measured_cutoff, modes_for
from trocar.waves.membrane import WaveMembrane
from trocar.waves.tick import Tick, TickState, advance_tick, at_rest, make_tick

DT = 1e-3  # [s] the live trainer's tick
_TICKS = 400  # of the history: a press of both tools while they move
_SINGLE_TICKS = 4000  # single calls that the 99th percentile is taken of
_RELEASED_TICKS = 20_000  # 20 s after release: long enough for what decays at 40/s to pass below 1e-308
_FEA_STEPS = 5


@dataclass(frozen=True, kw_only=True)
class TickCost:
    """One tick of 1 ms with two tools, in microseconds of CPU time unless said otherwise.

    Attributes:
        diameter_mm: of both tools' footprints.
        layers: of the tissue.
        modes: that move, of each layer.
        oscillators: modes times layers.
        error: largest difference from a model with all modes that matter, over the largest displacement [1].
        tick_us, tick_least_us: a tick inside a compiled loop, median and least of the repeats.
        call_us, call_p99_us: a tick called from Python, wall time, median and 99th percentile.
        released_us: a tick 20 s after both tools let go.
        empty_us: one pass of an empty compiled loop.
        kilobytes: that a tick reads and writes.
        triad_gb_s: bandwidth of a triad over as many bytes.
        floor_us: the former over the latter.
        python_us: the same step and read-out by `WaveMembrane`.
        fea_us: one prefactored finite-element step of 1 ms under one tool in the middle, default mesh.
        fea_dofs, fea_solver: its unknowns and who solves.
        set_up_s: modes, their fit to the layered solid left out.
        compile_s: the first call; a fraction of it once the compiled code is cached.
    """

    diameter_mm: float
    layers: int
    modes: int
    oscillators: int
    error: float
    tick_us: float
    tick_least_us: float
    call_us: float
    call_p99_us: float
    released_us: float
    empty_us: float
    kilobytes: float
    triad_gb_s: float
    floor_us: float
    python_us: float
    fea_us: float
    fea_dofs: int
    fea_solver: str
    set_up_s: float
    compile_s: float

    def as_dict(self) -> dict[str, object]:
        """Return the fields, for JSON."""
        return asdict(self)


def tick_cost(tissue: Tissue, *, size: tuple[float, float], radius: float, tolerance: float) -> TickCost:
    """Measure a tick with two Gaussian tools of one radius [m] on a fitted membrane.

    Args:
        tissue: the layers.
        size: sides of the block [m].
        radius: of the tools [m].
        tolerance: relative error of the deflection under a tool that the modes are chosen for [1].
    """
    stack = WaveMembrane.fitted(tissue, size=size, modes=(1, 1)).stack
    radii = (radius, radius)
    fine = WaveMembrane(stack, size=size, modes=modes_for(radius, Profile.GAUSSIAN, size, 1e-6 * tolerance))
    compliance = fine.static_compliance()
    began = perf_counter()
    cutoff = measured_cutoff(compliance, size, radius, Profile.GAUSSIAN, tolerance)
    modes = (int(cutoff * size[0] / np.pi), int(cutoff * size[1] / np.pi))
    model = WaveMembrane(stack, size=size, modes=modes)
    tick = make_tick(model, DT, radii, cutoff=cutoff)
    set_up = perf_counter() - began

    history = two_presses(size)
    began = perf_counter()
    coarse = played(tick, history)
    compiled = perf_counter() - began
    exact = played(make_tick(fine, DT, radii), history)
    error = float(np.abs(coarse - exact).max() / np.abs(exact).max())

    state, out = at_rest(tick), np.zeros((2, len(model.layer_names)))
    outs = np.zeros((len(history), *out.shape))
    loop = cpu_time(lambda: play(tick, state, history, outs), executions=len(history))
    singles = _single_calls(tick, state, history, out)
    released = history.copy()
    released[:, :, 2] = 0.0
    for _ in range(_RELEASED_TICKS // len(history)):
        play(tick, state, released, outs)
    after = cpu_time(lambda: play(tick, state, released, outs), executions=len(history))

    bytes_touched = touched(tick)
    bandwidth = triad_bandwidth(bytes_touched)
    fea, fea_us = _fea_step(tissue, size, radius)
    return TickCost(
        diameter_mm=2e3 * radius,
        layers=len(model.layer_names),
        modes=len(tick.kept),
        oscillators=len(tick.kept) * tick.shape[0],
        error=error,
        tick_us=1e6 * loop.median,
        tick_least_us=1e6 * loop.least,
        call_us=1e-3 * float(np.median(singles)),
        call_p99_us=1e-3 * float(np.percentile(singles, 99)),
        released_us=1e6 * after.median,
        empty_us=1e6 * empty_loop().median,
        kilobytes=1e-3 * bytes_touched,
        triad_gb_s=1e-9 * bandwidth,
        floor_us=1e6 * bytes_touched / bandwidth,
        python_us=1e6 * _python_step(model, history, radius),
        fea_us=fea_us,
        fea_dofs=fea.dofs,
        fea_solver=fea.solver_name,
        set_up_s=set_up,
        compile_s=compiled,
    )


def two_presses(size: tuple[float, float]) -> FloatArray:
    """Return x [m], y [m] and force [N] of two tools that press while they slide, shape (ticks, 2, 3)."""
    phase = np.linspace(0, 2 * np.pi, _TICKS)
    a, b = size
    first = np.stack(
        [a * (0.35 + 0.05 * np.sin(phase)), b * (0.5 + 0.1 * phase / 6.3), 0.1 * np.sin(phase / 2) ** 2]
    )
    second = np.stack(
        [a * (0.7 - 0.05 * phase / 6.3), b * (0.4 + 0.05 * np.cos(phase)), 0.06 * np.sin(phase) ** 2]
    )
    return np.ascontiguousarray(np.stack([first.T, second.T], axis=1))


def played(tick: Tick, history: FloatArray) -> FloatArray:
    """Return what every layer does under both tools, from rest, shape (ticks, tools, layers)."""
    out = np.zeros((*history.shape[:2], tick.shape[1]))
    play(tick, at_rest(tick), history, out)
    return out


@njit(cache=True)
def play(
    tick: Tick, state: TickState, history: FloatArray, out: FloatArray
) -> None:  # pragma: no cover - compiled
    """Advance through a history of tools, shape (ticks, tools, 3); writes shape (ticks, tools, layers)."""
    for i in range(len(history)):
        advance_tick(tick, state, history[i], out[i])


def touched(tick: Tick) -> int:
    """Return the bytes that a tick reads and writes, scratch that stays in the nearest cache left out."""
    order, layers, _, _ = tick.shape
    coefficients = 6 * order + layers * (2 * order + 1)
    changed = 2 * order + 1  # blocks and force, read and written
    return int(tick.modes.sum()) * 8 * (coefficients + 2 * changed)


def _single_calls(tick: Tick, state: TickState, history: FloatArray, out: FloatArray) -> FloatArray:
    taken = np.empty(_SINGLE_TICKS)
    for i in range(_SINGLE_TICKS):
        tools = history[i % len(history)]
        began = perf_counter_ns()
        advance_tick(tick, state, tools, out)
        taken[i] = perf_counter_ns() - began
    return taken


def _loads(history: FloatArray, radius: float) -> list[Load]:
    return [
        tuple(Press(x=x, y=y, radius=radius, force=f, profile=Profile.GAUSSIAN) for x, y, f in tools.tolist())
        for tools in history
    ]


def _python_step(model: WaveMembrane, history: FloatArray, radius: float) -> float:
    loads = _loads(history[100:111], radius)

    def work() -> None:
        state = model.init()
        for load0, load1 in pairwise(loads):
            state = model.step(state, load0, load1, DT)
            points = np.array([(press.x, press.y, 0.0) for press in load1])
            for name in model.layer_names:
                model.displacement(state, points, name)

    return cpu_time(work, executions=len(loads) - 1, repeats=5).median


def _fea_step(tissue: Tissue, size: tuple[float, float], radius: float) -> tuple[FEASolid, float]:
    tool = Press(x=size[0] / 2, y=size[1] / 2, radius=radius, force=0.1)
    model = FEASolid(tissue, size=size, support=Support.BASE, around=(tool,))
    state = model.step(model.init(), (tool,), (tool,), DT)

    def work() -> None:
        moving = state
        for _ in range(_FEA_STEPS):
            moving = model.step(moving, (tool,), (tool,), DT)

    return model, 1e6 * cpu_time(work, executions=_FEA_STEPS, repeats=3).median
