"""How far two models agree: Bland and Altman's plot, and each layer's error beside the uncertainty of finding it."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure

from trocar.study.compare import Comparison
from trocar.study.protocol import Numerics
from trocar.study.report.figures.style import (
    BLACK,
    BLUE,
    GREY,
    LAYER_COLOURS,
    label,
    sheet,
    styled,
    three,
    with_uncertainty,
)
from trocar.study.statistics.agreement import limits_of_agreement
from trocar.units import MILLIMETRE

MICROMETRE = 1e-6  # [m]
MARKS = "os^Dvp"


@styled
def bland_altman_figure(comparison: Comparison) -> Figure:
    """Draw difference against mean of the reference and each judged model, with bias and limits of all layers."""
    judged = [history for history in comparison.histories if history.model != "fea"]
    truth = comparison["fea"]
    figure = sheet(2.9)
    axes = figure.subplots(1, len(judged), squeeze=False)[0]
    for panel, history in zip(axes, judged, strict=True):
        first, second = [], []
        for place, (layer, depth) in enumerate(history.deflection.items()):
            one = truth.deflection[layer]
            panel.plot(
                (one + depth) / 2 / MILLIMETRE,
                (depth - one) / MICROMETRE,
                MARKS[place % 6],
                markersize=3.2,
                color=LAYER_COLOURS[place % 6],
                markeredgewidth=0,
                label=layer,
            )
            first.append(one)
            second.append(depth)
        limits = limits_of_agreement(np.concatenate(first), np.concatenate(second))
        for value, name, style in (
            (limits.upper, "upper limit", (0, (4, 2))),
            (limits.bias, "bias", "-"),
            (limits.lower, "lower limit", (0, (4, 2))),
        ):
            panel.axhline(value / MICROMETRE, color=BLACK, linewidth=0.9, linestyle=style)
            panel.annotate(
                f"{name} {three(value / MICROMETRE)}",
                (0.0, value / MICROMETRE),
                (4, 2),
                xycoords=("axes fraction", "data"),
                textcoords="offset points",
                fontsize=7.5,
                color=GREY,
            )
        panel.margins(y=0.16)
        panel.set_title(f"{label(history.model)} and finite elements")
        panel.set_xlabel("mean of both / mm")
    axes[0].set_ylabel("model minus finite elements / µm")
    axes[-1].legend(loc="upper left", bbox_to_anchor=(1.0, 0.9), title="layer", alignment="left")
    return figure


def bland_altman_alt(comparison: Comparison) -> str:
    """Return what the figure shows, in words."""
    return (
        "Bland-Altman plots: the difference between each wave model and finite elements grows in proportion to the "
        f"deflection, in {len(comparison.case.tissue.layer_names)} straight lines, one for each layer; the points "
        "lie between the limits of agreement but are no cloud, for a linear model's error is proportional to the load."
    )


@styled
def uncertainty_figure(numerics: Mapping[str, Numerics], depths: Mapping[str, float]) -> Figure:
    """Draw each layer's comparison error with its interval of twice the validation uncertainty.

    Args:
        numerics: by layer.
        depths: largest deflection of each layer under finite elements [m], to give percentages.
    """
    figure = sheet(0.75 + 0.42 * len(numerics))
    axes = figure.subplots()
    axes.axvline(0, color=GREY, linewidth=0.8)
    for place, (layer, numbers) in enumerate(numerics.items()):
        share = 100 / depths[layer]
        low, high = (share * end for end in numbers.comparison.model_error)
        error = share * numbers.comparison.error
        axes.plot([low, high], [place, place], color=BLUE, linewidth=5, alpha=0.3, solid_capstyle="butt")
        axes.plot(error, place, "o", color=BLUE, markersize=6)
        axes.annotate(
            f"{with_uncertainty(error, (high - low) / 2)} %",
            (high, place),
            (6, 0),
            textcoords="offset points",
            va="center",
            fontsize=8.5,
        )
    axes.set_yticks(range(len(numerics)), list(numerics))
    axes.invert_yaxis()
    axes.margins(y=0.25)
    low, high = axes.get_xlim()
    axes.set_xlim(low, high + 0.28 * (high - low))
    axes.grid(axis="y", visible=False)
    axes.set_xlabel(
        "WaveSolid minus finite elements / % of the deflection; bar: twice the numerical uncertainty"
    )
    return figure


def uncertainty_alt(numerics: Mapping[str, Numerics]) -> str:
    """Return what the figure shows, in words."""
    resolved = [layer for layer, numbers in numerics.items() if numbers.comparison.resolved]
    if not resolved:
        return "For every layer the difference between the models is smaller than the uncertainty of computing it."
    return (
        f"The difference between the models stands out of its numerical uncertainty in {', '.join(resolved)}."
    )
