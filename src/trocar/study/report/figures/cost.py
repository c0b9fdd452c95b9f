"""Processor time of every model for the same case, set-up and the rest apart."""

from __future__ import annotations

from collections.abc import Mapping

from matplotlib.figure import Figure

from trocar.study.compare import Comparison
from trocar.study.report.figures.style import MODEL_MARKS, label, sheet, styled, three

LEAST = 1e-3  # [s] the left end of the axis: process clocks tell no shorter times apart


@styled
def cost_figure(cases: Mapping[str, Comparison]) -> Figure:
    """Draw the processor time of each case through each model, on a logarithmic axis.

    Args:
        cases: by the name they are shown under.
    """
    figure = sheet(0.8 + 0.28 * sum(len(case.histories) for case in cases.values()))
    axes = figure.subplots(len(cases), 1, sharex=True, squeeze=False)[:, 0]
    for panel, (name, case) in zip(axes, cases.items(), strict=True):
        for place, history in enumerate(case.histories):
            colour = MODEL_MARKS[history.model][1]
            whole = max(history.cpu_seconds, LEAST)
            setup = min(max(history.setup_seconds, LEAST), whole)
            panel.barh(place, setup, height=0.62, color=colour, hatch="////", edgecolor="white", linewidth=0)
            panel.barh(place, whole - setup, left=setup, height=0.62, color=colour, linewidth=0)
            panel.annotate(
                f"{three(history.cpu_seconds)} s",
                (whole, place),
                (4, 0),
                textcoords="offset points",
                va="center",
                fontsize=8,
            )
        panel.set_yticks(range(len(case.histories)), [label(history.model) for history in case.histories])
        panel.invert_yaxis()
        panel.set_xscale("log")
        panel.grid(axis="y", visible=False)
        panel.set_title(name)
    axes[0].set_xlim(LEAST, 2.2 * axes[0].get_xlim()[1])
    axes[-1].set_xlabel("processor time / s (hatched: set-up; logarithmic)")
    return figure


def cost_alt(cases: Mapping[str, Comparison]) -> str:
    """Return what the figure shows, in words."""
    parts = (
        f"{name}: "
        + ", ".join(f"{label(history.model)} {three(history.cpu_seconds)} s" for history in case.histories)
        for name, case in cases.items()
    )
    return "Processor time. " + "; ".join(parts) + "."
