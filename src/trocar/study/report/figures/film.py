"""Press and release as a strip of pictures (the paper's figure 3); `animation` makes the moving one."""

from __future__ import annotations

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from trocar.model import FloatArray
from trocar.study.film import Film
from trocar.study.report.figures.axonometry import View, colours, draw_rim, draw_surface, fit, quads
from trocar.study.report.figures.block import enlargement
from trocar.study.report.figures.style import (
    DEPTHS,
    LAYER_COLOURS,
    LAYER_STYLES,
    VERMILION,
    sheet,
    styled,
    three,
)
from trocar.units import MILLIMETRE, MILLISECOND

LETTERS = "abcdef"
DENT = 9.0  # [mm] that the deepest dent is drawn at most


def moments(film: Film) -> list[int]:
    """Return the frames the strip shows: pressing, deepest, then let go and swinging back; ascending."""
    deepest = int(np.argmax(next(iter(film.depth.values()))))
    peak = int(np.flatnonzero(film.force == film.force.max())[0])
    let_go = int(np.flatnonzero(film.force > 0)[-1]) + 1  # first frame without force
    end = len(film.time) - 1
    after = [let_go + round(share * (end - let_go)) for share in (0.06, 0.3)]
    return sorted({peak // 3, 2 * peak // 3, deepest, *after, end})


@styled
def film_figure(film: Film) -> Figure:
    """Draw six moments of the top face, and depth of every layer against time with those moments marked."""
    shown = moments(film)
    deepest = -float(film.height.min())
    factor = enlargement(deepest, DENT)
    scale, cmap = Normalize(0, deepest / MILLIMETRE), mpl.colormaps[DEPTHS]
    view = View()
    x, y = film.x / MILLIMETRE, film.y / MILLIMETRE
    figure = sheet(5.2)
    panels = figure.subplot_mosaic([list(row) for row in ("abc", "def", "ttt")], height_ratios=(1, 1, 1.15))
    corners = np.array([[a, b, c] for a in (x[0], x[-1]) for b in (y[0], y[-1]) for c in (0.0, 2.0)])
    for letter, frame in zip(LETTERS, shown, strict=False):
        z = factor * film.height[frame] / MILLIMETRE
        faces = quads(x, y, z)
        draw_surface(
            panels[letter], view, faces, colours(faces, -film.height[frame] / MILLIMETRE, scale, cmap)
        )
        draw_rim(panels[letter], view, x, y, z)
        time, force = film.time[frame] / MILLISECOND, film.force[frame]
        panels[letter].set_title(f"{letter}  {time:.0f} ms, {force:.3g} N", fontweight="normal", loc="center")
    for letter in LETTERS:
        fit(panels[letter], view, corners, margin=0.0)
    bar = figure.colorbar(
        ScalarMappable(scale, cmap),
        ax=[panels[letter] for letter in LETTERS],
        shrink=0.8,
        aspect=22,
        pad=0.01,
    )
    bar.set_label(f"deflection / mm\n(drawn {factor:g} times as large)")
    bar.outline.set_visible(False)
    _draw_depths(panels["t"], film, shown)
    return figure


def film_alt(film: Film) -> str:
    """Return what the strip shows, in words."""
    top = next(iter(film.depth.values()))
    return (
        f"Six pictures of the top face: pressed to {three(float(top.max()) / MILLIMETRE)} mm by "
        f"{film.force.max():g} N, let go, and swinging back to {three(abs(float(top[-1])) / MILLIMETRE)} mm from flat "
        f"at {film.time[-1] / MILLISECOND:.0f} ms. Below, the depth of every layer against time."
    )


def _draw_depths(axes: Axes, film: Film, shown: list[int]) -> None:
    time = film.time / MILLISECOND
    for place, (layer, depth) in enumerate(film.depth.items()):
        axes.plot(
            time,
            depth / MILLIMETRE,
            label=layer,
            linewidth=1.6,
            color=LAYER_COLOURS[place % 6],
            linestyle=LAYER_STYLES[place % 6],
        )
    top: FloatArray = next(iter(film.depth.values())) / MILLIMETRE
    axes.plot(time[shown], top[shown], "o", color=VERMILION, markersize=4)
    for letter, frame in zip(LETTERS, shown, strict=False):
        axes.annotate(letter, (time[frame], top[frame]), (5, 5), textcoords="offset points", fontsize=8.5)
    axes.set_xlabel("time / ms")
    axes.set_ylabel("depth under\nthe tool / mm")
    axes.set_xlim(time[0], time[-1] * 1.02)
    axes.legend(loc="upper right")
