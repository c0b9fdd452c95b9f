"""How hard waves may be pressed: their deflection beside hyperelastic finite elements, force by force.

A dent is one flat tool in the middle of a block whose layers are neo-Hookean, pressed with a growing dead load until
the deflection is a given share of the thickness. Of every layer the largest deflection is compared.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf
from typing import Any

import numpy as np

from trocar.errors import SolverError
from trocar.model import FloatArray, Load, Press, Support
from trocar.reference.block import MeshSize
from trocar.reference.fea import FEASolid
from trocar.study.deflection import deflections, search_points
from trocar.tissues import Linear, NeoHookean, Tissue
from trocar.waves.fit import RADII
from trocar.waves.membrane import WaveMembrane
from trocar.waves.solid import WaveSolid
from trocar.waves.stretch.moduli import DEEPEST

_LONGER = 1.2  # every step in force than the one before it: what stiffens takes many
_MOST_STEPS = 24
_MEMBRANE_MODES, _SOLID_MODES, _SOLID_MOVING = (64, 64), (128, 128), (48, 48)


@dataclass(frozen=True, kw_only=True)
class Dent:
    """One tool pressed into one block.

    Args:
        name: what it is called in tables.
        tissue: the layers.
        size: sides of the block [m].
        support: how it is held.
        diameter: of the tool [m].
    """

    name: str
    tissue: Tissue
    size: tuple[float, float] = (0.06, 0.06)
    support: Support = Support.BASE
    diameter: float = 8e-3

    def load(self, force: float) -> Load:
        """Return the tool in the middle, pressed with a force [N]."""
        a, b = self.size
        return (Press(x=a / 2, y=b / 2, radius=self.diameter / 2, force=force),)


@dataclass(frozen=True, kw_only=True)
class DentCurve:
    """Deflection over force.

    Attributes:
        force: ascending [N], shape (n,).
        deflection: largest of each layer's upper face [m], shape (n, layers).
        stopped: why a reference went no further; empty where it reached the depth asked for.
    """

    force: FloatArray
    deflection: FloatArray
    stopped: str = ""


def neo_hookean(tissue: Tissue) -> Tissue:
    """Return the layers with laws for large strain: their own, or neo-Hookean where they are linear."""
    layers = tissue.layers
    return replace(
        tissue,
        layers=tuple(
            replace(layer, law=NeoHookean() if isinstance(layer.law, Linear) else layer.law)
            for layer in layers
        ),
    )


def reference_curve(
    dent: Dent, *, depth: float = DEEPEST, mesh: MeshSize | None = None, steps: int = 6
) -> DentCurve:
    """Press finite elements until some layer's deflection is `depth` times the thickness.

    Args:
        dent: what is pressed.
        depth: share of the thickness [1].
        mesh: how finely; the default of `FEASolid` where None.
        steps: about how many forces a linear block would take.
    """
    model = FEASolid(
        neo_hookean(dent.tissue), size=dent.size, support=dent.support, around=dent.load(1.0), mesh=mesh
    )
    wanted = depth * dent.tissue.thickness
    linear = FEASolid(
        dent.tissue.linearised, size=dent.size, support=dent.support, around=dent.load(1.0), mesh=mesh
    )
    unit = max(linear.largest_deflection(linear.static(dent.load(1.0))).values())
    force, step = 0.0, wanted / unit / steps
    forces: list[float] = []
    found: list[list[float]] = []
    stopped = ""
    while len(forces) < _MOST_STEPS and (not found or max(found[-1]) < wanted):
        try:
            state = model.static(dent.load(force + step))
        except SolverError as error:
            stopped = str(error)
            break
        force, step = force + step, _LONGER * step
        forces.append(force)
        found.append(list(model.largest_deflection(state).values()))
    return DentCurve(force=np.array(forces), deflection=np.array(found), stopped=stopped)


def error(reference: DentCurve, waves: DentCurve) -> FloatArray:
    """Return the largest error of any layer, with its sign, at each force [1], shape (n,)."""
    each = waves.deflection / reference.deflection - 1
    result: FloatArray = np.take_along_axis(each, np.abs(each).argmax(axis=1)[:, None], axis=1)[:, 0]
    return result


def leaves(force: FloatArray, error: FloatArray, bound: float) -> float:
    """Return the force at which an error first leaves a bound, by straight lines [N]; infinite where it never does."""
    size = np.abs(error)
    beyond = np.flatnonzero(size > bound)
    if not len(beyond):
        return inf
    i = int(beyond[0])
    before = (float(force[i - 1]), float(size[i - 1])) if i else (0.0, 0.0)
    slope = (float(force[i]) - before[0]) / (float(size[i]) - before[1])
    return before[0] + slope * (bound - before[1])


def wave_curve(dent: Dent, model: Any, force: FloatArray) -> DentCurve:
    """Press a model with these forces [N]."""
    points = search_points(dent.size, dent.load(1.0))
    depths = [
        deflections(model, model.static(dent.load(float(size))), points, model.layer_names).max(axis=1)
        for size in force
    ]
    return DentCurve(force=force, deflection=np.array(depths))


def linear_waves(dent: Dent) -> dict[str, WaveMembrane | WaveSolid]:
    """Return the linear models of a dent by name; of clamped sides the membrane alone."""
    tissue = dent.tissue.linearised
    radius = dent.diameter / 2
    radii = RADII if RADII[0] <= radius <= RADII[-1] else (0.75 * radius, radius, 1.5 * radius)
    made: dict[str, WaveMembrane | WaveSolid] = {
        "wave-membrane": WaveMembrane.fitted(
            tissue, size=dent.size, support=dent.support, modes=_MEMBRANE_MODES, radii=radii, massless=True
        )
    }
    if not dent.support.sides_clamped:
        made["wave-solid"] = WaveSolid(
            tissue,
            size=dent.size,
            support=dent.support,
            modes=_SOLID_MODES,
            dynamic_modes=_SOLID_MOVING,
            massless=True,
        )
    return made
