"""A calibration: data and fit in time and over the force, what is left, intervals, and what cannot be told apart."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from trocar.study.calibration.calibration import Calibration
from trocar.study.report.figures.agreement import MICROMETRE
from trocar.study.report.figures.style import (
    BLACK,
    BLUE,
    FAINT,
    GREY,
    LAYER_COLOURS,
    ORANGE,
    label,
    sheet,
    styled,
    three,
)
from trocar.units import MILLIMETRE

_DOTS = {"linestyle": "none", "marker": "o", "markersize": 3.6, "markeredgewidth": 0.0, "alpha": 0.7}
_WIDEST = 3.0  # decades either side that an interval's axis shows
_LEVEL = 1.96


@styled
def fit_figure(calibration: Calibration) -> Figure:
    """Draw the depths against time and force, and below what the fit leaves."""
    figure = sheet(4.6)
    grid = figure.subplots(2, 2, height_ratios=(2.6, 1.0), sharex="col")
    problem, fitted = calibration.problem, calibration.fitted
    measurement, read = problem.measurement, problem.probes
    for i, series in enumerate(measurement.series):
        if series.places is not None:
            continue
        colour = LAYER_COLOURS[i % len(LAYER_COLOURS)]
        part = read.parts[i]
        seen = problem.used[part]
        force = np.interp(series.time, measurement.time, measurement.force)
        reading, rows = series.value - fitted.offsets[i], fitted.rows[part]
        for column, x in enumerate((series.time, force)):
            above, below = grid[0, column], grid[1, column]
            above.plot(x[seen], reading[seen] / MILLIMETRE, color=colour, label=series.name, **_DOTS)
            below.plot(x[seen], (reading - rows)[seen] / MICROMETRE, color=colour, **_DOTS)
            if not seen.all():
                open_ = {**_DOTS, "markeredgewidth": 0.6, "markerfacecolor": "none"}
                name = f"{series.name}, held out"
                above.plot(x[~seen], reading[~seen] / MILLIMETRE, color=colour, label=name, **open_)
                below.plot(x[~seen], (reading - rows)[~seen] / MICROMETRE, color=colour, **open_)
            fit = f"fit, {label(calibration.model)}" if i == 0 else None
            above.plot(x, rows / MILLIMETRE, color=BLACK, linewidth=0.8, label=fit)
        noise = fitted.noise[i].used / MICROMETRE
        if i == 0:
            for below in grid[1]:
                below.axhspan(-_LEVEL * noise, _LEVEL * noise, color=FAINT, alpha=0.6, linewidth=0)
    if not problem.used.all():
        first = read.time[~problem.used].min()
        for axes in grid[:, 0]:
            axes.axvspan(first, measurement.time[-1], color=ORANGE, alpha=0.08, linewidth=0)
    for axes in grid[1]:
        axes.axhline(0.0, color=GREY, linewidth=0.8)
    grid[0, 0].set_title("in time")
    grid[0, 1].set_title("over the force")
    grid[0, 0].set_ylabel("displacement / mm")
    grid[1, 0].set_ylabel("left / µm")
    grid[1, 0].set_xlabel("time / s")
    grid[1, 1].set_xlabel("force / N")
    grid[0, 0].set_ylim(bottom=min(0.0, grid[0, 0].get_ylim()[0]))
    grid[0, 1].legend(loc="upper left")
    return figure


def fit_alt(calibration: Calibration) -> str:
    """Say what `fit_figure` shows."""
    noise = calibration.fitted.noise[0]
    return (
        "Measured and fitted displacement against time and against force, to "
        f"{three(calibration.problem.measurement.peak)} N. The fit leaves "
        f"{three(noise.rms / MICROMETRE)} micrometres, root mean square."
    )


@styled
def knowledge_figure(calibration: Calibration) -> Figure:
    """Draw the intervals beside the starting values, and the correlations."""
    count = len(calibration.known.estimates)
    figure = sheet(max(1.9, 1.0 + 0.42 * count))
    intervals, squares = figure.subplots(1, 2, width_ratios=(1.6, 1.0))
    _intervals(intervals, calibration)
    _correlations(squares, calibration)
    return figure


def _intervals(axes: Axes, calibration: Calibration) -> None:
    estimates = calibration.known.estimates
    names = [item.parameter.name for item in estimates]
    for i, item in enumerate(estimates):
        half = min(_LEVEL * item.error / np.log(10), _WIDEST)
        noise = min(_LEVEL * item.from_noise / np.log(10), _WIDEST)
        axes.plot(
            [-half, half], [i, i], color=BLUE if item.told else FAINT, linewidth=5.0, solid_capstyle="butt"
        )
        if item.told:
            axes.plot([-noise, noise], [i, i], color=BLACK, linewidth=1.4, solid_capstyle="butt")
        axes.plot(0.0, i, marker="o", color=BLACK, markersize=4.0)
        start = np.log10(item.start / item.value)
        axes.plot(start, i, marker="|", color=ORANGE, markersize=11.0, markeredgewidth=2.0)
    axes.plot([], [], color=BLUE, linewidth=5.0, label="95 %, model's error counted")
    axes.plot([], [], color=BLACK, linewidth=1.4, label="noise alone")
    axes.plot(
        [],
        [],
        linestyle="none",
        marker="|",
        markersize=11.0,
        markeredgewidth=2.0,
        color=ORANGE,
        label="start",
    )
    axes.set_yticks(range(len(names)), names)
    axes.set_ylim(len(names) - 0.4, -0.6)
    widest = max(abs(np.array(axes.get_xlim())).max(), 0.02)
    axes.set_xlim(-widest, widest)
    ticks = [tick for tick in _ticks(float(widest)) if abs(np.log10(tick)) <= widest]
    axes.set_xticks(np.log10(ticks), [f"{tick:g}" for tick in ticks])
    axes.set_xlabel("over the fitted value")
    axes.set_title("what is known")
    axes.legend(
        loc="upper center",
        bbox_to_anchor=(0.5, -0.32 - 0.02 / len(names)),
        ncols=3,
        fontsize=7.5,
        handlelength=1.4,
    )


def _ticks(widest: float) -> tuple[float, ...]:
    """Return ratios to mark on an axis that reaches this many decades to either side of 1."""
    if widest > 1:
        return tuple(10.0**place for place in range(-4, 5))
    if widest > 0.35:
        return 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0
    return (0.6, 0.8, 1.0, 1.25, 1.6) if widest > 0.06 else (0.9, 0.95, 1.0, 1.05, 1.1)


def _correlations(axes: Axes, calibration: Calibration) -> None:
    known = calibration.known
    count = len(known.estimates)
    axes.imshow(known.correlation, cmap="RdBu_r", vmin=-1, vmax=1, aspect="auto")
    axes.grid(visible=False)
    for i in range(count):
        for j in range(count):
            value = float(known.correlation[i, j])
            colour = "white" if abs(value) > 0.6 else BLACK
            text = f"{value:.2f}".replace("-", "−")
            axes.text(j, i, text, ha="center", va="center", color=colour, fontsize=8)
    axes.set_yticks([])
    axes.set_xticks(range(count), [str(i + 1) for i in range(count)])
    axes.set_xlabel("parameter, in the order at the left")
    axes.set_title("correlation")


def knowledge_alt(calibration: Calibration) -> str:
    """Say what `knowledge_figure` shows."""
    return "Intervals of the parameters and their correlations. " + " ".join(calibration.known.sentences)


@styled
def markers_figure(calibration: Calibration) -> Figure:
    """Draw what the markers did against what the fit says they do."""
    series = calibration.problem.measurement.series
    chosen = [i for i, one in enumerate(series) if one.places is not None]
    figure = sheet(2.9)
    *panels, away = figure.subplots(1, len(chosen) + 1)
    for axes, colour, i in zip(panels, LAYER_COLOURS[1:], chosen, strict=False):
        rows = calibration.fitted.rows[calibration.problem.probes.parts[i]] / MILLIMETRE
        reading = series[i].value / MILLIMETRE
        ends = [min(rows.min(), reading.min()), max(rows.max(), reading.max())]
        axes.plot(ends, ends, color=GREY, linewidth=0.8)
        axes.plot(rows, reading, color=colour, **_DOTS)
        axes.set_title(series[i].name)
        axes.set_xlabel("fit / mm")
        axes.set_ylabel("measured / mm")
        distance = np.hypot(*(series[i].places - calibration.case.tools[0].position).T)  # type: ignore[operator]
        away.plot(distance / MILLIMETRE, (reading - rows) * MILLIMETRE / MICROMETRE, color=colour, **_DOTS)
    away.axhline(0.0, color=GREY, linewidth=0.8)
    away.set_title("what is left")
    away.set_xlabel("distance from the tool / mm")
    away.set_ylabel("left / µm")
    return figure


def markers_alt(calibration: Calibration) -> str:
    """Say what `markers_figure` shows."""
    noise = [
        f"{one.name} to {three(one.rms / MILLIMETRE)} mm"
        for one, series in zip(calibration.fitted.noise, calibration.problem.measurement.series, strict=True)
        if series.places is not None
    ]
    return f"Displacements of the markers, measured against fitted: {', '.join(noise)}, root mean square."
