"""The same press under each support: how deep, and how far the wave models are from finite elements."""

from __future__ import annotations

from collections.abc import Mapping

from matplotlib.figure import Figure

from trocar.model import Support
from trocar.study.compare import Comparison
from trocar.study.report.figures.style import MODEL_MARKS, label, sheet, styled, three
from trocar.units import MILLIMETRE

WORDS = {
    Support.EDGES: "edges: sides clamped,\nbase free (the paper)",
    Support.EDGES_AND_BASE: "edges+base: sides clamped,\nbase held",
    Support.BASE: "base: base held, sides\nsimply supported",
}


@styled
def supports_figure(supports: Mapping[Support, Comparison]) -> Figure:
    """Draw the block's largest deflection under each support, one mark a model, differences written beside.

    Args:
        supports: one comparison each, of the same models.
    """
    figure = sheet(0.9 + 0.55 * len(supports))
    axes = figure.subplots()
    names: list[str] = []
    for place, comparison in enumerate(supports.values()):
        truth = float(comparison["fea"].block.max())
        differences = []
        for history in comparison.histories:
            mark, colour = MODEL_MARKS[history.model]
            peak = float(history.block.max())
            axes.plot(
                peak / MILLIMETRE,
                place,
                mark,
                color=colour,
                markersize=9 if history.model == "fea" else 6,
                label="" if history.model in names else label(history.model),
                markerfacecolor="none" if history.model == "fea" else colour,
                zorder=3,
            )
            names.append(history.model)
            if history.model != "fea":
                differences.append(f"{label(history.model)} {100 * (peak - truth) / truth:+.2g} %")
        deepest = max(float(history.block.max()) for history in comparison.histories)
        axes.annotate(
            "\n".join(differences),
            (deepest / MILLIMETRE, place),
            (9, 0),
            textcoords="offset points",
            va="center",
            fontsize=8,
        )
    axes.set_yticks(range(len(supports)), [WORDS[support] for support in supports])
    axes.invert_yaxis()
    axes.margins(y=0.25)
    axes.set_xlim(0, 1.4 * axes.get_xlim()[1])
    axes.grid(axis="y", visible=False)
    axes.set_xlabel("largest deflection of the block / mm")
    figure.legend(loc="outside upper center", ncols=3)
    return figure


def supports_alt(supports: Mapping[Support, Comparison]) -> str:
    """Return what the figure shows, in words."""
    parts = []
    for support, comparison in supports.items():
        truth = float(comparison["fea"].block.max())
        others = ", ".join(
            f"{label(history.model)} {100 * (float(history.block.max()) - truth) / truth:+.2g} %"
            for history in comparison.histories
            if history.model != "fea"
        )
        parts.append(f"{support.value}: {three(truth / MILLIMETRE)} mm by finite elements, {others}")
    return "Largest deflection under each support. " + "; ".join(parts) + "."
