"""A CUSUM chart of passes and failures, with its limits in words."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from trocar.model import FloatArray
from trocar.training.figures.page import DIM, HALO, LIMIT, SCORE, TEXT, page_sheet, svg_text, times_over
from trocar.training.practice import Cusum

_HEIGHT = 3.6  # [in]
_NEAR_LEFT = 0.25  # of the width: room for words


def cusum(failed: Sequence[bool], chart: Cusum | None = None) -> str:
    """Draw it as SVG.

    Args:
        failed: each attempt, in order; there may be none.
        chart: for which rates; `Cusum()` by default.
    """
    rates = chart or Cusum()
    heights = np.concatenate([[0.0], rates.chart(failed)])
    count = len(failed)
    numbers = np.arange(count + 1)
    alarm = np.minimum.accumulate(heights) + rates.alarm
    proof = np.maximum.accumulate(heights) - rates.proof
    alarmed, proved = rates.alarm_after(failed), rates.proof_after(failed)
    wrong = np.concatenate([[False], np.asarray(failed, dtype=bool)])
    size = 6.0 if count <= 40 else 4.0
    with page_sheet(_HEIGHT) as figure:
        axes = figure.subplots()
        end = max(count, 10) + 0.5
        axes.set_xlim(0.0, end)
        for limit, crossed, colour, style, words in (
            (
                alarm,
                alarmed,
                LIMIT,
                (0, (5, 2)),
                f"up to here: fails too often, {rates.unacceptable:.0%} or more",
            ),
            (proof, proved, SCORE, (0, (1.5, 1.5)), f"down to here: fails {rates.acceptable:.0%} at most"),
        ):
            last = count if crossed is None else crossed  # a limit that is crossed has answered
            till = [*numbers[: last + 1].tolist(), *([end] if crossed is None else [])]
            height = [*limit[: last + 1].tolist(), *([float(limit[-1])] if crossed is None else [])]
            axes.step(till, height, where="post", color=colour, linewidth=1.3, linestyle=style, label=words)
        axes.plot(numbers, heights, color=TEXT, linewidth=1.0, zorder=2)
        marks: dict[str, Any] = {"linestyle": "none", "markersize": size, "zorder": 3}
        right = ~wrong & (numbers > 0)
        axes.plot(
            numbers[right], heights[right], marker="o", color=SCORE, label="passed: a little down", **marks
        )
        axes.plot(
            numbers[wrong],
            heights[wrong],
            marker="x",
            color=LIMIT,
            markeredgewidth=1.6,
            label="not passed: far up",
            **marks,
        )
        for number, words, colour in ((alarmed, "alarm", LIMIT), (proved, "proof", SCORE)):
            if number is not None:
                _ring(
                    axes,
                    number,
                    heights[number],
                    f"{words}: attempt {number}",
                    colour,
                    rising=words == "alarm",
                )
        axes.margins(y=0.1)
        if not count:
            axes.text(
                0.5,
                0.5,
                "no attempt yet",
                transform=axes.transAxes,
                ha="center",
                va="bottom",
                color=DIM,
                fontsize=11,
            )
        figure.legend(loc="outside upper left", ncols=2, columnspacing=2.0)
        axes.set_xlabel("attempt")
        axes.set_ylabel("CUSUM of failures")
        axes.xaxis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1))
        axes.grid(visible=False, axis="x")
        return svg_text(
            figure,
            "cusum",
            "CUSUM chart of passes and failures",
            _description(heights, wrong, rates, alarmed, proved),
        )


def _ring(axes: Axes, number: int, height: float, words: str, colour: str, *, rising: bool) -> None:
    """Ring a point and write beside it, away from the curve; near an end, towards the middle."""
    share = number / axes.get_xlim()[1]
    right = share < _NEAR_LEFT or (not rising and share < 1 - _NEAR_LEFT)
    below = right == rising
    axes.plot(
        number,
        height,
        "o",
        color="none",
        markeredgecolor=colour,
        markersize=13,
        markeredgewidth=1.4,
        zorder=4,
    )
    axes.annotate(
        words,
        (number, height),
        xytext=(9 if right else -9, -12 if below else 12),
        textcoords="offset points",
        ha="left" if right else "right",
        va="center",
        fontsize=9,
        color=colour,
        path_effects=HALO,
        zorder=5,
    )


def _description(
    heights: FloatArray, wrong: np.ndarray, rates: Cusum, alarmed: int | None, proved: int | None
) -> str:
    count = len(heights) - 1
    if not count:
        return "No attempt yet."
    said = []
    if alarmed is not None:
        said.append(f"attempt {alarmed} raised the alarm that {rates.unacceptable:.0%} or more fail")
    if proved is not None:
        said.append(f"attempt {proved} showed that {rates.acceptable:.0%} at most fail")
    return (
        f"{times_over(count, 'attempt')}, {int(wrong.sum())} not passed; the chart stands at {heights[-1]:.2f}: "
        f"{' and '.join(said) or 'neither limit is reached'}."
    )
