"""Which layers a dent stretches, and how stiff they are in their plane.

A layer much thinner than a dent is wide stretches as a sheet does: it bears membrane forces

    N_x = along_x e_x + across e_y,   N_y = across e_x + along_y e_y,   N_xy = shear g_xy

with, for an isotropic layer in plane stress, along = E h / (1 - nu^2), across = nu along, shear = G h (S. Timoshenko
and S. Woinowsky-Krieger 1959, Theory of Plates and Shells, section 96); fibres add what they bear at small stretch,
all of them taut. Layers bonded to each other stretch as one, so their moduli add up. Where the base is held the lowest
layer does not stretch: it is the bed the sheet lies on, which resists when the sheet is drawn sideways.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import cos, inf, sin

import numpy as np

from trocar.errors import InputError
from trocar.model import Support
from trocar.tissues.law import Fibre
from trocar.tissues.layer import Layer
from trocar.tissues.tissue import Tissue

FITTED_SHARE = 0.75
"""Of the derived moduli, what a sheet bears in a dent as deep as a third of the block [1]: the stretched layers' own
law bears less than small strain says, and so does the bed. Fitted to hyperelastic finite elements under tools of 5, 8
and 12 mm, sheets 11 and 55 times stiffer than their bed (`bench/stiffening.py fit`)."""
LEAST_CONTRAST = 10.0  # of a sheet's Young's modulus over its bed's, in the fit and its checks
MOST_CONTRAST = 110.0  # of fitted membranes: a liver's capsule, 1800 times stiffer than liver, leaves 13 %
THICKEST = 0.25  # of the block: the thickest sheet they had
DEEPEST = 1 / 3  # of the block's thickness: how deep they were pressed
TOOLS = (5e-3, 12e-3)  # diameters under which they were fitted [m]


@dataclass(frozen=True, kw_only=True)
class MembraneModuli:
    """How a sheet resists being stretched in its plane.

    Args:
        along_x, along_y: force per width and strain, along each axis [N/m].
        across: force per width along one axis and strain along the other [N/m].
        shear: force per width and shear angle [N/m].

    Raises:
        InputError: a value is not finite, or some stretch would bear no positive energy.
    """

    along_x: float
    along_y: float
    across: float
    shear: float

    def __post_init__(self) -> None:
        for key in ("along_x", "along_y", "shear"):
            value = getattr(self, key)
            if not (np.isfinite(value) and value > 0):
                raise InputError(f"membrane moduli: {key}", "a finite number above 0 [N/m]", value)
        if not self.across**2 < self.along_x * self.along_y:
            raise InputError("membrane moduli: across", "less than the root of along_x along_y", self.across)


def moduli_of(layer: Layer) -> MembraneModuli:
    """Return the moduli of one layer, taken as a sheet."""
    along = layer.young_modulus * layer.thickness / (1 - layer.poisson_ratio**2)
    bare = MembraneModuli(
        along_x=along,
        along_y=along,
        across=layer.poisson_ratio * along,
        shear=layer.shear_modulus * layer.thickness,
    )
    if not isinstance(layer.law, Fibre) or layer.law.k1 == 0:
        return bare
    # Of W, per family: k1/2 E^2 with E = 2 (1 - 3 dispersion) times the strain along the fibre; two mirror images.
    law = layer.law
    stiffness = 8 * law.k1 * (1 - 3 * law.dispersion) ** 2 * layer.thickness
    x2, y2 = cos(law.angle) ** 2, sin(law.angle) ** 2
    return MembraneModuli(
        along_x=along + stiffness * x2**2,
        along_y=along + stiffness * y2**2,
        across=bare.across + stiffness * x2 * y2,
        shear=bare.shear + stiffness * x2 * y2,
    )


def bonded(layers: Sequence[Layer], share: float = 1.0) -> MembraneModuli:
    """Return the moduli of layers that stretch as one, times a share [1]."""
    parts = [moduli_of(layer) for layer in layers]
    return MembraneModuli(
        along_x=share * sum(part.along_x for part in parts),
        along_y=share * sum(part.along_y for part in parts),
        across=share * sum(part.across for part in parts),
        shear=share * sum(part.shear for part in parts),
    )


def contrast(tissue: Tissue, support: Support) -> float:
    """Return how much stiffer a sheet is than its bed, by Young's moduli [1]; infinite without a bed, 0 without it."""
    if not support.base_held:
        return inf
    layers, bed = stretching_layers(tissue, support), tissue.layers[-1]
    if not layers:
        return 0.0
    thickness = sum(layer.thickness for layer in layers)
    mean = sum(layer.young_modulus * layer.thickness for layer in layers) / thickness
    return mean / bed.young_modulus


def stretching_layers(tissue: Tissue, support: Support) -> tuple[Layer, ...]:
    """Return the layers that stretch as one sheet: all, or all but the lowest where that is a held bed."""
    return tissue.layers[:-1] if support.base_held else tissue.layers


def bed_below(tissue: Tissue, support: Support) -> Tissue | None:
    """Return the layer that the sheet lies on; None where nothing holds it from below."""
    return Tissue(layers=tissue.layers[-1:], name=tissue.name) if support.base_held else None
