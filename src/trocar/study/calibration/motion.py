"""Readings that are no multiple of the force: with inertia, and under a rigid sphere."""

from __future__ import annotations

import itertools
from math import ceil
from typing import Any

import numpy as np
from scipy.interpolate import PchipInterpolator

from trocar.errors import InputError
from trocar.model import FloatArray
from trocar.study.calibration.measurement import Measurement
from trocar.study.calibration.parameter import Specimen
from trocar.study.calibration.probes import Probes
from trocar.study.calibration.unit_response import Build, rigid_readings
from trocar.study.cases.experiment import Case
from trocar.study.rigid import RigidTips

MOST_STEPS = 2000  # of a record with inertia
_FORCES, _FORCE_RATIO = (
    10,
    100.0,
)  # of a sphere, evenly in the logarithm: its depth is a smooth power of the force


class Moving:
    """A dead load with inertia and damping, in even steps from rest.

    Args:
        build: makes the model.
        case: whose tool.
        measurement: the force; linear between rows.
        probes: what is read; linear between steps.

    Raises:
        InputError: the record has too many steps.
    """

    def __init__(self, build: Build, case: Case, measurement: Measurement, probes: Probes) -> None:
        self._build, self._press, self._probes = build, case.tools[0].press(1.0), probes
        count = ceil(measurement.duration / measurement.interval * (1 - 1e-9))
        if count > MOST_STEPS:
            raise InputError(
                f"{measurement.source}: time_s",
                f"at most {MOST_STEPS} steps with dynamic = true",
                count,
                "cut the record, or set dynamic = false where inertia does not matter",
            )
        self._times = np.linspace(measurement.time[0], measurement.time[-1], count + 1)
        self._forces = np.interp(self._times, measurement.time, measurement.force)

    def __call__(self, specimen: Specimen) -> tuple[FloatArray, FloatArray]:
        """Return the rows [m], shape (n,), and zeros: inertia smooths a force's noise away."""
        model = self._build(specimen)
        names, state = model.layer_names, model.init()
        dt = float(self._times[1] - self._times[0])
        parts = ceil(dt / model.longest_step - 1e-9)
        parts = max(parts, 1)
        read = [np.zeros(len(self._probes.points))]
        for start, end in itertools.pairwise(self._forces):
            for f0, f1 in itertools.pairwise(np.linspace(start, end, parts + 1)):
                state = model.step(
                    state, (self._press.with_force(f0),), (self._press.with_force(f1),), dt / parts
                )
            now = state
            read.append(
                self._probes.read(lambda points, face, now=now: model.displacement(now, points, names[face]))  # type: ignore[misc]
            )
        table = np.array(read)
        which, time = self._probes.which, self._probes.time
        after = np.clip(np.searchsorted(self._times, time), 1, len(self._times) - 1)
        share = (time - self._times[after - 1]) / dt
        rows = (1 - share) * table[after - 1, which] + share * table[after, which]
        return rows, np.zeros(len(rows))


class Sphere:
    """A rigid sphere, whose depth is found at a few forces.

    Args:
        build: makes the model.
        case: whose tool.
        measurement: the force.
        probes: what is read.
    """

    def __init__(self, build: Build, case: Case, measurement: Measurement, probes: Probes) -> None:
        self._build, self._case, self._probes = build, case, probes
        self._force = np.interp(probes.time, measurement.time, measurement.force)
        self._known = np.geomspace(measurement.peak / _FORCE_RATIO, measurement.peak, _FORCES)

    def __call__(self, specimen: Specimen) -> tuple[FloatArray, FloatArray]:
        """Return the rows [m] and their slopes over the force [m/N], both of shape (n,)."""
        model: Any = self._build(specimen)
        tips = RigidTips(model, self._case.tools)
        read = np.array([rigid_readings(tips, self._probes, float(force)) for force in self._known[::-1]])
        # depth / force^(2/3) is nearly even (Hertz), and exactly where the block is thick and the dent small
        even = PchipInterpolator(np.log(self._known), read[::-1] / self._known[:, None] ** (2 / 3), axis=0)
        force = np.maximum(self._force, 0.0)
        at = np.log(np.clip(force, self._known[0], None))
        rows = np.take_along_axis(even(at), self._probes.which[:, None], 1)[:, 0] * force ** (2 / 3)
        return rows, 2 / 3 * rows / np.maximum(force, self._known[0])
