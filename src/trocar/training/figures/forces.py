"""The force on each tip over time, between what the steps asked for, with the mistakes beneath."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.transforms import blended_transform_factory

from trocar.contact.instrument import NAMES
from trocar.model import FloatArray
from trocar.training.figures.page import (
    DIM,
    EXPERT,
    HAND_COLOURS,
    LIMIT,
    TEXT,
    beside,
    page_sheet,
    seconds,
    svg_text,
    thinned,
    times_over,
)
from trocar.training.figures.stages import Stretch, hands_asked, stage_steps, stages_of
from trocar.training.metrics.attempt import Attempt
from trocar.training.metrics.forces import TOUCHING
from trocar.training.tasks.progress import Progress

_PANEL, _ROW, _AROUND = 1.65, 0.36, 0.95  # [in]
_FOR_NUMBERS = 15  # [pt] between the first panel and its title
_NARROW = 0.018  # of the time shown: a stage with less has no room for its number


def forces(attempt: Attempt, progress: Progress, expert: tuple[Attempt, Progress] | None = None) -> str:
    """Draw them as SVG.

    Args:
        attempt: whose forces.
        progress: of it.
        expert: another attempt at the same task, drawn thin behind, each stage stretched to the trainee's.
    """
    felt = attempt.forces
    hands = [hand for hand in (0, 1) if hand in hands_asked(progress) or felt[:, hand].max() > TOUCHING]
    stages = stages_of(attempt, progress)
    kinds = sorted({one.words for one in progress.mistakes})
    rows = len(kinds) * _ROW
    with page_sheet(_AROUND + _PANEL * len(hands) + (rows + 0.1 if kinds else 0.0)) as figure:
        ratios = [_PANEL] * len(hands) + ([rows] if kinds else [])
        panels = list(figure.subplots(len(ratios), 1, sharex=True, squeeze=False, height_ratios=ratios)[:, 0])
        numbered = len(stage_steps(progress.task)) > 1
        top = max(1.25 * attempt.force_limit, 1.1 * float(felt.max()))
        for hand, axes in zip(hands, panels, strict=False):
            _panel(axes, hand, attempt, stages, top, numbered=numbered and axes is panels[0])
            if expert is not None:
                times, values = _stretched(*expert, hand, stages)
                axes.plot(*thinned(times, values), color=EXPERT, linewidth=0.8, zorder=2.2)
        if numbered:
            _numbers(panels[0], stages, float(attempt.times[-1]))
        if kinds:
            _mistakes(panels[-1], kinds, progress)
        panels[-1].set_xlabel("time [s]")
        panels[-1].set_xlim(0.0, float(attempt.times[-1]))
        _legend(figure, hands, expert is not None)
        return svg_text(
            figure, "forces", "Force on each tip over time", _description(attempt, progress, hands)
        )


def _panel(
    axes: Axes, hand: int, attempt: Attempt, stages: list[Stretch], top: float, *, numbered: bool
) -> None:
    colour = HAND_COLOURS[hand]
    for stage in stages:
        least, most = stage.step.band(hand) or (0.0, 0.0)
        if most > 0:
            axes.fill_between(
                [stage.begin, stage.end], least, most, color=colour, alpha=0.2, linewidth=0, zorder=1
            )
        if stage.number > 1:
            axes.axvline(stage.begin, color=DIM, linewidth=0.5, alpha=0.7, zorder=1.5)
    axes.axhline(attempt.force_limit, color=LIMIT, linewidth=1.2, linestyle=(0, (5, 2)), zorder=2)
    axes.plot(*thinned(attempt.times, attempt.forces[:, hand]), color=colour, linewidth=1.2, zorder=3)
    beside(axes, attempt.force_limit, f"limit\n{attempt.force_limit:.2g} N", LIMIT)
    axes.set_ylim(0.0, top)
    axes.set_ylabel("force [N]")
    axes.set_title(f"{NAMES[hand].capitalize()} hand", color=colour, pad=_FOR_NUMBERS if numbered else 4)
    axes.grid(visible=False, axis="x")


def _numbers(axes: Axes, stages: list[Stretch], end: float) -> None:
    across = blended_transform_factory(axes.transData, axes.transAxes)
    axes.text(-0.008, 1.01, "step", transform=axes.transAxes, ha="right", va="bottom", color=DIM, fontsize=9)
    for stage in stages:
        if stage.end - stage.begin > _NARROW * end:
            axes.text(
                (stage.begin + stage.end) / 2,
                1.01,
                str(stage.number),
                transform=across,
                ha="center",
                va="bottom",
                color=DIM,
                fontsize=9,
            )


def _mistakes(axes: Axes, kinds: list[str], progress: Progress) -> None:
    """Draw a row for each kind of mistake: its words, and beneath a mark for each time."""
    across = blended_transform_factory(axes.transAxes, axes.transData)
    for row, words in enumerate(kinds):
        at = [one.time for one in progress.mistakes if one.words == words]
        line = row + 0.74
        axes.axhline(line, color=DIM, linewidth=0.5, alpha=0.5)
        axes.plot(
            at, [line] * len(at), "x", color=LIMIT, markersize=6, markeredgewidth=1.6, zorder=3, clip_on=False
        )
        often = "" if len(at) == 1 else f", {len(at)} times"
        axes.text(0.0, row + 0.5, f"{words}{often}", transform=across, ha="left", va="bottom", fontsize=9)
    axes.set_ylim(len(kinds) + 0.05, 0.0)
    axes.set_yticks([])
    axes.grid(visible=False)
    axes.spines["left"].set_visible(False)


def _legend(figure: Figure, hands: list[int], expert: bool) -> None:
    shade = HAND_COLOURS[hands[0]] if len(hands) == 1 else TEXT
    shown: list[Line2D | Patch] = [
        Line2D([], [], color=shade, linewidth=1.4, label="you"),
        Patch(color=shade, alpha=0.25, linewidth=0, label="what the step asks for"),
    ]
    if expert:
        shown.insert(1, Line2D([], [], color=EXPERT, linewidth=0.8, label="expert, stretched to your steps"))
    figure.legend(handles=shown, loc="outside upper right", ncols=len(shown), handlelength=1.6)


def _stretched(
    attempt: Attempt, progress: Progress, hand: int, stages: list[Stretch]
) -> tuple[FloatArray, FloatArray]:
    """Return another's force, each stage stretched to when the trainee's was."""
    times, values = [], []
    for theirs, ours in zip(stages_of(attempt, progress), stages, strict=False):
        inside = (attempt.times > theirs.begin) & (attempt.times <= theirs.end)
        share = (attempt.times[inside] - theirs.begin) / (theirs.end - theirs.begin)
        times.append(ours.begin + share * (ours.end - ours.begin))
        values.append(attempt.forces[inside, hand])
    return np.concatenate(times), np.concatenate(values)


def _description(attempt: Attempt, progress: Progress, hands: list[int]) -> str:
    most = " and ".join(
        f"{attempt.forces[:, hand].max():.2g} N with the {NAMES[hand]} hand" for hand in hands
    )
    return (
        f"In {seconds(attempt.duration)} the largest force was {most}; the limit is {attempt.force_limit:.2g} N. "
        f"{times_over(len(progress.mistakes), 'mistake')}."
    )
