"""Silicone between platens: measured loads with what is foretold of them, and how errors grow."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from trocar.study.measured.phantom import Compression, thinner
from trocar.study.measured.platens import Faces
from trocar.study.measured.pressed import CALIBRATED, GROWTH_STRAINS, Model, PhantomResults
from trocar.study.report.figures.style import BLUE, FAINT, GREEN, GREY, VERMILION, sheet, styled

_LINES: dict[Model, dict[str, Any]] = {
    Model.LINEAR: {"color": VERMILION, "linewidth": 1.3, "linestyle": (0, (4, 2))},
    Model.NEO_HOOKEAN: {"color": BLUE, "linewidth": 1.3, "linestyle": "-"},
    Model.OGDEN: {"color": GREEN, "linewidth": 1.3, "linestyle": (0, (1.5, 1.5))},
}
_SHOWN = 3
_MOST = 0.667


@styled
def platens_figure(results: PhantomResults) -> Figure:
    """Draw specimen B of three compositions with both bounds of every law."""
    chosen = _chosen(results)
    figure = sheet(2.9)
    axes = figure.subplots(1, len(chosen), squeeze=False)[0]
    strain = np.linspace(1e-3, _MOST, 120)
    for place, disc in zip(axes, chosen, strict=True):
        place.axvspan(0, 100 * CALIBRATED, color=FAINT, alpha=0.45, linewidth=0)
        place.plot(
            100 * disc.strain,
            disc.load,
            color="#9aa0a6",
            linewidth=4.5,
            solid_capstyle="round",
            label="measured",
        )
        for model, line in _LINES.items():
            low, high = (
                results.force(one, disc, strain)
                for faces in Faces
                for one in results.of(faces, model)
                if one.composition == disc.composition
            )
            if model is not Model.LINEAR:
                place.fill_between(100 * strain, low, high, color=line["color"], alpha=0.18, linewidth=0)
            place.plot(100 * strain, high, label=str(model), **line)
        place.set_title(_name(disc))
        place.set_xlabel("compression / %")
        place.set_xlim(0, 100 * _MOST)
        place.set_ylim(0, 1.12 * disc.load.max())
    axes[0].set_ylabel("load / N")
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=len(labels))
    return figure


def platens_alt(results: PhantomResults) -> str:
    """Return what the figure shows, in words."""
    linear, held = (
        100 * np.median([disc.other_beyond for disc in results.of(Faces.BONDED, model)])
        for model in (Model.LINEAR, Model.NEO_HOOKEAN)
    )
    return (
        "Load against compression of silicone discs rises gently to 30 % and steeply beyond. Up to there every law "
        f"meets the measured line; beyond, a straight line stays far below (error {linear:.0f} %), neo-Hookean with "
        f"held faces follows it within {held:.0f} %."
    )


@styled
def growth_figure(results: PhantomResults) -> Figure:
    """Draw the error of every law against compression: the median of all compositions, and their range."""
    figure = sheet(2.9)
    axes = figure.subplots(1, 2, sharey=True)
    at = 100 * np.array(GROWTH_STRAINS)
    for place, faces in zip(axes, Faces, strict=True):
        place.axvspan(0, 100 * CALIBRATED, color=FAINT, alpha=0.45, linewidth=0)
        place.axhline(0, color=GREY, linewidth=0.8)
        for model, line in _LINES.items():
            errors = 100 * np.array([disc.growth for disc in results.of(faces, model)])
            place.fill_between(
                at, errors.min(axis=0), errors.max(axis=0), color=line["color"], alpha=0.13, lw=0
            )
            place.plot(at, np.median(errors, axis=0), label=str(model), **line)
        place.set_title("faces slide" if faces is Faces.FREE else "faces held")
        place.set_xlabel("compression / %")
        place.set_ylim(-100, 100)
        place.set_xlim(0, at[-1])
    axes[0].set_ylabel("load, foretold over\nmeasured, less 1 / %")
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=len(labels))
    return figure


def growth_alt(results: PhantomResults) -> str:
    """Return what the figure shows, in words."""
    last = 100 * np.median([disc.growth[-1] for disc in results.of(Faces.BONDED, Model.LINEAR)])
    half = 100 * np.median([disc.growth[-1] for disc in results.of(Faces.BONDED, Model.NEO_HOOKEAN)])
    return (
        "Error of the load against compression. The linear law goes from too stiff at small compression through zero "
        f"at about a quarter to {last:.0f} % at two thirds; neo-Hookean stays near zero to a half and ends "
        f"at {half:.0f} %."
    )


def _chosen(results: PhantomResults) -> list[Compression]:
    """Return specimen B of the stiffest, a middling and the softest composition."""
    discs = sorted(
        (disc for disc in results.measured if disc.specimen == "B"), key=lambda disc: -disc.load.max()
    )
    places = sorted({round(share * (len(discs) - 1)) for share in np.linspace(0, 1, _SHOWN)})
    return [discs[place] for place in places]


def _name(disc: Compression) -> str:
    grade = disc.composition.split("_")[0].removeprefix("EF")
    share = thinner(disc.composition)
    return f"00-{grade}" + (f" + {share:g} % thinner" if share else ", no thinner")
