"""What one tick of the live trainer costs, beside what the machine could do at best and what else there is."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from itertools import pairwise
from time import perf_counter, perf_counter_ns

import numpy as np

from trocar.contact.instrument import Instrument, TipKind
from trocar.contact.tips import TIPS
from trocar.model import FloatArray, Load, Press, Profile, Support
from trocar.reference import FEASolid
from trocar.simulation import (
    DT,
    FORCE,
    RECORD,
    Scene,
    SceneState,
    advance,
    at_rest,
    make_scene,
    play,
    played,
    poses_along,
)
from trocar.study.cost.clock import cpu_time, empty_loop, triad_bandwidth
from trocar.tissues.tissue import Tissue
from trocar.waves.cutoff import modes_for
from trocar.waves.membrane import WaveMembrane
from trocar.waves.near_field import SMOOTH
from trocar.waves.tick import Tick

_TICKS = 400  # of the history: both tips go round
_LANDING = 100  # ticks before it, in which they come down from above the block
_SINGLE_TICKS = 4000  # single calls that the 99th percentile is taken of
_RELEASED_TICKS = 20_000  # 20 s after release: long enough for what decays at 40/s to pass below 1e-308
_FEA_STEPS = 5
_FINER = 1e-2  # of the tolerance: what the scene with all modes that matter is made for
_APART = 0.5  # of the block's width, between the tips
_TOGETHER = 1.5  # of their diameter, where they are close
_ROUND = 3e-3  # [m] radius of the circle a tip goes along, 47 mm/s
_DEEP = 0.2  # of a tip's diameter
_OVER = 2e-3  # [m] above the block, where they come from
_LENGTH, _ABOVE, _ASIDE = (
    0.31,
    0.1,
    0.08,
)  # [m] of the shafts; their ports, above the block and from its middle


@dataclass(frozen=True, kw_only=True)
class TickCost:
    """One tick of 1 ms with two probes that slide over the tissue, in microseconds of CPU time unless said otherwise.

    Attributes:
        diameter_mm: of both tips, balls.
        layers: of the tissue.
        modes: that move, of each layer.
        oscillators: modes times layers.
        error: largest difference of a force from that with all modes that matter, over the largest force [1].
        pressing: points that press in a tick, of both patches, mean over the history.
        tick_us, tick_least_us: a tick inside a compiled loop, median and least of the repeats.
        together_us: the same with the tips close together, solved as one.
        call_us, call_p99_us: a tick called from Python, wall time, median and 99th percentile.
        released_us: a tick 20 s after both instruments were taken away.
        empty_us: one pass of an empty compiled loop.
        kilobytes: that a tick reads and writes.
        triad_gb_s: bandwidth of a triad over as many bytes.
        floor_us: the former over the latter.
        python_us: a step and its read-out by `WaveMembrane`, without contact.
        fea_us: one prefactored finite-element step of 1 ms under one tool in the middle, default mesh.
        fea_dofs, fea_solver: its unknowns and who solves.
        set_up_s: of the scene, the fit of its membranes left out.
        compile_s: the first history; a fraction of it once the compiled code is cached.
    """

    diameter_mm: float
    layers: int
    modes: int
    oscillators: int
    error: float
    pressing: float
    tick_us: float
    tick_least_us: float
    together_us: float
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
    """Measure a tick of two probes with tips of one radius [m] on a fitted membrane.

    Args:
        tissue: the layers.
        size: sides of the block [m].
        radius: of the tips [m].
        tolerance: of what a patch feels, that the modes are chosen for [1].
    """
    stack = WaveMembrane.fitted(tissue, size=size, modes=(1, 1), support=Support.BASE).stack
    modes = modes_for(2 * SMOOTH, Profile.GAUSSIAN, size, _FINER * tolerance)
    model = WaveMembrane(stack, size=size, modes=modes, support=Support.BASE, tissue=tissue)
    instruments = two_probes(size, radius)
    began = perf_counter()
    scene = make_scene(model, tissue, instruments, tolerance=tolerance)
    set_up = perf_counter() - began

    history = poses_along(instruments, two_circles(size, radius, _APART * size[0]))
    began = perf_counter()
    coarse = played(scene, history)
    compiled = perf_counter() - began
    exact = played(make_scene(model, tissue, instruments, tolerance=_FINER * tolerance), history)
    forces = slice(FORCE, FORCE + 3)
    error = float(np.abs(coarse - exact)[..., forces].max() / np.abs(exact[..., forces]).max())

    state, records = at_rest(scene), np.zeros((_TICKS, *coarse.shape[1:]))
    played(scene, history[:_LANDING], state)
    history = history[_LANDING:]
    pressing = _pressing(scene, state, history)
    loop = cpu_time(lambda: play(scene, state, history, records), executions=len(history))
    singles = _single_calls(scene, state, history)
    together = poses_along(instruments, two_circles(size, radius, 2 * radius * _TOGETHER))[_LANDING:]
    close = cpu_time(lambda: play(scene, state, together, records), executions=len(history))
    nobody = np.zeros_like(history)
    for _ in range(_RELEASED_TICKS // len(history)):
        play(scene, state, nobody, records)
    after = cpu_time(lambda: play(scene, state, nobody, records), executions=len(history))

    bytes_touched = touched(scene.tick)
    bandwidth = triad_bandwidth(bytes_touched)
    fea, fea_us = _fea_step(tissue, size, radius)
    return TickCost(
        diameter_mm=2e3 * radius,
        layers=scene.layers,
        modes=len(scene.tick.kept),
        oscillators=len(scene.tick.kept) * scene.tick.shape[0],
        error=error,
        pressing=pressing,
        tick_us=1e6 * loop.median,
        tick_least_us=1e6 * loop.least,
        together_us=1e6 * close.median,
        call_us=1e-3 * float(np.median(singles)),
        call_p99_us=1e-3 * float(np.percentile(singles, 99)),
        released_us=1e6 * after.median,
        empty_us=1e6 * empty_loop().median,
        kilobytes=1e-3 * bytes_touched,
        triad_gb_s=1e-9 * bandwidth,
        floor_us=1e6 * bytes_touched / bandwidth,
        python_us=1e6 * _python_step(model, size, radius),
        fea_us=fea_us,
        fea_dofs=fea.dofs,
        fea_solver=fea.solver_name,
        set_up_s=set_up,
        compile_s=compiled,
    )


def two_probes(size: tuple[float, float], radius: float) -> tuple[Instrument, Instrument]:
    """Return two probes whose tips have this radius [m], through ports on both sides of the block."""
    left, right = (
        Instrument(
            name=name,
            port=(0.5 * size[0] + side * _ASIDE, 0.5 * size[1], _ABOVE),
            length=_LENGTH,
            shaft_radius=radius / TIPS[TipKind.PROBE].axes[0],
            tip=TipKind.PROBE,
            handle=(0.5 * size[0] + 2 * side * _ASIDE, 0.5 * size[1], 2 * _ABOVE),
        )
        for name, side in (("left", -1), ("right", 1))
    )
    return left, right


def two_circles(size: tuple[float, float], radius: float, apart: float) -> tuple[FloatArray, FloatArray]:
    """Return ways of two tips that slide along circles, pressed in all the time, after they came down to them.

    Args:
        size: sides of the block [m].
        radius: of the tips [m].
        apart: between the circles' middles [m].

    Returns:
        Places [m], two of shape (ticks, 3).
    """
    phase = np.linspace(0, 2 * np.pi, _TICKS, endpoint=False)
    deep = np.concatenate(
        [np.linspace(_OVER, -2 * _DEEP * radius, _LANDING), np.full(_TICKS, -2 * _DEEP * radius)]
    )
    phase = np.concatenate([np.zeros(_LANDING), phase])
    left, right = (
        np.stack(
            [
                0.5 * size[0] + 0.5 * side * apart + _ROUND * np.cos(phase),
                0.5 * size[1] + _ROUND * np.sin(phase),
                deep,
            ],
            axis=1,
        )
        for side in (-1, 1)
    )
    return left, right


def touched(tick: Tick) -> int:
    """Return the bytes that a tick reads and writes, scratch that stays in the nearest cache left out."""
    order = tick.shape[0]
    coefficients = 8 * order  # of a step, and of the top face
    changed = 2 * (2 * order + 2)  # blocks, force and face, read and written
    return int(tick.modes.sum()) * 8 * (coefficients + changed) + tick.inside.nbytes


def _pressing(scene: Scene, state: SceneState, history: FloatArray) -> float:
    records = np.zeros((2, RECORD))
    counts = []
    for poses in history:
        advance(scene, state, poses, records)
        counts.append(state.touching.sum())
    return float(np.mean(counts))


def _single_calls(scene: Scene, state: SceneState, history: FloatArray) -> FloatArray:
    taken, records = np.empty(_SINGLE_TICKS), np.zeros((2, RECORD))
    for i in range(_SINGLE_TICKS):
        poses = history[i % len(history)]
        began = perf_counter_ns()
        advance(scene, state, poses, records)
        taken[i] = perf_counter_ns() - began
    return taken


def _python_step(model: WaveMembrane, size: tuple[float, float], radius: float) -> float:
    left, right = two_circles(size, radius, _APART * size[0])
    loads: list[Load] = [
        tuple(
            Press(x=x, y=y, radius=2 * SMOOTH, force=0.1, profile=Profile.GAUSSIAN)
            for x, y in (left[i, :2].tolist(), right[i, :2].tolist())
        )
        for i in range(11)
    ]

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
