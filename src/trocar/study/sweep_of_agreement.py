"""How far the wave models agree with finite elements, over tools, places, thicknesses and the literature's moduli."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product

import numpy as np

from trocar.model import FloatArray, Press, Support
from trocar.reference.fea import FEASolid
from trocar.study.deflection import deflections, search_points
from trocar.study.models import AnyModel
from trocar.tissues import Layer, Tissue
from trocar.units import KILOPASCAL, MILLIMETRE
from trocar.waves.membrane import WaveMembrane
from trocar.waves.solid import WaveSolid

SIZE = (60 * MILLIMETRE, 60 * MILLIMETRE)
DIAMETERS = (5 * MILLIMETRE, 6 * MILLIMETRE, 8 * MILLIMETRE)
# The nine places (15, 30, 45 mm)^2 are three and their mirror images: the middle, a side's and a corner's.
PLACES = ((0.5, 0.5), (0.25, 0.5), (0.25, 0.25))
FAT = (5 * MILLIMETRE, 10 * MILLIMETRE, 20 * MILLIMETRE)
# [Pa] published values at small strain: epidermis 0.5 to 4 MPa, dermis 35 kPa to 1 MPa, fat 2 to 20 kPa.
EPIDERMIS = (500 * KILOPASCAL, 4000 * KILOPASCAL)
DERMIS = (35 * KILOPASCAL, 200 * KILOPASCAL, 1000 * KILOPASCAL)
SOFT = (2 * KILOPASCAL, 20 * KILOPASCAL)
_FORCE = 1.0  # [N]; everything is linear


@dataclass(frozen=True, kw_only=True)
class Agreement:
    """One press through both wave models and finite elements.

    Attributes:
        epidermis, dermis, fat: Young's moduli [Pa].
        fat_thickness: [m].
        support: of the block.
        place: of the tool, in shares of the sides.
        diameter: of the tool [m].
        reference: largest deflection of each layer by finite elements [m], top first.
        solid: relative difference of `WaveSolid` from it, likewise [1].
        membrane: relative difference of the fitted `WaveMembrane` [1].
    """

    epidermis: float
    dermis: float
    fat: float
    fat_thickness: float
    support: Support
    place: tuple[float, float]
    diameter: float
    reference: FloatArray
    solid: FloatArray
    membrane: FloatArray


def skin_like(epidermis: float, dermis: float, fat: float, fat_thickness: float) -> Tissue:
    """Return three layers of 0.1, 1 and `fat_thickness` [m] with these moduli [Pa] and Poisson's ratio 0.48."""
    moduli = {"epidermis": epidermis, "dermis": dermis, "fat": fat}
    thicknesses = (0.1 * MILLIMETRE, 1.0 * MILLIMETRE, fat_thickness)
    return Tissue(
        layers=tuple(
            Layer(name=name, thickness=h, young_modulus=modulus, poisson_ratio=0.48, density=1100.0)
            for (name, modulus), h in zip(moduli.items(), thicknesses, strict=True)
        )
    )


def agreements(
    support: Support,
    *,
    places: tuple[tuple[float, float], ...] = PLACES,
    diameters: tuple[float, ...] = DIAMETERS,
    fats: tuple[float, ...] = FAT,
    dermises: tuple[float, ...] = DERMIS,
) -> Iterator[Agreement]:
    """Run the sweep, one press after the other.

    Args:
        support: of the block.
        places: of the tool, in shares of the sides.
        diameters: of the tool [m].
        fats: thicknesses of the fat [m].
        dermises: Young's moduli of the dermis [Pa].
    """
    for thickness, epidermis, dermis, fat in product(fats, EPIDERMIS, dermises, SOFT):
        tissue = skin_like(epidermis, dermis, fat, thickness)
        solid = WaveSolid(tissue, size=SIZE, support=support)
        membrane = WaveMembrane.fitted(tissue, size=SIZE, support=support, modes=(96, 96))
        for place, diameter in product(places, diameters):
            press = Press(x=place[0] * SIZE[0], y=place[1] * SIZE[1], radius=diameter / 2, force=_FORCE)
            reference = FEASolid(tissue, size=SIZE, support=support, around=(press,))
            one, two, three = (largest(model, press) for model in (reference, solid, membrane))
            yield Agreement(
                epidermis=epidermis,
                dermis=dermis,
                fat=fat,
                fat_thickness=thickness,
                support=support,
                place=place,
                diameter=diameter,
                reference=one,
                solid=two / one - 1,
                membrane=three / one - 1,
            )


def largest(model: AnyModel, press: Press) -> FloatArray:
    """Return the largest deflection of each layer under one press [m], top first."""
    points = search_points(model.size, (press,))
    depths: FloatArray = deflections(model, model.static((press,)), points, model.layer_names).max(axis=1)
    return np.array(depths)
