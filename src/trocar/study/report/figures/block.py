"""The block taken apart: its layers, cut through the middle, each with the shape the press gives it (figure 5)."""

from __future__ import annotations

from math import floor, log10

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from trocar.model import FloatArray
from trocar.study.cases.experiment import Case
from trocar.study.report.figures.axonometry import View, colours, draw_polygon, draw_surface, fit, quads
from trocar.study.report.figures.style import BLACK, DEPTHS, GREY, LAYER_COLOURS, sheet, styled, three
from trocar.study.surface import Surface
from trocar.tissues import Layer
from trocar.units import KILOPASCAL, MILLIMETRE

HATCHES = ("////", "....", "xx", "||", "--", "oo")  # layers differ without colour, as in the paper's figure
GAP = 7.0  # [mm] between the layers taken apart
DENT = 7.0  # [mm] that the deepest dent is drawn at most


def enlargement(largest: float, dent: float = DENT) -> float:
    """Return a round factor, 1, 2 or 5 times a power of ten, that draws a deflection [m] at most `dent` [mm] deep."""
    wished = dent * MILLIMETRE / largest
    power = 10.0 ** floor(log10(wished))
    return power * max(step for step in (1, 2, 5) if step * power <= wished * 1.001)


@styled
def block_figure(case: Case, surface: Surface) -> Figure:
    """Draw the back half of every layer, cut through the tool, its faces pushed in as far as the model says.

    Args:
        case: with one central tool.
        surface: every layer's upper face under it.
    """
    layers = case.tissue.layers
    back = surface.y >= 0.5 * case.size[1] - 1e-9
    x, y = surface.x / MILLIMETRE, surface.y[back] / MILLIMETRE
    drops = [surface.displacement[layer.name][2][:, back] for layer in layers]
    factor = enlargement(max(-float(drop.min()) for drop in drops))
    drawn = [factor * drop / MILLIMETRE for drop in drops]
    lower = [*drawn[1:], drawn[-1] * 0 if case.support.base_held else drawn[-1]]
    scale = Normalize(0, max(-float(drop.min()) for drop in drops) / MILLIMETRE)
    cmap = mpl.colormaps[DEPTHS]

    figure = sheet(4.3)
    axes = figure.subplots()
    view = View()
    heights = _heights(layers)
    for i in reversed(range(len(layers))):
        top, bottom = heights[i], heights[i] - layers[i].thickness / MILLIMETRE
        faces = quads(x, y, top + drawn[i])
        _draw_side(axes, view, x, y, top + drawn[i], bottom + lower[i], i)
        draw_surface(axes, view, faces, colours(faces, -drops[i] / MILLIMETRE, scale, cmap))
        _draw_cut(axes, view, x, y[0], (top + drawn[i][:, 0], bottom + lower[i][:, 0]), i)
        _name(axes, view, (float(x[-1]), float(y[-1]), top), layers[i])
    _draw_tool(axes, view, case, heights[0] + drawn[0].min())
    ends = np.array(
        [[a, b, c] for a in (x[0], x[-1]) for b in (y[0], y[-1]) for c in (heights[0], _floor(layers))]
    )
    fit(axes, view, ends)
    axes.set_xlim(axes.get_xlim()[0], axes.get_xlim()[1] + 19)  # [mm] for the layers' names
    bar = figure.colorbar(
        ScalarMappable(scale, cmap), ax=axes, orientation="horizontal", shrink=0.45, aspect=28, pad=0.01
    )
    bar.set_label("deflection of each layer's upper face / mm")
    bar.outline.set_visible(False)
    axes.set_title(f"Layers to scale and taken apart; displacements drawn {factor:g} times as large")
    return figure


def block_alt(case: Case, surface: Surface) -> str:
    """Return what the figure shows, in words."""
    parts = ", ".join(
        f"{layer.name} ({layer.thickness / MILLIMETRE:g} mm thick) by "
        f"{three(-float(surface.displacement[layer.name][2].min()) / MILLIMETRE)} mm"
        for layer in case.tissue.layers
    )
    return (
        f"Exploded view of the block cut through the tool. Under {case.peak_force:g} N the upper faces sink at the "
        f"middle, the {parts}."
    )


