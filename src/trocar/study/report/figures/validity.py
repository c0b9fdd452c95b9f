"""Where each wave model may be trusted: its error over force and tool diameter."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from trocar.study.report.figures.style import GREY, label, sheet, styled, three
from trocar.study.validity import BOUNDS, LINEAR, STIFFENING, ValidityMap
from trocar.units import MILLIMETRE

_COLUMNS = 160  # along the axis of force
_EDGES = (0.0, 0.02, 0.05, 0.1, 0.2, 10.0)  # of the bands of error
_SHADES = ("#08519c", "#4292c6", "#9ecae1", "#fdd49e", "#e6550d")  # dark blue good, orange not
_WORDS = ("below 2 %", "2 to 5 %", "5 to 10 %", "10 to 20 %", "above 20 %")


@styled
def validity_figure(found: ValidityMap) -> Figure:
    """Draw a panel for every model, linear above, stiffening below."""
    panels = sorted({key for row in found.rows for key in row.curves}, key=lambda key: (key[1], key[0]))
    kinds = [kind for kind in (LINEAR, STIFFENING) if any(key[1] == kind for key in panels)]
    models = sorted({model for model, _ in panels})
    figure = sheet(0.9 + (0.7 + 0.24 * len(found.rows)) * len(kinds))
    axes = figure.subplots(len(kinds), len(models), sharex=True, sharey=True, squeeze=False)
    highest = max(float(row.force[-1]) for row in found.rows if len(row.force))
    for i, kind in enumerate(kinds):
        for j, model in enumerate(models):
            _panel(axes[i, j], found, (model, kind), highest)
            axes[i, j].set_title(f"{label(model)}, {kind}")
    for panel in axes[-1]:
        panel.set_xlabel("force / N")
    for panel in axes[:, 0]:
        panel.set_ylabel("tool / mm")
    swatches = [
        axes[0, 0].scatter([], [], marker="s", s=50, color=shade, label=words)
        for shade, words in zip(_SHADES, _WORDS, strict=True)
    ]
    figure.legend(handles=swatches, loc="outside lower center", ncols=len(_WORDS), columnspacing=1.2)
    return figure


def _panel(panel: Axes, found: ValidityMap, key: tuple[str, str], highest: float) -> None:
    """Draw bands of error, a bar for each tool, as long as the reference went."""
    panel.grid(visible=False)
    for place, row in enumerate(found.rows):
        if key not in row.curves:
            continue
        edges = np.linspace(0.0, float(row.force[-1]), _COLUMNS + 1)
        middles = 0.5 * (edges[1:] + edges[:-1])
        force = np.concatenate([[0.0], row.force])
        off = np.abs(np.concatenate([row.curves[key].error[:1], row.curves[key].error]))
        bands = np.digitize(np.interp(middles, force, off), _EDGES[1:-1])
        starts = np.flatnonzero(np.diff(bands, prepend=-1))
        for start, end in zip(starts, [*starts[1:], len(bands)], strict=True):
            panel.barh(
                place,
                edges[end] - edges[start],
                left=edges[start],
                height=0.8,
                color=_SHADES[bands[start]],
                linewidth=0,
            )
        panel.annotate(
            f"{100 * row.share[-1]:.0f} %",
            (float(row.force[-1]), place),
            (3, 0),
            textcoords="offset points",
            va="center",
            fontsize=7,
            color=GREY,
        )
    panel.set_yticks(range(len(found.rows)), [f"{row.diameter / MILLIMETRE:g}" for row in found.rows])
    panel.set_xlim(0.0, 1.12 * highest)


def validity_alt(found: ValidityMap) -> str:
    """Return what the figure shows, in words."""
    parts = []
    for row in found.rows:
        for (model, kind), curve in row.curves.items():
            limits = ", ".join(
                f"{100 * bound:g} % {'at ' + three(limit) + ' N' if np.isfinite(limit) else 'never'}"
                for bound, limit in zip(BOUNDS, curve.leaves, strict=True)
            )
            parts.append(f"{label(model)} {kind} under {row.diameter / MILLIMETRE:g} mm leaves {limits}")
    return (
        "Error against hyperelastic finite elements over force and tool diameter. " + "; ".join(parts) + "."
    )
