"""Accuracy against cost: one panel a case, one line a model, from coarse to fine."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from matplotlib.figure import Figure

from trocar.study.cost.accuracy import CASES, Point
from trocar.study.report.figures.style import GREY, MODEL_MARKS, label, sheet, styled, three

_LEAST_ERROR = 1e-4  # smaller ones are the reference's own
_ONE_ROW = 6  # models in a legend


@styled
def accuracy_figure(points: Sequence[Point], marks: Mapping[str, tuple[str, str]] = MODEL_MARKS) -> Figure:
    """Draw CPU time for a simulated second over error, both logarithmic; down and left is better.

    Args:
        points: of any models that have a mark.
        marks: marker and colour of every model, in the legend's order.
    """
    cases = [case for case in CASES if any(point.case == case for point in points)]
    figure = sheet(3.4)
    panels = figure.subplots(1, len(cases), sharey=True, squeeze=False)[0]
    for panel, case in zip(panels, cases, strict=True):
        for model, (mark, colour) in marks.items():
            line = [
                (100 * max(point.error, _LEAST_ERROR), point.second_s)
                for point in points
                if (point.case, point.model) == (case, model) and point.error is not None
            ]
            if line:
                panel.plot(*zip(*line, strict=True), color=colour, marker=mark, markersize=4.5, linewidth=1.2)
        panel.axhline(1.0, color=GREY, linewidth=0.8, linestyle=(0, (4, 3)))
        panel.set_xscale("log")
        panel.set_yscale("log")
        panel.set_title(case)
        panel.set_xlabel("error / %")
    panels[0].set_ylabel("CPU time for a simulated second / s")
    panels[0].annotate(
        "real time", (0.02, 1.0), (0, 3), xycoords=("axes fraction", "data"), textcoords="offset points",
        fontsize=7, color=GREY,
    )  # fmt: skip
    shown = [model for model in marks if any(point.model == model for point in points)]
    handles = [
        panels[0].plot([], [], color=marks[model][1], marker=marks[model][0], label=label(model))[0]
        for model in shown
    ]
    columns = len(shown) if len(shown) <= _ONE_ROW else -(-len(shown) // 2)
    figure.legend(
        handles=handles, loc="outside lower center", ncols=columns, columnspacing=1.0, handlelength=1.5
    )
    return figure


def accuracy_alt(points: Sequence[Point]) -> str:
    """Return what the figure shows, in words: the finest of each model."""
    finest = {(point.case, point.model): point for point in points if point.error is not None}
    parts = (
        f"{case}, {label(model)}: {three(100 * (point.error or 0.0))} % for {three(point.second_s)} s"
        for (case, model), point in finest.items()
    )
    return "Error and CPU time for a simulated second, each model at its finest. " + "; ".join(parts) + "."