def _heights(layers: tuple[Layer, ...]) -> list[float]:
    """Return where each upper face is drawn [mm], the top one at 0."""
    heights, depth = [], 0.0
    for layer in layers:
        heights.append(depth)
        depth -= layer.thickness / MILLIMETRE + GAP
    return heights


def _floor(layers: tuple[Layer, ...]) -> float:
    return _heights(layers)[-1] - layers[-1].thickness / MILLIMETRE


def _draw_side(
    axes: Axes, view: View, x: FloatArray, y: FloatArray, top: FloatArray, bottom: FloatArray, place: int
) -> None:
    """Draw the side that is seen besides the cut."""
    edge, at = (-1, x[-1]) if np.sin(view.turn) < 0 else (0, x[0])
    there = np.full_like(y, at)
    outline = np.concatenate(
        [np.stack([there, y, top[edge]], 1), np.stack([there, y, bottom[edge]], 1)[::-1]]
    )
    draw_polygon(axes, view, outline, facecolor=_pale(place, 0.45), edgecolor=GREY, linewidth=0.5)


def _draw_cut(
    axes: Axes, view: View, x: FloatArray, y: float, faces: tuple[FloatArray, FloatArray], place: int
) -> None:
    there = np.full_like(x, y)
    top, bottom = (np.stack([x, there, face], 1) for face in faces)
    outline = np.concatenate([top, bottom[::-1]])
    draw_polygon(
        axes,
        view,
        outline,
        facecolor=_pale(place, 0.72),
        edgecolor=GREY,
        linewidth=0.5,
        hatch=HATCHES[place % 6],
    )
    edge = view.project(top)
    axes.plot(edge[:, 0], edge[:, 1], color=BLACK, linewidth=0.9)


def _pale(place: int, share: float) -> tuple[float, ...]:
    """Return the layer's colour thinned with white by `share`."""
    colour = np.array(mpl.colors.to_rgb(LAYER_COLOURS[place % len(LAYER_COLOURS)]))
    return tuple(float(part) for part in share + (1 - share) * colour)


def _name(axes: Axes, view: View, corner: tuple[float, float, float], layer: Layer) -> None:
    right, up = view.at(*corner)
    axes.text(right + 1.5, up, layer.name, fontweight="bold", va="bottom")
    axes.text(
        right + 1.5,
        up - 0.4,
        f"{layer.thickness / MILLIMETRE:g} mm, {layer.young_modulus / KILOPASCAL:g} kPa",
        fontsize=8,
        color=GREY,
        va="top",
    )


def _draw_tool(axes: Axes, view: View, case: Case, face: float) -> None:
    """Draw the tool's end standing on the dent, and its force."""
    tool = case.tools[0]
    radius = tool.diameter / 2 / MILLIMETRE
    angle = np.linspace(0, 2 * np.pi, 60)
    cx, cy = (part / MILLIMETRE for part in tool.position)
    ring = np.stack([cx + radius * np.cos(angle), cy + radius * np.sin(angle), np.full_like(angle, face)], 1)
    foot = view.project(ring)
    lid = view.project(ring + np.array([0, 0, 12.0 - face]))
    left, right = foot[:, 0].argmin(), foot[:, 0].argmax()
    front = foot[np.r_[left : right + 1]] if left < right else foot[np.r_[left : len(foot), 0 : right + 1]]
    body = np.concatenate([front, lid[[right]], lid[[left]]])
    axes.fill(body[:, 0], body[:, 1], facecolor="#c9cdd2", edgecolor=GREY, linewidth=0.6, alpha=0.92)
    axes.fill(lid[:, 0], lid[:, 1], facecolor="#e3e6e9", edgecolor=GREY, linewidth=0.6)
    axes.annotate(
        f"{tool.peak:g} N on a {tool.diameter / MILLIMETRE:g} mm disc",
        tuple(lid[lid[:, 0].argmax()]),
        view.at(0.62 * case.size[0] / MILLIMETRE, case.size[1] / MILLIMETRE, 3.0),
        arrowprops={"arrowstyle": "-", "color": GREY, "linewidth": 0.7},
        fontsize=8.5,
    )
