"""The map of validity: error of the wave models against hyperelastic finite elements, over force and tool diameter.

Every layer follows its own law, or the neo-Hookean one with the same moduli where it is linear: the mildest that is
right at large strain. Linear waves stand beside the ones that stiffen, so that what stiffening buys is seen too.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from trocar.model import FloatArray, Support
from trocar.reference.block import MeshSize
from trocar.study.stiffening import Dent, error, leaves, linear_waves, reference_curve, wave_curve
from trocar.tissues.tissue import Tissue
from trocar.waves.stretch.moduli import stretching_layers
from trocar.waves.stretch.stretching_waves import StretchingWaves

DIAMETERS = (5e-3, 6.5e-3, 8e-3, 10e-3, 12e-3)  # [m] those the fitted membranes are made for
BOUNDS = (0.05, 0.1)  # errors whose forces are named
STIFFENING, LINEAR = "stiffening", "linear"


@dataclass(frozen=True, kw_only=True)
class ErrorCurve:
    """One model under one tool.

    Attributes:
        error: largest of any layer, with its sign, at each force [1], shape (n,).
        leaves: the force at which it leaves each of `BOUNDS` [N]; infinite where it never does.
    """

    error: FloatArray
    leaves: tuple[float, ...]


@dataclass(frozen=True, kw_only=True)
class UnderTool:
    """Every model under one tool.

    Attributes:
        diameter: of the tool [m].
        force: [N], shape (n,).
        share: the reference's largest deflection over the thickness at each force [1], shape (n,).
        curves: by model's name and "stiffening" or "linear".
        stopped: why the reference went no further than it did; empty where it reached a third.
    """

    diameter: float
    force: FloatArray
    share: FloatArray
    curves: dict[tuple[str, str], ErrorCurve]
    stopped: str


@dataclass(frozen=True, kw_only=True)
class ValidityMap:
    """All tools on one block."""

    tissue: Tissue
    size: tuple[float, float]
    support: Support
    rows: tuple[UnderTool, ...]


def validity_map(
    tissue: Tissue,
    *,
    size: tuple[float, float] = (0.06, 0.06),
    support: Support = Support.BASE,
    diameters: Sequence[float] = DIAMETERS,
    mesh: MeshSize | None = None,
    progress: Callable[[float], None] = lambda _share: None,
) -> ValidityMap:
    """Press a block in the middle under every tool until a third of its thickness.

    Args:
        tissue: the layers; what they remember is left out.
        size: sides [m].
        support: how it is held.
        diameters: of the tools [m].
        mesh: of the reference; its default where None.
        progress: told the share done, 0 to 1.
    """
    tissue = tissue.long_term
    rows = []
    for place, diameter in enumerate(diameters):
        dent = Dent(
            name=f"{1e3 * diameter:g} mm", tissue=tissue, size=size, support=support, diameter=diameter
        )
        reference = reference_curve(dent, mesh=mesh)
        progress((place + 0.7) / len(diameters))
        curves: dict[tuple[str, str], ErrorCurve] = {}
        if len(reference.force):
            for name, linear in linear_waves(dent).items():
                made: dict[str, Any] = {LINEAR: linear}
                if stretching_layers(tissue, support):
                    made[STIFFENING] = StretchingWaves.of(linear, tissue)
                for kind, model in made.items():
                    off = error(reference, wave_curve(dent, model, reference.force))
                    limits = tuple(leaves(reference.force, off, bound) for bound in BOUNDS)
                    curves[name, kind] = ErrorCurve(error=off, leaves=limits)
        share = reference.deflection.max(axis=1, initial=0.0) / tissue.thickness
        rows.append(
            UnderTool(
                diameter=diameter,
                force=reference.force,
                share=share,
                curves=curves,
                stopped=reference.stopped,
            )
        )
        progress((place + 1) / len(diameters))
    return ValidityMap(tissue=tissue, size=size, support=support, rows=tuple(rows))


def as_plain(found: ValidityMap) -> list[dict[str, object]]:
    """Return the map as plain values, one entry a tool, forces that are never left as None."""
    return [
        {
            "diameter_m": row.diameter,
            "force_n": row.force.tolist(),
            "deflection_share": row.share.tolist(),
            "stopped": row.stopped,
            "models": [
                {
                    "model": model,
                    "waves": kind,
                    "error": curve.error.tolist(),
                    "leaves_n": {
                        f"{bound:g}": limit if np.isfinite(limit) else None
                        for bound, limit in zip(BOUNDS, curve.leaves, strict=True)
                    },
                }
                for (model, kind), curve in row.curves.items()
            ],
        }
        for row in found.rows
    ]
