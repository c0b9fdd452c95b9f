"""Creep, relaxation and hysteresis of several models, side by side."""

from __future__ import annotations

from collections.abc import Mapping

from matplotlib.figure import Figure

from trocar.study.memory_protocols import Curve, Loop
from trocar.study.report.figures.style import MODEL_LINES, label, sheet, styled
from trocar.units import MILLIMETRE


@styled
def memory_figure(
    creeps: Mapping[str, Curve], relaxations: Mapping[str, Curve], loops: Mapping[str, Mapping[float, Loop]]
) -> Figure:
    """Draw the three protocols.

    Args:
        creeps: under one force, by model.
        relaxations: under one mean deflection, by model.
        loops: by model and by rate of the force [N/s]; the faster, the steeper.
    """
    figure = sheet(2.9)
    creep, relaxation, loop = figure.subplots(1, 3)
    for name in sorted(creeps, key=lambda name: name != "fea"):
        line = MODEL_LINES[name]
        grown, fallen = creeps[name], relaxations[name]
        creep.semilogx(grown.time[1:], grown.deflection[1:] / MILLIMETRE, label=label(name), **line)
        relaxation.semilogx(fallen.time[1:], fallen.force[1:], **line)
        for one in loops[name].values():
            loop.plot(one.curve.deflection / MILLIMETRE, one.curve.force, **line)
    first = next(iter(creeps.values()))
    creep.set_title(f"creep under {first.force[0]:g} N")
    creep.set_xlabel("time / s")
    creep.set_ylabel("mean deflection / mm")
    creep.set_ylim(bottom=0)
    creep.legend(loc="lower right")
    held = next(iter(relaxations.values())).deflection[0]
    relaxation.set_title(f"relaxation at {held / MILLIMETRE:g} mm")
    relaxation.set_xlabel("time / s")
    relaxation.set_ylabel("force / N")
    relaxation.set_ylim(bottom=0)
    loop.set_title("hysteresis")
    loop.set_xlabel("mean deflection / mm")
    loop.set_ylabel("force / N")
    loop.set_xlim(left=0)
    loop.set_ylim(bottom=0)
    return figure
