"""Small strain has an end: whether a linear result lies where linear elasticity can be believed.

In a linear model twice the force is always twice the deflection. In a neo-Hookean block, which has the same
moduli at small strain and follows large deformation, it is not. The difference comes from four things, and
each has a measure that any linear model can give from the displacement of its faces:

* a layer is squeezed: the largest nominal strain ``|u_z(upper) - u_z(lower)| / thickness`` through any layer.
  The law leaves its tangent to first order in it;
* the block changes shape: the largest deflection over the thickness of all layers;
* the surface turns: the steepest slope ``s = |grad u_z|``. Linear theory leaves out s^2 / 2 against 1;
* layers are stretched as a drum's skin is. With s the slope of its upper face, and if it cannot draw in
  from around, a layer of thickness h stores (Landau and Lifshitz 1986, Theory of Elasticity, sec. 14)

      U4 = integral of E h / (2 (1 - nu^2)) (s^2 / 2)^2 dA,

  which linear theory leaves out. For one amplitude c of a shape, k c^2/2 + q c^4/4 - F c is least where
  k c + q c^3 = F, so to first order the deflection falls by the share q c^2 / k = 2 U4 / U2, U2 = k c^2/2
  being the energy of linear theory, half of force times deflection. That share is the measure.

The thresholds are calibrated: `bench/linear_range.py` compares linear and neo-Hookean blocks in CalculiX over
presets and literature moduli and finds the force at which they part by 3 %. They hold for slow, dead, flat
loads; they say nothing about the truth of the moduli or of the neo-Hookean law.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import cos, inf, isfinite, pi, sin, sqrt

import numpy as np

from trocar.errors import InputError
from trocar.model import FloatArray, Load, Press, S, Support, TissueModel
from trocar.tissues.tissue import Tissue
from trocar.waves.mesh.skin import block_of
from trocar.waves.mesh.solid_mesh import SolidMesh
from trocar.waves.solid import WaveSolid

AGREEMENT = 0.03
"""How closely linear and neo-Hookean deflection agree inside the range [1]."""

# Each threshold lies below what any of 53 blocks showed at its 3 % force that no other threshold had called
# outside by then. The table is in docs/explanation/linear-range.md.
LARGEST_STRAIN = 0.05
"""Of the nominal strain [1]; the stomach wall parts at 0.060, with next to no stretching."""

LARGEST_DEFLECTION_SHARE = 0.05
"""Of the deflection share [1]; it decides only on a free base, where the silicone pad parts at 0.055."""

STEEPEST_SLOPE = 0.24
"""Of the slope s [1]: s^2 / 2 is then 3 %. An argument, no calibration: in none of the blocks it decides."""

LARGEST_STRETCHING = 0.03
"""Of the stretching [1]; the silicone pad parts at 0.039, a stiff dermis on a free base at 0.040."""

_NEAR = 1 / 8  # spacing of the samples under a tool, in radii: the slope at the rim is then within 5 %
_GROWTH = 0.15  # by how much the spacing grows per distance from the tool [m/m]


@dataclass(frozen=True)
class LinearRange:
    """Say how far a result is from the end of the linear range.

    Attributes:
        strain: largest nominal compression through any layer [1].
        deflection_share: largest deflection over the thickness of all layers [1].
        slope: steepest slope of any layer's upper face [1].
        stretching: by how much membrane stretching would lower the deflection, an upper estimate [1].
        inside: whether all four lie within their thresholds.
        limiting: the measure closest to its threshold, or furthest beyond it: "strain", "deflection_share",
            "slope" or "stretching".
        force_limit: the largest press's force at which the limiting measure meets its threshold [N], all presses
            growing together.
    """

    strain: float
    deflection_share: float
    slope: float
    stretching: float
    inside: bool
    limiting: str
    force_limit: float


Ranges = Mapping[str, LinearRange]
"""Verdicts by case: "small", "paper", "tilted", "pair", "tap"."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Samples:
    """What a linear model says of the faces under a constant load.

    Args:
        x, y: places [m], ascending, shapes (n,) and (m,), at least 3 each; they span the block.
        vertical: u_z of the upper face of every layer, top first [m], shape (layers, n, m).
        base_held: whether the lower face of the lowest layer cannot move. If it can, no model tells how much, and
            the compression of the lowest layer is left out; the deflection share stands in for it.
        work: the energy linear theory stores, half of force times deflection added over the presses [J],
            above 0.
        force: of the largest press [N].
    """

    x: FloatArray
    y: FloatArray
    vertical: FloatArray
    base_held: bool
    work: float
    force: float


def linear_range(model: TissueModel[S], tissue: Tissue, load: Load, state: S | None = None) -> LinearRange:
    """Judge a linear model's answer to a load.

    Args:
        model: linear.
        tissue: its layers.
        load: presses; at least one with a force other than 0.
        state: of the model, where it is not the equilibrium under the load, such as the moment of largest deflection
            of a moving block. The measures are then this state's; the force limit stays that of a slow load.

    Raises:
        InputError: the load is empty, or no press has a force.
    """
    still = judged(tissue, sampled(model, load))
    if state is None:
        return still
    samples = sampled(model, load, state)
    moving = _measures(tissue, samples)
    # A moving block's energy is not its load's work: stretching grows as the square of the deflection.
    moving["stretching"] = still.stretching * (moving["deflection_share"] / still.deflection_share) ** 2
    return _verdict(moving, still.force_limit)


