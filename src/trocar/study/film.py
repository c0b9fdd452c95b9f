"""Press and release, as the paper's figure 3: the tissue is pushed down, let go, and swings back to its shape."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trocar.model import FloatArray
from trocar.study.plan import Plan
from trocar.study.surface import surface
from trocar.waves.solid import WaveSolid

PRESS = 0.06  # [s] down
HOLD = 0.02  # [s]
LET_GO = 0.002  # [s] from the full force to none
AFTER = 0.098  # [s] of swinging back
POINTS = 61  # along each side


@dataclass(frozen=True, kw_only=True)
class Film:
    """Frames of the top face.

    Attributes:
        time: of each frame [s], shape (f,).
        force: along the tool [N], shape (f,).
        x, y: of the points [m], shapes (n,), (m,).
        height: u_z of the top face [m], shape (f, n, m).
        depth: of each layer's upper face under the tool's centre [m], each of shape (f,).
    """

    time: FloatArray
    force: FloatArray
    x: FloatArray
    y: FloatArray
    height: FloatArray
    depth: dict[str, FloatArray]


def press_and_release(plan: Plan) -> Film:
    """Film `WaveSolid` under the plan's small force, pressed slowly and let go at once."""
    case = plan.central(plan.small)
    (press,) = case.load_at(0.0)
    model = WaveSolid(case.tissue, size=case.size, support=case.support)
    corners = np.cumsum([0.0, PRESS, HOLD, LET_GO, AFTER])
    forces = plan.small * np.array([0.0, 1.0, 1.0, 0.0, 0.0])
    step = 0.004 if plan.quick else 0.002
    times = np.union1d(np.arange(0.0, corners[-1] + 1e-9, step), corners)
    force = np.interp(times, corners, forces)
    centre = np.array([[press.x, press.y, 0.0]])
    state = model.init()
    heights, depths = [], []
    for i, time in enumerate(times):
        if i:
            before, after = (press.with_force(force[i - 1]),), (press.with_force(force[i]),)
            state = model.step(state, before, after, time - times[i - 1])
        seen = surface(model, state, points=POINTS, layers=model.layer_names[:1])
        heights.append(seen.displacement[model.layer_names[0]][2])
        depths.append([-model.displacement(state, centre, layer)[0, 2] for layer in model.layer_names])
    return Film(
        time=times,
        force=force,
        x=np.linspace(0.0, model.size[0], POINTS),
        y=np.linspace(0.0, model.size[1], POINTS),
        height=np.array(heights),
        depth=dict(zip(model.layer_names, np.array(depths).T, strict=True)),
    )
