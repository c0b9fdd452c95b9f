"""Limbs: foretold against measured force, and how far each way of foretelling is off."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from trocar.study.measured.indented import PUBLISHED, LimbResults
from trocar.study.report.figures.style import BLUE, GREY, ORANGE, VERMILION, sheet, styled


@styled
def limbs_figure(results: LimbResults) -> Figure:
    """Draw every judged trial, and the medians of all ways."""
    figure = sheet(3.2)
    left, right = figure.subplots(1, 2, width_ratios=(1, 1.15))
    judged = results.judged
    measured, foretold = results.limbs.force[judged], results.linear.force[judged]
    ends = np.array([0.8 * min(measured.min(), foretold.min()), 1.25 * max(measured.max(), foretold.max())])
    left.fill_between(ends, ends / 1.25, ends * 1.25, color=GREY, alpha=0.15, linewidth=0)
    left.plot(ends, ends, color=GREY, linewidth=0.8)
    left.plot(measured, foretold, "o", color=BLUE, markersize=2.6, alpha=0.55, markeredgewidth=0)
    left.set_xscale("log")
    left.set_yscale("log")
    left.set_xlim(*ends)
    left.set_ylim(*ends)
    left.set_aspect("equal")
    ticks = [tick for tick in (2, 5, 10, 20, 50) if ends[0] < tick < ends[1]]
    for axis in (left.xaxis, left.yaxis):
        axis.set_ticks(ticks, labels=[str(tick) for tick in ticks])
        axis.set_ticks([], minor=True)
    left.set_xlabel("measured force / N")
    left.set_ylabel("foretold, linear layers / N")
    left.set_title("people it has not seen")
    ways = (results.linear, results.exponential, *results.baselines)
    names = [way.name.replace(", each", ",\neach").replace(" that knows", "\nthat knows") for way in ways]
    places = np.arange(len(ways))[::-1]
    colours = [BLUE if "layers" in way.name else ORANGE for way in ways]
    right.barh(places, [100 * way.median for way in ways], color=colours, height=0.6)
    for place, way in zip(places, ways, strict=True):
        right.text(100 * way.median + 0.4, place, f"{100 * way.median:.1f}", va="center", fontsize=8)
    for share, line in ((PUBLISHED, (0, (4, 2))), (0.5 * PUBLISHED, (0, (1.5, 1.5)))):
        right.axvline(100 * share, color=VERMILION, linewidth=1.1, linestyle=line)
    right.set_yticks(places, labels=names, fontsize=7.5)
    right.set_xlabel("median error of the force / %")
    right.set_title("layers (blue), no mechanics (orange)")
    right.grid(visible=False, axis="y")
    return figure


def limbs_alt(results: LimbResults) -> str:
    """Return what the figure shows, in words."""
    best = min(results.baselines, key=lambda way: way.median)
    return (
        f"Foretold against measured force for {int(results.judged.sum())} trials: a wide cloud about the diagonal. "
        f"Median error {100 * results.linear.median:.0f} % for linear layers; the best of all, {best.name}, has "
        f"{100 * best.median:.0f} %. Lines mark the published {100 * PUBLISHED:.1f} % and half of it."
    )