def range_on_mesh(mesh: SolidMesh, surface: str, load: Load) -> LinearRange:
    """Judge a flat block of the surface's material as thick as the mesh in the mesh's place, under a slow load.

    Args:
        mesh: of any shape.
        surface: that is pressed.
        load: presses over the mesh's rectangle; at least one with a force other than 0.
    """
    block = block_of(mesh, surface, surface)
    return linear_range(WaveSolid(block, size=mesh.size, support=Support.BASE), block, load)


def judged(tissue: Tissue, samples: Samples) -> LinearRange:
    """Judge samples of an equilibrium.

    Args:
        tissue: the layers.
        samples: of the equilibrium.

    Raises:
        InputError: the work or the force is not above 0.
    """
    for key in ("work", "force"):
        value = getattr(samples, key)
        if not (isfinite(value) and value > 0):
            raise InputError(f"linear range: {key}", "a finite number above 0", value)
    measures = _measures(tissue, samples)
    return _verdict(measures, samples.force / max(_shares(measures).values()))


def sampled(model: TissueModel[S], load: Load, state: S | None = None) -> Samples:
    """Sample the faces of a model's block, finely at the tools.

    Args:
        model: any.
        load: presses; at least one with a force other than 0.
        state: of the model; None: the equilibrium under the load.

    Raises:
        InputError: the load is empty, or no press has a force.
    """
    force = max((abs(press.force) for press in load), default=0.0)
    if force == 0.0:
        raise InputError("linear range: load", "a press with a force other than 0", load)
    state = model.static(load) if state is None else state
    x, y = (
        _graded(side, [(getattr(press, axis), press.radius) for press in load])
        for axis, side in zip("xy", model.size, strict=True)
    )
    points = np.stack([*np.meshgrid(x, y, indexing="ij"), np.zeros((len(x), len(y)))], axis=-1).reshape(-1, 3)
    vertical = np.stack(
        [model.displacement(state, points, name)[:, 2].reshape(len(x), len(y)) for name in model.layer_names]
    )
    work = 0.0
    for press in load:
        moved = model.displacement(state, _footprint(press)).mean(axis=0)
        work += 0.5 * float(np.dot(press.force_vector, moved))
    return Samples(x=x, y=y, vertical=vertical, base_held=model.support.base_held, work=work, force=force)


def _measures(tissue: Tissue, samples: Samples) -> dict[str, float]:
    vertical = samples.vertical
    lower = np.concatenate([vertical[1:], np.zeros_like(vertical[:1])])
    thickness = np.array([layer.thickness for layer in tissue.layers])
    strains = np.abs(vertical - lower).max(axis=(1, 2)) / thickness
    if not samples.base_held:
        strains = strains[:-1]
    along_x, along_y = np.gradient(vertical, samples.x, samples.y, axis=(1, 2))
    squares = along_x**2 + along_y**2
    membrane = np.array(
        [layer.young_modulus * layer.thickness / (1 - layer.poisson_ratio**2) for layer in tissue.layers]
    )
    area = np.outer(_cells(samples.x), _cells(samples.y))
    stretching = float(np.einsum("l,lij,ij->", membrane / 8, squares**2, area))
    return {
        "strain": float(strains.max(initial=0.0)),
        "deflection_share": float(np.abs(vertical).max()) / tissue.thickness,
        "slope": sqrt(float(squares.max())),
        "stretching": 2 * stretching / samples.work if samples.work > 0 else inf,
    }


def _shares(measures: dict[str, float]) -> dict[str, float]:
    """Return each measure over its threshold, as a force: stretching grows as the square of the force."""
    return {
        "strain": measures["strain"] / LARGEST_STRAIN,
        "deflection_share": measures["deflection_share"] / LARGEST_DEFLECTION_SHARE,
        "slope": measures["slope"] / STEEPEST_SLOPE,
        "stretching": sqrt(measures["stretching"] / LARGEST_STRETCHING),
    }


def _verdict(measures: dict[str, float], force_limit: float) -> LinearRange:
    shares = _shares(measures)
    limiting = max(shares, key=lambda measure: shares[measure])
    return LinearRange(**measures, inside=shares[limiting] <= 1, limiting=limiting, force_limit=force_limit)


def _graded(side: float, tools: list[tuple[float, float]]) -> FloatArray:
    """Return places from 0 to a side [m], fine within 1.5 radii of the tools."""
    places = [0.0]
    while places[-1] < side:
        steps = (
            _NEAR * radius + _GROWTH * max(abs(places[-1] - centre) - 1.5 * radius, 0.0)
            for centre, radius in tools
        )
        places.append(places[-1] + min(steps))
    return np.array(places) * (side / places[-1])


def _cells(places: FloatArray) -> FloatArray:
    """Return the weights of the trapezoidal rule."""
    steps = np.diff(places)
    weights: FloatArray = 0.5 * (np.append(steps, 0.0) + np.append(0.0, steps))
    return weights


def _footprint(press: Press) -> FloatArray:
    """Return 12 points whose mean is that over the footprint, exact for polynomials of degree 3."""
    along, across = press.semi_axes
    c, s = cos(press.azimuth), sin(press.azimuth)
    points = []
    for square in (0.5 - 0.5 / sqrt(3), 0.5 + 0.5 / sqrt(3)):
        for turn in range(6):
            p = along * sqrt(square) * cos(pi * turn / 3)
            q = across * sqrt(square) * sin(pi * turn / 3)
            points.append((press.x + c * p - s * q, press.y + s * p + c * q, 0.0))
    return np.array(points)
