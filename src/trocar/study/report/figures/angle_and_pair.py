"""A tool at an angle and two tools at once: the top face of the block (the paper's figure 8)."""

from __future__ import annotations

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from trocar.model import FloatArray
from trocar.study.cases.experiment import Case
from trocar.study.report.figures.axonometry import View, colours, draw_rim, draw_surface, fit, quads
from trocar.study.report.figures.block import enlargement
from trocar.study.report.figures.style import DEPTHS, GREY, VERMILION, sheet, styled, three
from trocar.study.surface import Surface
from trocar.units import DEGREE, MILLIMETRE

Shown = tuple[Case, Surface]
ARROW = 16.0  # [mm] long
DENT = 9.0  # [mm] that the deepest dent is drawn at most


@styled
def angle_and_pair_figure(tilted: Shown, pair: Shown) -> Figure:
    """Draw both top faces with one scale of colours and one enlargement, and a section below each.

    Args:
        tilted: the case of one tool at an angle, and its faces.
        pair: the same of two tools.
    """
    both = [(case, surface, _top(case, surface)) for case, surface in (tilted, pair)]
    deepest = max(-float(top[2].min()) for _, _, top in both)
    factor = enlargement(deepest, DENT)
    scale, cmap = Normalize(0, deepest / MILLIMETRE), mpl.colormaps[DEPTHS]
    figure = sheet(3.9)
    axes = figure.subplots(2, 2, height_ratios=(1.75, 1), sharey="row")
    view = View()
    titles = (f"One tool at {tilted[0].tools[0].tilt / DEGREE:g}° from the normal", "Two tools at once")
    for (case, surface, top), above, below, title in zip(both, *axes, titles, strict=True):
        x, y = surface.x / MILLIMETRE, surface.y / MILLIMETRE
        faces = quads(x, y, factor * top[2] / MILLIMETRE)
        draw_surface(above, view, faces, colours(faces, -top[2] / MILLIMETRE, scale, cmap))
        draw_rim(above, view, x, y, factor * top[2] / MILLIMETRE)
        _draw_forces(above, view, case)
        corners = np.array([[a, b, c] for a in (x[0], x[-1]) for b in (y[0], y[-1]) for c in (0.0, ARROW)])
        fit(above, view, corners, margin=0.0)
        above.set_title(title, loc="center")
        middle = len(y) // 2
        below.fill_between(x, -top[2][:, middle] / MILLIMETRE, color="#dbe7f1", linewidth=0)
        below.plot(x, -top[2][:, middle] / MILLIMETRE, color="#0072B2", linewidth=1.5)
        below.set_xlabel("x at the block's middle / mm")
        below.set_ylim(1.1 * deepest / MILLIMETRE, 0)
        below.set_xlim(x[0], x[-1])
    axes[1, 0].set_ylabel("deflection / mm")
    bar = figure.colorbar(ScalarMappable(scale, cmap), ax=axes[0, :], shrink=0.75, aspect=18, pad=0.01)
    bar.set_label(f"deflection / mm\n(drawn {factor:g} times as large)")
    bar.outline.set_visible(False)
    return figure


def angle_and_pair_alt(tilted: Shown, pair: Shown) -> str:
    """Return what the figure shows, in words."""
    depths = [three(-float(_top(case, surface)[2].min()) / MILLIMETRE) for case, surface in (tilted, pair)]
    angle = tilted[0].tools[0].tilt / DEGREE
    return (
        f"Left, the top face under a tool leaning {angle:g} degrees along x: a dent {depths[0]} mm deep, longer along "
        f"x than across. Right, under two tools: two dents {depths[1]} mm deep."
    )


def _top(case: Case, surface: Surface) -> FloatArray:
    return surface.displacement[case.tissue.layer_names[0]]


def _draw_forces(axes: Axes, view: View, case: Case) -> None:
    """Draw an arrow along each tool's axis, its point on the rest surface."""
    for tool in case.tools:
        point = np.array([*tool.position, 0.0]) / MILLIMETRE
        along = np.array([np.cos(tool.azimuth), np.sin(tool.azimuth), 0.0]) * np.sin(tool.tilt)
        tail = point - ARROW * (along - np.array([0.0, 0.0, np.cos(tool.tilt)]))
        axes.annotate(
            "",
            view.at(*point),
            view.at(*tail),
            arrowprops={"arrowstyle": "-|>", "color": VERMILION, "linewidth": 2, "shrinkA": 0, "shrinkB": 0},
        )
        axes.annotate(
            f"{tool.peak:g} N",
            view.at(*tail),
            (4, 0),
            textcoords="offset points",
            va="center",
            fontsize=8.5,
            color=GREY,
            bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.85, "pad": 0.8},
        )
