"""Rubber pulled two ways: measured stress and what Ogden's law of one way makes of it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from trocar.study.measured.homogeneous import biaxial
from trocar.study.measured.rubber import Rubber
from trocar.study.measured.stretched import FittedRubber
from trocar.study.report.figures.style import LAYER_COLOURS, sheet, styled
from trocar.units import KILOPASCAL

_SHOWN = (1.2, 1.6, 2.2, 2.8, 3.7)


@styled
def rubber_figure(rubber: Rubber, law: FittedRubber) -> Figure:
    """Draw both stresses against the second stretch, one line for each first stretch."""
    figure = sheet(2.9)
    axes = figure.subplots(1, 2)
    for first, colour in zip(_SHOWN, LAYER_COLOURS, strict=False):
        rows = np.isclose(rubber.stretches[:, 0], first)
        if not rows.any():
            continue
        second = rubber.stretches[rows, 1]
        fine = np.linspace(second.min(), second.max(), 80)
        foretold = biaxial(
            law.fitted.law, law.fitted.shear_modulus, np.column_stack([np.full(len(fine), first), fine])
        )
        for axis, place in enumerate(axes):
            place.plot(second, rubber.stresses[rows, axis] / KILOPASCAL, "o", color=colour, markersize=3.5)
            place.plot(
                fine, foretold[:, axis] / KILOPASCAL, color=colour, linewidth=1.2, label=f"λ₁ = {first:g}"
            )
    for place, name in zip(axes, ("first", "second"), strict=True):
        place.set_xlabel("stretch along the second axis")
        place.set_title(f"stress along the {name} axis / kPa")
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=len(labels))
    return figure


def rubber_alt(laws: Sequence[FittedRubber], law: FittedRubber) -> str:
    """Return what the figure shows, in words."""
    others = ", ".join(f"{one.name} {100 * one.biaxial:.0f} %" for one in laws if one is not law)
    return (
        f"Stresses of rubber pulled two ways, points measured, lines {law.name}: error {100 * law.biaxial:.1f} %. "
        f"Other laws: {others}."
    )
