"""One engine through one case: how far from finite elements it comes to rest or swings, and what a second costs it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import log2, pi, sin
from time import process_time

import numpy as np
from engine_rungs import Engine, Rung

from trocar.errors import SolverError
from trocar.model import FloatArray, Press, Support
from trocar.reference.fea import FEASolid
from trocar.study.cost.accuracy import DYNAMIC, LARGE, SMALL, Point, Trial
from trocar.study.deflection import search_points
from trocar.study.half_sine import DURATION, SAMPLE
from trocar.study.stiffening import Dent

TICK = 1e-3  # [s]
STEP = 2.5e-4  # [s] of the dynamic case, as finite elements take it
PARTS = 4  # of the large force
TIMED = 5  # steps
LONGEST = 40.0  # [s] a rung may take before its engine's finer ones are left out


def engine_points(trial: Trial, rungs: Sequence[Rung]) -> Iterator[Point]:
    """Run the rungs of a case, and yield each as it is done."""
    slow: set[str] = set()
    for rung in rungs:
        if trial.name not in rung.cases or rung.engine in slow:
            continue
        began = process_time()
        yield _point(trial, rung)
        if process_time() - began > LONGEST:
            slow.add(rung.engine)


def _point(trial: Trial, rung: Rung) -> Point:
    began = process_time()
    common = {"case": trial.name, "model": rung.engine, "setting": rung.setting}
    try:
        engine = rung.build(trial.dent)
        set_up = process_time() - began
        if trial.name == DYNAMIC:
            found, step = swing(engine, trial.load[0], STEP, rung.share), STEP
            every = round(TICK / SAMPLE)
            error = float(np.abs(found - trial.answer[::every]).max() / np.abs(trial.answer).max())
        else:
            found, step = _deflections(engine, trial, rung.share), TICK
            error = float(np.abs(found / trial.answer - 1).max())
    except SolverError as problem:
        spent = process_time() - began
        return Point(error=None, second_s=0.0, set_up_s=spent, dofs=0, failure=str(problem), **common)
    return Point(
        error=error,
        second_s=_step_time(engine, trial, step, rung.share) / step,
        set_up_s=set_up,
        dofs=engine.dofs,
        **common,
    )


def _deflections(engine: Engine, trial: Trial, share: float) -> FloatArray:
    """Return the largest deflection of every layer [m]."""
    forces = engine.mesh.forces(trial.load)
    if trial.name == LARGE:
        share = 1.0
        for part in range(1, PARTS):
            engine.rest(part / PARTS * forces)
    down = -engine.rest(share * forces)[:, 2] / share
    points = search_points(trial.dent.size, trial.load)[:, :2]
    return np.array(
        [(engine.mesh.surface(points, layer) @ down).max() for layer in range(len(trial.dent.tissue.layers))]
    )


def swing(engine: Engine, press: Press, dt: float, share: float) -> FloatArray:
    """Return the deflection under the middle of a half sine and as long after it, at every millisecond [m]."""
    unit = share * engine.mesh.forces((press,))
    middle = engine.mesh.surface(np.array([[press.x, press.y]]))
    found = [0.0]
    for tick in range(round(2 * DURATION / TICK)):
        for part in range(round(TICK / dt)):
            times = tick * TICK + dt * np.array([part, part + 1])
            now, then = (sin(pi * time / DURATION) if time < DURATION else 0.0 for time in times)
            engine.step(0.5 * (now + then) * unit, dt)
        found.append(-float((middle @ engine.displacement()[:, 2])[0]) / share)
    return np.array(found)


def _step_time(engine: Engine, trial: Trial, dt: float, share: float) -> float:
    """Return the CPU time of a step under the load [s]."""
    forces = (1.0 if trial.name == LARGE else share) * engine.mesh.forces(trial.load)
    began = process_time()
    for _ in range(TIMED):
        engine.step(forces, dt)
        engine.displacement()
    return (process_time() - began) / TIMED


def held_sides(dent: Dent) -> float:
    """Return by how much held sides move the static answer of finite elements, of the worst layer [1]."""
    load = dent.load(SMALL)
    depths = []
    for support in (Support.BASE, Support.EDGES_AND_BASE):
        model = FEASolid(dent.tissue, size=dent.size, support=support, around=load)
        depths.append(np.array(list(model.largest_deflection(model.static(load)).values())))
    return float(np.abs(depths[1] / depths[0] - 1).max())


def steps(trial: Trial, rung: Rung, counts: Sequence[int] = (1, 2, 4, 8, 16)) -> Iterator[str]:
    """Yield what steps of a millisecond and its parts come to: error, distance from the next shorter, its order."""
    every, largest = round(TICK / SAMPLE), np.abs(trial.answer).max()
    before, apart = None, None
    yield f"{rung.engine}, {rung.setting}: step, error, from the step before, order"
    for count in counts:
        found = swing(rung.build(trial.dent), trial.load[0], TICK / count, rung.share)
        error = np.abs(found - trial.answer[::every]).max() / largest
        words = f"  {1e3 * TICK / count:.4g} ms: {100 * error:.2f} %"
        if before is not None:
            moved = np.abs(found - before).max() / largest
            words += f", {100 * moved:.2f} %" + (f", {log2(apart / moved):.2f}" if apart else "")
            apart = moved
        before = found
        yield words
