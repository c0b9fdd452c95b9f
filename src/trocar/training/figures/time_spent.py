"""Where the time went: each stage of an attempt in three kinds of time, beside an expert's and the marks' times."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Patch
from matplotlib.transforms import blended_transform_factory

from trocar.training.figures.page import BACKGROUND, DIM, LIMIT, TEXT, page_sheet, seconds, svg_text
from trocar.training.figures.stages import Stretch, stages_of
from trocar.training.metrics.attempt import Attempt
from trocar.training.tasks.find import Find
from trocar.training.tasks.moment import Moment
from trocar.training.tasks.progress import Progress

_EVERY = 10  # ticks: no kind of time is told more finely
_AROUND, _BAR = 1.25, 0.62  # [in]
_NARROW = 0.022  # of the time shown: a stage with less has no room for its number
# Grey, purple, green, and rising: lightness and height tell them apart as well.
KINDS = (
    ("on the way", "#5a6672", 0.38),
    ("touching, not yet as asked", "#CC79A7", 0.69),
    ("as asked", "#2fd3a2", 1.0),
)


@dataclass(frozen=True, kw_only=True)
class Spent:
    """What a stage's time went into.

    Attributes:
        stage: which.
        runs: one after the other: number of the kind, begin and end [s].
    """

    stage: Stretch
    runs: list[tuple[int, float, float]]

    def total(self, kind: int) -> float:
        """Return the time of a kind [s]."""
        return sum(end - begin for which, begin, end in self.runs if which == kind)


def spent(attempt: Attempt, progress: Progress) -> list[Spent]:
    """Return each stage's time by kind: not every hand asked for touches, they do, or all is as it should be."""
    found = []
    for stage in stages_of(attempt, progress):
        first, after = np.searchsorted(attempt.times, (stage.begin, stage.end), side="right").tolist()
        ticks = range(first, after, _EVERY)
        ends = [*(float(attempt.times[tick - 1]) if tick else 0.0 for tick in ticks[1:]), stage.end]
        runs: list[tuple[int, float, float]] = []
        begin = stage.begin
        for tick, end in zip(ticks, ends, strict=False):
            kind = _kind(attempt, progress, stage, tick)
            if runs and runs[-1][0] == kind:
                begin = runs.pop()[1]
            runs.append((kind, begin, end))
            begin = end
        found.append(Spent(stage=stage, runs=runs))
    return found


def _kind(attempt: Attempt, progress: Progress, stage: Stretch, tick: int) -> int:
    moment = Moment(float(attempt.times[tick]), attempt.records[tick])
    now = np.searchsorted(progress.ended, moment.time, side="left")  # the step of this tick, within the stage
    step = progress.task.steps[min(int(now), len(progress.task.steps) - 1)]
    touches = [moment.touches(hand) for hand in step.hands]
    touching = (
        any(touches) if isinstance(step, Find) else all(touches)
    )  # one hand feels, the other takes hold
    if len(stage.steps) > 1:  # along a line, as asked is where nothing is wrong
        return 2 if touching and not step.mistake(moment) else int(touching)
    return 2 if step.met(moment) else int(touching)


def time_spent(attempt: Attempt, progress: Progress, expert: tuple[Attempt, Progress] | None = None) -> str:
    """Draw it as SVG.

    Args:
        attempt: whose time.
        progress: of it.
        expert: another attempt at the same task, drawn beneath.
    """
    marking = progress.task.marking
    rows = [("you", spent(attempt, progress))]
    if expert is not None:
        rows.append(("expert", spent(*expert)))
    with page_sheet(_AROUND + _BAR * len(rows)) as figure:
        axes = figure.subplots()
        longest = max([marking.cutoff, *(found[-1].stage.end for _, found in rows)])
        for row, (_, found) in enumerate(rows):
            _draw(axes, row, found, longest)
        across = blended_transform_factory(axes.transData, axes.transAxes)
        for at, words, colour, side in (
            (marking.expert_time, f"expert's time {marking.expert_time:g} s", TEXT, "left"),
            (marking.cutoff, f"nothing left at {marking.cutoff:g} s", LIMIT, "right"),
        ):
            axes.axvline(at, color=colour, linewidth=1.1, linestyle=(0, (4, 2)), zorder=4)
            axes.annotate(
                words,
                (at, 1.0),
                xycoords=across,
                xytext=(0, 3),
                textcoords="offset points",
                ha="center" if side == "left" else "right",
                va="bottom",
                fontsize=9,
                color=colour,
            )
        axes.set_ylim(len(rows) - 0.5, -0.62)
        axes.set_yticks(range(len(rows)), [f"{name}\n{seconds(found[-1].stage.end)}" for name, found in rows])
        axes.tick_params(axis="y", length=0)
        axes.spines["left"].set_visible(False)
        axes.grid(visible=False, axis="y")
        axes.set_xlim(0.0, 1.005 * longest)
        axes.set_xlabel("time [s]")
        handles = [
            Patch(color=colour, label=f"{words} {seconds(sum(each.total(kind) for each in rows[0][1]))}")
            for kind, (words, colour, _) in enumerate(KINDS)
        ]
        figure.legend(handles=handles, loc="outside upper left", ncols=3, handlelength=1.2, columnspacing=1.8)
        return svg_text(
            figure, "time-spent", "Where the time went", _description(rows[0][1], marking.expert_time)
        )


def _draw(axes: Axes, row: int, found: list[Spent], longest: float) -> None:
    for each in found:
        for kind, begin, end in each.runs:
            height = 0.62 * KINDS[kind][2]
            axes.bar(
                begin,
                height,
                end - begin,
                bottom=row + 0.40 - height,
                align="edge",
                color=KINDS[kind][1],
                linewidth=0,
            )
        stage = each.stage
        axes.plot(
            [stage.end] * 2, [row + 0.40, row - 0.22], color=BACKGROUND if stage.done else DIM, linewidth=1.4
        )
        if stage.end - stage.begin > _NARROW * longest and len(found) > 1:
            axes.text(
                (stage.begin + stage.end) / 2,
                row - 0.24,
                str(stage.number),
                ha="center",
                va="bottom",
                color=DIM,
                fontsize=9,
            )


def _description(found: list[Spent], expert_time: float) -> str:
    longest = max(found, key=lambda each: each.stage.end - each.stage.begin)
    parts = ", ".join(
        f"{seconds(sum(each.total(kind) for each in found))} {words}"
        for kind, (words, _, _) in enumerate(KINDS)
    )
    stage = longest.stage
    return (
        f"{seconds(found[-1].stage.end)} in all, an expert's time being {expert_time:g} s: {parts}. "
        f"The longest step was number {stage.number} ({stage.words}) with {seconds(stage.end - stage.begin)}."
    )
