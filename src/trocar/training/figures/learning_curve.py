"""The score of every attempt at a task, in order, with the pass mark and where proficiency was reached."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.ticker import MaxNLocator

from trocar.errors import InputError
from trocar.training.figures.page import DIM, LIMIT, SCORE, TEXT, beside, page_sheet, svg_text, times_over
from trocar.training.practice import proficient

_HEIGHT = 2.9  # [in]


def learning_curve(
    scores: Sequence[float],
    passed: Sequence[bool],
    *,
    pass_score: float,
    in_a_row: int = 2,
    besides: int = 0,
) -> str:
    """Draw it as SVG.

    Args:
        scores: of each attempt, in order; there may be none.
        passed: likewise.
        pass_score: the pass mark.
        in_a_row: passes one after the other that proficiency asks for, as in `practice.proficient`.
        besides: further passes, likewise.

    Raises:
        InputError: not as many scores as passes.
    """
    if len(scores) != len(passed):
        raise InputError("learning curve: passed", f"{len(scores)}, one for each score", len(passed))
    count = len(scores)
    numbers, values, right = (
        np.arange(1, count + 1),
        np.asarray(scores, dtype=float),
        np.asarray(passed, dtype=bool),
    )
    reached = proficient(passed, in_a_row=in_a_row, besides=besides)
    size = 6.5 if count <= 40 else 4.5
    with page_sheet(_HEIGHT) as figure:
        axes = figure.subplots()
        axes.plot(numbers, values, color=DIM, linewidth=0.9, zorder=2)
        axes.plot(numbers[right], values[right], "o", color=SCORE, markersize=size, label="passed", zorder=3)
        axes.plot(
            numbers[~right],
            values[~right],
            "x",
            color=LIMIT,
            markersize=size,
            markeredgewidth=1.6,
            label="not passed",
            zorder=3,
        )
        axes.axhline(pass_score, color=TEXT, linewidth=1.1, linestyle=(0, (5, 2)), zorder=1.5)
        axes.set_xlim(0.5, max(count, 10) + 0.5)
        beside(axes, pass_score, f"pass mark\n{pass_score:g}", TEXT)
        axes.set_ylim(-4.0, max(108.0, 1.05 * float(values.max(initial=0.0))))
        if reached is not None:
            late = reached > 0.6 * max(count, 10)
            axes.axvline(reached, color=SCORE, linewidth=1.1, linestyle=(0, (1.5, 1.5)), zorder=1.6)
            axes.annotate(
                f"proficient with attempt {reached}",
                (reached, 0.0),
                xycoords=("data", "axes fraction"),
                xytext=(-5 if late else 5, 4),
                textcoords="offset points",
                ha="right" if late else "left",
                va="bottom",
                fontsize=9,
                color=SCORE,
            )
        if count:
            figure.legend(loc="outside upper right", ncols=2, handletextpad=0.3)
        else:
            axes.text(
                0.5, 0.45, "no attempt yet", transform=axes.transAxes, ha="center", color=DIM, fontsize=11
            )
        axes.set_xlabel("attempt")
        axes.set_ylabel("score")
        axes.xaxis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1))
        axes.grid(visible=False, axis="x")
        return svg_text(
            figure,
            "learning-curve",
            "Score of each attempt",
            _description(values, right, pass_score, reached),
        )


def _description(values: np.ndarray, right: np.ndarray, pass_score: float, reached: int | None) -> str:
    if not len(values):
        return "No attempt yet."
    skilled = f"Proficient with attempt {reached}." if reached is not None else "Not proficient yet."
    return (
        f"{times_over(len(values), 'attempt')}, {int(right.sum())} passed; the first scored {values[0]:.0f}, the last "
        f"{values[-1]:.0f}, the best {values.max():.0f}, the pass mark is {pass_score:g}. {skilled}"
    )
