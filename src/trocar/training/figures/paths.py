"""The ways of both tips over the tissue, seen from above, with the task's marks."""

from __future__ import annotations

from itertools import groupby

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Circle

from trocar.contact.instrument import NAMES
from trocar.model import FloatArray
from trocar.simulation import TIP
from trocar.training.figures.page import (
    BACKGROUND,
    EXPERT,
    HALO,
    HAND_COLOURS,
    HAND_STYLES,
    TEXT,
    page_sheet,
    svg_text,
)
from trocar.training.figures.stages import stage_steps
from trocar.training.metrics.attempt import Attempt
from trocar.training.tasks.progress import Progress
from trocar.training.tasks.step import Mark
from trocar.training.tasks.task import Task
from trocar.units import MILLIMETRE

_HEIGHT = 4.7  # [in]
_MARGIN = 3e-3  # [m] around the block
_STEP = 1e-4  # [m]; nearer points of a way are not drawn: a tenth of a line's width
_WORDS = 2.5  # [mm] around a number that is room enough
_SIDES = np.pi / 180 * np.array([45, 0, 90, 135, 180, -45, -135, -90, 22, 68, 112, 158, -158, -112, -68, -22])


def paths(attempt: Attempt, progress: Progress, expert: tuple[Attempt, Progress] | None = None) -> str:
    """Draw them as SVG.

    Args:
        attempt: whose ways.
        progress: of it.
        expert: another attempt at the same task, drawn faint beneath.
    """
    with page_sheet(_HEIGHT) as figure:
        axes = figure.subplots()
        width, depth = (side / MILLIMETRE for side in progress.task.size)
        if expert is not None:
            for hand in range(2):
                for way, _ in _ways(expert[0], hand):
                    axes.plot(
                        *way, color=EXPERT, linestyle=HAND_STYLES[hand], linewidth=0.8, alpha=0.7, zorder=1.5
                    )
        _draw_marks(axes, progress.task, attempt)
        for hand in range(2):
            _draw_way(axes, attempt, hand)
        around = _MARGIN / MILLIMETRE
        axes.set_xlim(-around, width + around)
        axes.set_ylim(-around, depth + around)
        axes.set_aspect("equal")
        axes.set_anchor("W")
        axes.grid(visible=False)
        for side, at, length in (
            ("left", 0, depth),
            ("right", width, depth),
            ("bottom", 0, width),
            ("top", depth, width),
        ):
            axes.spines[side].set_visible(True)
            axes.spines[side].set_position(("data", at))
            axes.spines[side].set_bounds(0, length)
        axes.set_xlabel("to the right [mm]")
        axes.set_ylabel("away from you [mm]")
        axes.set_xticks(np.arange(0, width + 1, 10))
        axes.set_yticks(np.arange(0, depth + 1, 10))
        axes.legend(
            handles=_entries(attempt, expert),
            loc="upper left",
            bbox_to_anchor=(1.02, 1.0),
            labelspacing=0.7,
            handlelength=2.4,
        )
        return svg_text(figure, "paths", "Ways of both tips, seen from above", _description(attempt, expert))


def _ways(attempt: Attempt, hand: int) -> list[tuple[FloatArray, bool]]:
    """Return the parts of a tip's way [mm], shape (2, n), and whether it touched the tissue meanwhile."""
    here, touching = attempt.present[:, hand], attempt.touching[:, hand]
    places = attempt.records[:, hand, TIP : TIP + 2] / MILLIMETRE
    kinds = (here.astype(int) + touching).tolist()  # 0 away, 1 over the tissue, 2 on it
    found, first = [], 0
    for kind, run in groupby(kinds):
        after = first + sum(1 for _ in run)
        if kind:
            found.append((_coarse(places[first : min(after + 1, len(places))]), kind == 2))
        first = after
    return found


def _coarse(places: FloatArray) -> FloatArray:
    """Return places at least a step apart, the first and the last among them, shape (2, n)."""
    kept, last = [0], places[0].tolist()
    for number, (x, y) in enumerate(places.tolist()):
        if max(abs(x - last[0]), abs(y - last[1])) > _STEP / MILLIMETRE:
            kept.append(number)
            last = (x, y)
    return np.asarray(places[[*kept, len(places) - 1]].T, dtype=np.float64)


def _draw_way(axes: Axes, attempt: Attempt, hand: int) -> None:
    colour = HAND_COLOURS[hand]
    ways = _ways(attempt, hand) if NAMES[hand] in attempt.tips else []
    for way, touches in ways:
        axes.plot(
            *way,
            color=colour,
            linestyle="-" if touches else HAND_STYLES[hand],
            linewidth=2.6 if touches else 1.1,
            alpha=1.0 if touches else 0.85,
            zorder=3 if touches else 2.5,
        )
    if ways:
        axes.plot(*ways[0][0][:, 0], "D", color=BACKGROUND, markeredgecolor=colour, markersize=4.5, zorder=4)


