"""The middle of the dermis let go: the paper's formula as printed, and corrected."""

from __future__ import annotations

from matplotlib.figure import Figure

from trocar.study.paper_preset import PaperStudy
from trocar.study.report.figures.style import BLUE, GREY, VERMILION, sheet, styled, three
from trocar.units import MILLISECOND

MICROMETRE = 1e-6  # [m]


@styled
def printed_and_corrected_figure(study: PaperStudy) -> Figure:
    """Draw the displacement of the middle against time, each on the time scale of its own lowest mode."""
    figure = sheet(3.0)
    left, right = figure.subplots(1, 2, sharey=True)
    printed, corrected = study.printed, study.corrected
    left.plot(printed.time, printed.centre / MICROMETRE, color=VERMILION, linewidth=1.6)
    right.plot(corrected.time / MILLISECOND, corrected.centre / MICROMETRE, color=BLUE, linewidth=1.6)
    left.set_title("As printed: one mode")
    right.set_title(f"Corrected: {corrected.modes} modes")
    left.set_xlabel("time / s, as the paper reads it")
    right.set_xlabel("time / ms")
    left.set_ylabel("displacement of\nthe middle / µm")
    for axes, end in ((left, printed.time[-1]), (right, corrected.time[-1] / MILLISECOND)):
        axes.axhline(0, color=GREY, linewidth=0.8)
        axes.set_xlim(0, end)
    return figure


def printed_and_corrected_alt(study: PaperStudy) -> str:
    """Return what the figure shows, in words."""
    printed, corrected = study.printed, study.corrected
    return (
        "Displacement of the middle against time. As printed, a cosine of "
        f"{three(printed.peak / MICROMETRE)} µm with a "
        f"period of {three(printed.period)} s. Corrected, it starts at "
        f"{three(corrected.peak / MICROMETRE)} µm and swings "
        f"with a period of {three(corrected.period / MILLISECOND)} ms, no longer a pure cosine."
    )
