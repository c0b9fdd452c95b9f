"""Largest deflection of every layer against time, all models, and what is left between them (the paper's figure 6)."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from trocar.model import FloatArray
from trocar.study.compare import Comparison
from trocar.study.history import History
from trocar.study.report.figures.style import GREY, MODEL_LINES, VERMILION, label, sheet, styled, three
from trocar.units import MILLIMETRE

BLOCK = "whole block"


@styled
def deflection_figure(comparison: Comparison, *, reference: str = "fea", depth_limit: bool = False) -> Figure:
    """Draw each layer's largest deflection, and below it every model's difference from the reference.

    Args:
        comparison: of the reference and at least one other model.
        reference: its name.
        depth_limit: whether to draw the block's thickness, for loads that push through it.
    """
    layers = (*comparison.case.tissue.layer_names, BLOCK)
    figure = sheet(3.9)
    axes = figure.subplots(2, len(layers), sharex=True, sharey="row", height_ratios=(2.2, 1))
    judged = [history for history in comparison.histories if history.model != reference]
    truth = comparison[reference]
    thickness = comparison.case.tissue.thickness / MILLIMETRE
    for column, layer in enumerate(layers):
        above, below = axes[:, column]
        for history in (truth, *judged):
            above.plot(
                history.time,
                _curve(history, layer) / MILLIMETRE,
                label=label(history.model),
                **MODEL_LINES[history.model],
            )
        whole = _curve(truth, layer)
        below.axhline(0, color=GREY, linewidth=0.8)
        for history in judged:
            share = 100 * (_curve(history, layer) - whole) / whole.max()
            below.plot(history.time, share, **MODEL_LINES[history.model])
        above.set_title(layer)
        below.set_xlabel("time / s")
    axes[0, 0].set_ylabel("largest deflection / mm")
    axes[0, 0].set_ylim(bottom=0)
    if depth_limit:
        axes[0, 0].set_ylim(top=1.15 * axes[0, 0].get_ylim()[1])  # room for words above the peak
        for column, above in enumerate(axes[0]):
            _draw_limit(above, thickness, column == 0)
    axes[1, 0].set_ylabel("difference /\n% of the peak")
    handles, labels = axes[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=len(labels))
    figure.align_ylabels(axes[:, 0])
    return figure


def deflection_alt(comparison: Comparison, reference: str = "fea") -> str:
    """Return what the figure shows, in words."""
    truth = comparison[reference]
    peak = three(truth.block.max() / MILLIMETRE)
    others = "; ".join(
        f"{label(history.model)} differs by at most "
        f"{three(100 * np.abs(history.block - truth.block).max() / truth.block.max())} % of it"
        for history in comparison.histories
        if history.model != reference
    )
    return (
        f"Largest deflection of each layer against time as the force rises to {comparison.case.peak_force:g} N and "
        f"falls: straight lines up to {peak} mm and back under finite elements. {others}."
    )


def _curve(history: History, layer: str) -> FloatArray:
    return history.block if layer == BLOCK else history.deflection[layer]


def _draw_limit(axes: Axes, thickness: float, named: bool) -> None:
    top = axes.get_ylim()[1]
    if top <= thickness:
        return
    axes.axhspan(thickness, top, color=VERMILION, alpha=0.08, linewidth=0)
    axes.axhline(thickness, color=VERMILION, linewidth=1.0, linestyle=(0, (2, 2)))
    if named:
        axes.text(
            0.04,
            0.97,
            f"deeper than\nthe block\n({thickness:.3g} mm)",
            transform=axes.transAxes,
            va="top",
            fontsize=7,
            color=VERMILION,
        )