def _draw_marks(axes: Axes, task: Task, attempt: Attempt) -> None:
    """Draw each mark once, with the numbers of all stages it is for, and a line that is followed as a line."""
    numbers: dict[Mark, list[int]] = {}
    for number, marks in enumerate(_marks_by_stage(task), 1):
        if len(marks) > 2:
            line = np.array([mark.place for mark in marks]).T / MILLIMETRE
            axes.plot(
                *line,
                color=HAND_COLOURS[marks[0].hand],
                linewidth=9,
                alpha=0.16,
                solid_capstyle="round",
                zorder=1,
            )
            continue
        for mark in marks:
            numbers.setdefault(mark, []).append(number)
    for mark in numbers:
        x, y, radius = (value / MILLIMETRE for value in (*mark.place, mark.radius))
        axes.add_patch(Circle((x, y), radius, facecolor=HAND_COLOURS[mark.hand], alpha=0.13, zorder=1))
        axes.add_patch(
            Circle(
                (x, y),
                radius,
                fill=False,
                edgecolor=HAND_COLOURS[mark.hand],
                linewidth=1.0,
                linestyle=HAND_STYLES[mark.hand],
                zorder=1.2,
            )
        )
    for mark, place in _places_of_words(list(numbers), attempt).items():
        axes.text(
            place[0],
            place[1],
            _ranges(numbers[mark]),
            color=TEXT,
            fontsize=9,
            ha="center",
            va="center",
            path_effects=HALO,
            zorder=5,
        )


def _places_of_words(marks: list[Mark], attempt: Attempt) -> dict[Mark, FloatArray]:
    """Return where each mark's words go [mm]: just outside it, on the side where least else is."""
    crowd = [np.array(mark.place) / MILLIMETRE for mark in marks]
    for hand, name in enumerate(NAMES):
        if name in attempt.tips:
            crowd += [place for way, _ in _ways(attempt, hand) for place in way.T[::10]]
    found: dict[Mark, FloatArray] = {}
    for mark in marks:
        middle, radius = np.array(mark.place) / MILLIMETRE, mark.radius / MILLIMETRE
        others = np.array([*crowd, *found.values()])
        rings = [other for other in marks if other.place != mark.place]

        def room(place: FloatArray, others: FloatArray = others, rings: list[Mark] = rings) -> float:
            free = float(np.linalg.norm(others - place, axis=1).min())
            edges = [
                abs(float(np.hypot(*(np.array(ring.place) / MILLIMETRE - place))) - ring.radius / MILLIMETRE)
                for ring in rings
            ]
            return min(free, *edges, _WORDS) if edges else min(free, _WORDS)

        around = [middle + (radius + 1.7) * np.array([np.cos(angle), np.sin(angle)]) for angle in _SIDES]
        found[mark] = max(around, key=room)
    return found


def _marks_by_stage(task: Task) -> list[tuple[Mark, ...]]:
    return [task.steps[steps.start].marks for steps in stage_steps(task)]


def _ranges(numbers: list[int]) -> str:
    """Return [1, 2, 3, 5] as "1–3, 5"."""
    runs = [
        [number for _, number in run]
        for _, run in groupby(enumerate(numbers), lambda each: each[1] - each[0])
    ]
    return ", ".join(str(run[0]) if len(run) == 1 else f"{run[0]}–{run[-1]}" for run in runs)


def _entries(attempt: Attempt, expert: tuple[Attempt, Progress] | None) -> list[Line2D]:
    shown = []
    for hand, name in enumerate(NAMES):
        far = _far(attempt, name)
        if far is None:
            label = f"{name}: not used"
        else:
            theirs = None if expert is None else _far(expert[0], name)
            label = f"{name}: {far:.0f} mm" + ("" if theirs is None else f"\n(expert {theirs:.0f} mm)")
        shown.append(
            Line2D([], [], color=HAND_COLOURS[hand], linestyle=HAND_STYLES[hand], linewidth=1.1, label=label)
        )
    shown.append(Line2D([], [], color=TEXT, linewidth=2.6, label="thick: touching"))
    if expert is not None:
        shown.append(Line2D([], [], color=EXPERT, linewidth=0.8, label="expert's way"))
    shown.append(
        Line2D(
            [],
            [],
            color=TEXT,
            marker="D",
            markersize=4.5,
            markerfacecolor="none",
            linestyle="none",
            label="where it began",
        )
    )
    shown.append(
        Line2D(
            [],
            [],
            color=TEXT,
            marker="o",
            markersize=9,
            markerfacecolor="none",
            linestyle="none",
            label="mark, with its steps",
        )
    )
    return shown


def _far(attempt: Attempt, name: str) -> float | None:
    return attempt.tips[name].length() / MILLIMETRE if name in attempt.tips else None


def _description(attempt: Attempt, expert: tuple[Attempt, Progress] | None) -> str:
    ways = [
        f"the {name} tip went {far:.0f} mm"
        + (
            f" (the expert's {theirs:.0f} mm)"
            if expert is not None and (theirs := _far(expert[0], name)) is not None
            else ""
        )
        for name in NAMES
        if (far := _far(attempt, name)) is not None
    ]
    return f"Seen from above, {' and '.join(ways) or 'no tip moved'}."
