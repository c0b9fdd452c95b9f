"""What every picture on the trainer's page shares: its dark colours, its width, and SVG that the page may show.

The page lets in no inline styles (`web.doors`), so these become attributes; and several pictures may stand in one
page, so each has identifiers of its own. A title and a sentence with the key figures are in it for those who do not
see it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from html import escape
from io import StringIO
from threading import RLock
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke

from trocar.model import FloatArray
from trocar.study.report.figures.style import ORANGE, SKY, settings, sheet

TEXT, DIM, GRID, EXPERT = "#d7dde3", "#98a3ae", "#2b323a", "#8b96a1"
LIMIT = "#ff7a33"  # vermilion (D55E00) made lighter, for 4.5 to 1 of contrast on the page
SCORE = "#2fd3a2"  # bluish green, likewise
HAND_COLOURS = (SKY, ORANGE)
HAND_STYLES: tuple[Any, ...] = ("-", (0, (4, 1)))  # left and right differ without colour, too
BACKGROUND = "#101418"  # of the page; only halos of letters that lie over lines are drawn in it
HALO = [withStroke(linewidth=2.5, foreground=BACKGROUND)]
PAGE_WIDTH = 720  # [px]
_SETTINGS: dict[str, Any] = {
    "text.color": TEXT,
    "axes.labelcolor": TEXT,
    "axes.titlecolor": TEXT,
    "axes.edgecolor": DIM,
    "axes.facecolor": "none",
    "figure.facecolor": "none",
    "savefig.facecolor": "none",
    "xtick.color": DIM,
    "ytick.color": DIM,
    "xtick.labelcolor": TEXT,
    "ytick.labelcolor": TEXT,
    "xtick.labelsize": 9.0,
    "ytick.labelsize": 9.0,
    "legend.fontsize": 9.0,
    "axes.titlesize": 10.0,
    "grid.color": GRID,
}
_ONE_AT_A_TIME = RLock()  # matplotlib's settings are global, and a server draws in several threads
_POINTS = 72  # to the inch, of matplotlib's SVG
_STYLE = re.compile(r' style="([^"]*)"')


@contextmanager
def page_sheet(height: float) -> Iterator[Figure]:
    """Draw and save on a sheet of this height [in] with the page's settings, one thread at a time."""
    with _ONE_AT_A_TIME, settings():
        mpl.rcParams.update(_SETTINGS)  # type: ignore[arg-type]
        yield sheet(height)


def svg_text(figure: Figure, name: str, title: str, description: str) -> str:
    """Return a figure as one SVG element, to be called while its sheet is open.

    Args:
        figure: what is drawn.
        name: begins every identifier in it.
        title: in a few words.
        description: in a sentence with the key figures.
    """
    stream = StringIO()
    figure.savefig(stream, format="svg", metadata={"Date": None, "Creator": None})
    drawn = stream.getvalue()
    drawn = drawn[drawn.index("<svg") :]
    drawn = re.sub(r"<metadata>.*?</metadata>\s*", "", drawn, flags=re.DOTALL)
    drawn = re.sub(r"<defs>\s*<style.*?</style>\s*</defs>\s*", "", drawn, count=1, flags=re.DOTALL)
    drawn = _STYLE.sub(_attributes, drawn)
    drawn = re.sub(r'(\bid="|href="#|url\(#)', rf"\g<1>{name}-", drawn)
    width, height = (round(inches * _POINTS, 2) for inches in figure.get_size_inches())
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" version="1.1" '
        f'width="{PAGE_WIDTH}" height="{round(PAGE_WIDTH * height / width)}" viewBox="0 0 {width:g} {height:g}" '
        f'role="img" aria-labelledby="{name}-title {name}-desc" stroke-linejoin="round" stroke-linecap="butt">\n'
        f' <title id="{name}-title">{escape(title)}</title>\n'
        f' <desc id="{name}-desc">{escape(description)}</desc>'
    )
    return head + drawn[drawn.index(">") + 1 :]


def _attributes(style: re.Match[str]) -> str:
    pairs = (part.split(":", 1) for part in style[1].split(";") if part.strip())
    return "".join(f' {name.strip()}="{value.strip()}"' for name, value in pairs)


def beside(axes: Axes, height: float, words: str, colour: str) -> None:
    """Write words outside the right end of a horizontal line, where no curve runs."""
    axes.annotate(
        words,
        (1.0, height),
        xycoords=("axes fraction", "data"),
        xytext=(4, 0),
        textcoords="offset points",
        va="center",
        fontsize=9,
        color=colour,
        annotation_clip=False,
    )


def thinned(times: FloatArray, values: FloatArray, bins: int = PAGE_WIDTH) -> tuple[FloatArray, FloatArray]:
    """Return a curve's least and largest points in every bin of time, in order: as it looks, with every peak.

    Args:
        times: rising, shape (n,).
        values: shape (n,).
        bins: how many there are.
    """
    if len(times) <= 4 * bins:
        return times, values
    edges = np.linspace(0, len(times), bins + 1).astype(int)
    kept = {0, len(times) - 1}
    for begin, end in zip(edges[:-1].tolist(), edges[1:].tolist(), strict=True):
        kept |= {begin + int(values[begin:end].argmin()), begin + int(values[begin:end].argmax())}
    where = np.array(sorted(kept))
    return times[where], values[where]


def seconds(value: float) -> str:
    """Return a time as people say it."""
    return f"{value:.1f} s"


def times_over(count: int, one: str, many: str | None = None) -> str:
    """Return "1 mistake", "2 mistakes"."""
    return f"{count} {one if count == 1 else many or one + 's'}"
