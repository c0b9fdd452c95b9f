"""What every probe reads under one newton, at rest: one static answer for one set of parameters.

`ModelUnits` asks any tissue model. `SpectrumUnits` is `WaveSolid` where it is plainest, under an upright dead load on a
block with a held base: there the amplitude W of a wave depends on its length alone, so sixty lengths are solved
and those of the series lie between them on a cubic spline of k W in log k. That is linear in W, so the series is summed
once for the spline's own shapes and then costs a product. Both agree to 1e-6, and a fit asks some hundred times.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol

import numpy as np
from scipy.interpolate import CubicSpline

from trocar.model import FloatArray, Press
from trocar.study.calibration.parameter import Specimen
from trocar.study.calibration.probes import Probes
from trocar.study.cases.experiment import Case
from trocar.study.models import AnyModel, series_modes
from trocar.study.rigid import RigidTips
from trocar.waves.banded import surface_compliance
from trocar.waves.polarised import polarised, turned_to_axes
from trocar.waves.series import Series
from trocar.waves.thin_layer import Wavenumbers, vertical_and_along

Build = Callable[[Specimen], AnyModel]
_NODES = 60  # lengths of waves, evenly in their logarithm: a depth is missed by 4e-7 of it


class Units(Protocol):
    """Readings under one newton."""

    def __call__(self, specimen: Specimen) -> FloatArray:
        """Return them [m/N], shape (probes,)."""
        ...


class ModelUnits:
    """A dead load on any model.

    Args:
        build: makes the model.
        press: the tool's.
        probes: what is read.
    """

    def __init__(self, build: Build, press: Press, probes: Probes) -> None:
        self._build, self._load, self._probes = build, (press.with_force(1.0),), probes

    def __call__(self, specimen: Specimen) -> FloatArray:
        """Return the readings under 1 N [m/N], shape (probes,)."""
        model = self._build(specimen)
        state = model.static(self._load)
        names = model.layer_names
        return self._probes.read(lambda points, face: model.displacement(state, points, names[face]))


class RigidUnits:
    """A flat rigid tip on a wave model; the tip's own depth is what the top layer's probe reads.

    Args:
        build: makes the model.
        case: whose tool.
        probes: what is read; of markers, what goes across the face.
    """

    def __init__(self, build: Build, case: Case, probes: Probes) -> None:
        self._build, self._case, self._probes = build, case, probes

    def __call__(self, specimen: Specimen) -> FloatArray:
        """Return the readings under 1 N [m/N], shape (probes,)."""
        model: Any = self._build(specimen)
        tips = RigidTips(model, self._case.tools)
        return rigid_readings(tips, self._probes, 1.0)


def rigid_readings(tips: RigidTips, probes: Probes, force: float) -> FloatArray:
    """Return what probes read under a rigid tip's force [N], shape (probes,) [m]."""
    found = tips.press(np.array([force]))
    sunk = found.pads.deflection(found.forces, probes.points)
    result = sunk[probes.faces, np.arange(len(probes.points))] * -probes.signs
    depth = (probes.faces == 0) & (probes.signs < 0)
    result[depth] = found.depths[0]
    return np.asarray(result, dtype=np.float64)


def spectrum_serves(case: Case, names: frozenset[str]) -> bool:
    """Return whether `SpectrumUnits` is `WaveSolid` here: base held, sides simply supported, tool upright and dead.

    Args:
        case: the experiment.
        names: of the parameters that change; a prestress that differs along x and y gives waves directions.
    """
    even = all(layer.prestress_x == layer.prestress_y for layer in case.tissue.layers)
    directed = any(name.endswith((".prestress_x", ".prestress_y")) for name in names)
    held = case.support.base_held and not case.support.sides_clamped
    return held and even and not directed and not case.rigid and case.tools[0].tilt == 0


class SpectrumUnits:
    """`WaveSolid` by lengths of waves; see the module.

    Args:
        case: the experiment.
        probes: what is read.
    """

    def __init__(self, case: Case, probes: Probes) -> None:
        series = Series(case.size, series_modes(case))
        across = polarised(case.tools[0].press(1.0), series)[0]
        k = np.hypot(series.kx[:, None], series.ky[None, :])
        k[0, 0] = k[1, 1]  # carries nothing
        self._nodes = np.geomspace(min(series.kx[1], series.ky[1]), k.max(), _NODES)
        self._faces = probes.faces
        spline = CubicSpline(np.log(self._nodes), np.eye(_NODES))(np.log(np.clip(k, self._nodes[0], None)))
        self._vertical = np.zeros((len(probes.points), _NODES))
        self._along = np.zeros((len(probes.points), _NODES))
        none = np.zeros_like(across)
        aside = probes.axes < 2
        for node in range(_NODES):
            waves = (spline[..., node] / k * across)[..., None]
            self._vertical[:, node] = series.vertical(waves[..., 0], probes.points)
            if aside.any():
                x, y, _ = turned_to_axes(waves, waves, none[..., None], series)[0]
                self._along[:, node] = np.where(
                    probes.axes == 0, series.along_x(x, probes.points), series.along_y(y, probes.points)
                )
        self._vertical[aside], self._along[~aside] = 0.0, 0.0
        self._signs = probes.signs[:, None]

    def __call__(self, specimen: Specimen) -> FloatArray:
        """Return the readings under 1 N [m/N], shape (probes,)."""
        k = self._nodes
        layers = vertical_and_along(specimen.tissue.long_term, base_held=True)
        found = surface_compliance(layers, Wavenumbers(k, 0.5 * k**2, 0.5 * k**2))
        w, v = (k[:, None] * found[:, :, part, 0] for part in (0, 1))
        read = self._vertical * w.T[self._faces] + self._along * v.T[self._faces]
        return np.asarray((self._signs * read).sum(axis=1), dtype=np.float64)
