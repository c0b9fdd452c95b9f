"""A tap: the block's largest deflection in time, where inertia and damping count."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from trocar.study.compare import Comparison
from trocar.study.report.figures.style import GREY, MODEL_LINES, label, sheet, styled, three
from trocar.units import MILLIMETRE, MILLISECOND


@styled
def tap_figure(comparison: Comparison) -> Figure:
    """Draw force, deflection of the block, and each model's difference from finite elements, against time."""
    figure = sheet(3.9)
    force, above, below = figure.subplots(3, 1, sharex=True, height_ratios=(0.6, 2, 1))
    truth = comparison["fea"]
    time = truth.time / MILLISECOND
    force.fill_between(time, truth.force, color="#eceef0", linewidth=0)
    force.plot(time, truth.force, color=GREY, linewidth=1.2)
    force.set_ylabel("force / N")
    force.set_ylim(bottom=0)
    for history in sorted(comparison.histories, key=lambda history: history.model != "fea"):
        above.plot(time, history.block / MILLIMETRE, label=label(history.model), **MODEL_LINES[history.model])
        if history.model != "fea":
            share = 100 * (history.block - truth.block) / truth.block.max()
            below.plot(time, share, **MODEL_LINES[history.model])
    below.axhline(0, color=GREY, linewidth=0.8)
    above.set_ylabel("largest deflection / mm")
    above.set_ylim(bottom=0)
    below.set_ylabel("difference /\n% of the peak")
    below.set_xlabel("time / ms")
    below.set_xlim(time[0], time[-1])
    above.legend(loc="upper left")
    figure.align_ylabels((force, above, below))
    return figure


def tap_alt(comparison: Comparison) -> str:
    """Return what the figure shows, in words."""
    truth = comparison["fea"].block
    others = ", ".join(
        f"{label(history.model)} by at most {three(100 * float(np.abs(history.block - truth).max() / truth.max()))} %"
        for history in comparison.histories
        if history.model != "fea"
    )
    return (
        f"Deflection of the block during a tap up to {comparison.case.peak_force:g} N: it follows the force late and "
        f"peaks at {three(float(truth.max()) / MILLIMETRE)} mm. Differences from finite elements, of the "
        f"peak: {others}."
    )
