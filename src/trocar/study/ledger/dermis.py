"""Table 1: the dermis's geometry, mass, prestress and tension."""

from __future__ import annotations

from math import hypot

from trocar.study.ledger import paper
from trocar.study.ledger.entry import Entry, agrees, recomputed_entry
from trocar.units import MEGAPASCAL, MILLIMETRE

SKIN_DENSITY = 1100.0  # [kg/m3]; F. A. Duck, Physical Properties of Tissue (1990): skin 1093-1190
CUBIC_MILLIMETRES = 1e9  # in a cubic metre
GRAM = 1e-3  # [kg]


def prestress_norm() -> float:
    """Return the vector norm of the two printed prestresses [MPa], as Table 1 takes it."""
    return hypot(float(paper.PRESTRESS_ALONG_MPA), float(paper.PRESTRESS_ACROSS_MPA))


def tension_as_printed() -> float:
    """Return prestress [MPa] times side [m], the plain number Table 1 calls N/m [MPa m]."""
    return prestress_norm() * float(paper.SIDE_M)


def dermis_entries() -> tuple[Entry, ...]:
    """Return the entries of Table 1."""
    side, thickness = float(paper.SIDE_MM), float(paper.THICKNESS_MM)
    area, volume = side * side, side * side * thickness
    weight = float(paper.AREA_DENSITY_G_MM2) * area
    density = weight / volume
    density_si = density * CUBIC_MILLIMETRES * GRAM
    plain = tension_as_printed()
    tension = plain * MEGAPASCAL
    true_tension = prestress_norm() * MEGAPASCAL * thickness * MILLIMETRE
    digits = "agree" if agrees(paper.TENSION_N_M, plain) else "do not agree"
    return (
        recomputed_entry("area", paper.AREA_MM2, area, "mm2", "60 mm x 60 mm."),
        recomputed_entry("volume", paper.VOLUME_MM3, volume, "mm3", "Area times 1 mm."),
        recomputed_entry(
            "weight",
            paper.WEIGHT_G,
            weight,
            "g",
            "The arithmetic holds. The source cited for 1.8e-8 g/mm2 is a study of vitamin D; a mass is "
            "called a weight.",
        ),
        recomputed_entry(
            "density_g_mm3",
            paper.DENSITY_G_MM3,
            density,
            "g/mm3",
            "Weight over volume; equal to g/mm2 at 1 mm.",
        ),
        recomputed_entry(
            "density",
            paper.DENSITY_G_M3,
            density * CUBIC_MILLIMETRES,
            "g/m3",
            f"The conversion holds; {density_si:.3g} kg/m3 is lighter than air and "
            f"{SKIN_DENSITY / density_si:.2g} times too light for skin.",
        ),
        recomputed_entry(
            "density_of_skin",
            paper.DENSITY_G_M3,
            SKIN_DENSITY / GRAM,
            "g/m3",
            "Literature instead of the paper's source: skin is 1093 to 1190 kg/m3 (Duck 1990).",
        ),
        recomputed_entry(
            "prestress",
            paper.PRESTRESS_MPA,
            prestress_norm(),
            "MPa",
            "The arithmetic holds, but two principal stresses at right angles are not a vector: a membrane "
            "keeps both, as tensions along x and y.",
        ),
        recomputed_entry(
            "tension",
            paper.TENSION_N_M,
            tension,
            "N/m",
            f"The digits {digits} ({plain:.4g}) in MPa m, which are 1e6 N/m; and tension is stress times "
            f"thickness, not side: {true_tension:.3g} N/m at 1 mm.",
        ),
        recomputed_entry(
            "tension_number",
            paper.TENSION_N_M,
            plain,
            "MPa m",
            "The same product with the unit it really has: prestress times side as plain numbers.",
        ),
    )
