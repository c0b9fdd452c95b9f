"""Normal distributions fitted to the samples of each layer, as the paper's figure 7, beside the samples themselves."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from trocar.study.compare import Comparison
from trocar.study.report.figures.style import GREY, MODEL_LINES, label, sheet, styled, three
from trocar.study.statistics.published import normal_study
from trocar.units import MILLIMETRE


@styled
def normal_figure(comparison: Comparison) -> Figure:
    """Draw for each layer the fitted normal densities, as published, and a histogram of the reference's samples.

    The samples rise and fall with the load, so they spread evenly between 0 and the peak: the histogram shows how
    little a normal distribution has to do with them.

    Args:
        comparison: of the reference ("fea") and other models.
    """
    layers = comparison.case.tissue.layer_names
    figure = sheet(2.9)
    axes = figure.subplots(1, len(layers), sharey=True, squeeze=False)[0]
    for panel, layer in zip(axes, layers, strict=True):
        truth = comparison["fea"].deflection[layer] / MILLIMETRE
        panel.hist(
            truth,
            bins=8,
            density=True,
            facecolor="#eceef0",
            edgecolor=GREY,
            linewidth=0.5,
            label="samples (finite elements)",
        )
        for history in sorted(comparison.histories, key=lambda history: history.model != "fea"):
            fitted = normal_study(history.deflection[layer] / MILLIMETRE)
            depth = np.linspace(fitted.mean - 3 * fitted.sd, fitted.mean + 3 * fitted.sd, 200)
            panel.plot(depth, fitted.density(depth), label=label(history.model), **MODEL_LINES[history.model])
        panel.set_title(layer)
        panel.set_xlabel("largest deflection / mm")
    axes[0].set_ylabel("density / (1/mm)")
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=len(labels))
    return figure


def normal_alt(comparison: Comparison) -> str:
    """Return what the figure shows, in words."""
    layer = comparison.case.tissue.layer_names[0]
    fitted = normal_study(comparison["fea"].deflection[layer] / MILLIMETRE)
    return (
        "For each layer, bell curves fitted to the samples of every model lie on one another "
        f"({layer} under finite elements: mean {three(fitted.mean)} mm, standard deviation {three(fitted.sd)} mm). "
        "The histogram of the samples is flat, not bell-shaped, and the bells reach below zero where no sample can be."
    )
