"""A press of half a sine in time, through any models: the test that asks for inertia and damping."""

from __future__ import annotations

import itertools
from collections.abc import Mapping

import numpy as np

from trocar.model import FloatArray, Press
from trocar.study.models import AnyModel

DURATION = 0.02  # [s] of the press
AFTER = 0.02  # [s] watched when it is over
SAMPLE = 5e-4  # [s]; the force is linear in between
_SUBSTEPS = (
    2  # per sample: 0.25 ms, a 160th of the period of the press, for the implicit model; the waves need none
)


def half_sine(
    models: Mapping[str, AnyModel], press: Press, layer: str | None = None
) -> dict[str, FloatArray]:
    """Return the deflection under the middle of the tool.

    Args:
        models: of one block, by name.
        press: whose force is the peak.
        layer: whose upper face; None means the top one.

    Returns:
        "time" [s] and, by each model's name, the deflection [m]; all of shape (n,).
    """
    times = np.linspace(0.0, DURATION + AFTER, round((DURATION + AFTER) / SAMPLE) + 1)
    forces = np.where(times < DURATION, press.force * np.sin(np.pi * times / DURATION), 0.0)
    under = np.array([[press.x, press.y, 0.0]])
    curves: dict[str, FloatArray] = {"time": times}
    for name, model in models.items():
        steps = _SUBSTEPS
        state, depths = model.init(), [0.0]
        for f0, f1 in itertools.pairwise(forces):
            marks = np.linspace(f0, f1, steps + 1)
            for g0, g1 in itertools.pairwise(marks):
                state = model.step(state, (press.with_force(g0),), (press.with_force(g1),), SAMPLE / steps)
            depths.append(-model.displacement(state, under, layer)[0, 2])
        curves[name] = np.array(depths)
    return curves
