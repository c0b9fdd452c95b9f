"""A sow's tissues pulled and beef held: what was measured, and what is foretold of it."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.figure import Figure

from trocar.study.measured.relaxed import ForetoldHolds
from trocar.study.measured.torn import JUDGED, ForetoldStrip
from trocar.study.report.figures.style import BLACK, BLUE, GREEN, GREY, sheet, styled
from trocar.units import KILOPASCAL


@styled
def strips_figure(strips: Sequence[ForetoldStrip]) -> Figure:
    """Draw each tissue: four animals pale, the judged one black, both laws."""
    figure = sheet(2.5)
    axes = figure.subplots(1, len(strips), squeeze=False)[0]
    for place, strip in zip(axes, strips, strict=True):
        for number, other in enumerate(strip.others):
            place.plot(
                strip.stretch,
                other / KILOPASCAL,
                color="#b4b9bf",
                linewidth=1.2,
                label="" if number else "fitted animals",
            )
        place.plot(strip.stretch, strip.measured / KILOPASCAL, color=BLACK, linewidth=1.8, label=JUDGED)
        for name, colour, line in (("Ogden", GREEN, "-"), ("fibre", BLUE, (0, (4, 2)))):
            place.plot(
                strip.stretch,
                strip.foretold[name] / KILOPASCAL,
                color=colour,
                linewidth=1.3,
                linestyle=line,
                label={"Ogden": "Ogden", "fibre": "fibre law"}[name],
            )
        place.set_title(strip.tissue.replace(" anal", "\nanal").replace(" mucosa", "\nmucosa"), fontsize=8.5)
        place.set_ylim(bottom=0)
        place.set_xlabel("stretch")
    axes[0].set_ylabel("nominal stress / kPa")
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=len(labels))
    return figure


def strips_alt(strips: Sequence[ForetoldStrip]) -> str:
    """Return what the figure shows, in words."""
    errors = "; ".join(f"{strip.tissue} {100 * strip.errors['Ogden']:.0f} %" for strip in strips)
    return (
        "Stress against stretch of a sow's tissues: animals lie factors apart, laws run through their middle. Error on "
        f"the animal that was not fitted: {errors}."
    )


@styled
def holds_figure(holds: ForetoldHolds) -> Figure:
    """Draw every judged test's course and the mean of what is foretold."""
    figure = sheet(2.7)
    left, right = figure.subplots(1, 2)
    left.plot(holds.since_peak, holds.curves.T, color="#b4b9bf", linewidth=0.7)
    left.plot(holds.since_peak, holds.curves.mean(axis=0), color=BLACK, linewidth=1.8, label="measured, mean")
    left.plot(
        holds.since_peak,
        holds.foretold_curves.mean(axis=0),
        color=BLUE,
        linewidth=1.4,
        linestyle=(0, (4, 2)),
        label="foretold, mean",
    )
    left.set_xlabel("time after the peak / s")
    left.set_ylabel("force over its peak")
    left.set_ylim(0.3, 1.02)
    left.legend()
    left.set_title(f"{holds.counts[1]} tests of another day")
    right.axhline(0, color=GREY, linewidth=0.8)
    right.plot(
        holds.since_peak, (holds.foretold_curves - holds.curves).T, color=BLUE, linewidth=0.7, alpha=0.5
    )
    right.set_xlabel("time after the peak / s")
    right.set_ylabel("foretold less measured")
    right.set_title("test by test")
    return figure


def holds_alt(holds: ForetoldHolds) -> str:
    """Return what the figure shows, in words."""
    return (
        f"Force falls to {holds.measured[-1]:.2f} of its peak in eight seconds, foretold {holds.foretold[-1]:.2f}; "
        f"single tests differ from what is foretold of them by {holds.judged:.3f}, root mean square."
    )
