"""The step of scissors, moment by moment, and that the scripted expert's cut parts the sheet."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from trocar.simulation import CUT, FORCE, OPENED, RECORD, TIP, TOUCH, TOUCH_PRESENT, TOUCH_TOUCHING
from trocar.simulation.kind import SHEET
from trocar.training.headless import attempt
from trocar.training.session import scene_of
from trocar.training.table import write_table
from trocar.training.tasks.catalogue import LEVELS, task
from trocar.training.tasks.moment import Moment
from trocar.waves.sheet.cut import cut_along
from trocar.waves.sheet.lattice import AHEAD, make_lattice, taut
from trocar.waves.sheet.sheet import Sheet

STEP = task("cut-along-the-line").steps[40]
PLACE = STEP.line.points[40]


def moment(*, at=STEP.ahead, height=0.0, force=0.01, opened=1.0, snip=None):
    records = np.zeros((2, RECORD))
    records[1, TIP : TIP + 3] = (*at, height)
    records[1, FORCE + 2], records[1, OPENED] = force, opened
    records[1, TOUCH] = TOUCH_PRESENT + (TOUCH_TOUCHING if force else 0)
    if snip is not None:
        records[1, CUT : CUT + 5] = (1.0, *snip[0], *snip[1])
    return Moment(1.0, records)


def beside(distance):
    """Return a snip along the line about the step's point, so far beside."""
    (x0, y0), (x1, y1) = STEP.line.points[36], STEP.line.points[44]
    along = np.subtract((x1, y1), (x0, y0)) / np.hypot(x1 - x0, y1 - y0)
    aside = distance * np.array([-along[1], along[0]])
    return tuple(np.add((x0, y0), aside)), tuple(np.add((x1, y1), aside))


def test_it_is_met_by_a_snip_near_by_and_wrong_by_one_beside():
    assert not STEP.met(moment())
    assert STEP.met(moment(snip=beside(1e-3)))
    assert STEP.mistake(moment(snip=beside(1e-3))) == ""
    assert not STEP.met(moment(snip=beside(2.1e-3)))
    assert STEP.mistake(moment(snip=beside(2.1e-3))) == "cut beside the line"
    assert STEP.mistake(moment()) == ""


@pytest.mark.parametrize(
    ("seen", "words"),
    [
        ({"opened": 0.0}, "Open the blades."),
        ({"at": (0.05, 0.05)}, "Go to where the cut ends, blades open."),
        ({"at": PLACE}, "On along the line, by a bite."),
        ({"force": 0.06}, "Softer."),
        ({"force": 0.0}, "Down, until it touches."),
        ({}, "Close the blades."),
    ],
)
def test_the_hint_says_what_is_next(seen, words):
    assert STEP.hint(moment(**seen)) == words


def test_the_line_bends_more_and_is_narrower_with_each_level():
    lines = [task("cut-along-the-line", level).line for level in LEVELS]
    turns = []
    for line in lines:
        ways = np.diff(line.points, axis=0)
        angles = np.unwrap(np.arctan2(ways[:, 1], ways[:, 0]))
        turns.append(float(np.abs(np.diff(angles)).sum()))
        assert np.hypot(*ways.T).max() < 4e-4
    assert turns[0] < 1e-9 < turns[1] < turns[2]
    assert [line.width for line in lines] == [2e-3, 1.5e-3, 1e-3]


@pytest.fixture(scope="module")
def done():
    """The scripted expert's attempt."""
    return attempt("cut-along-the-line", seed=2)


def test_the_card_of_a_cut_follows_from_its_table_alone(done, tmp_path):
    write_table(tmp_path / "attempt.csv", done.task, done.recording)
    (tmp_path / "card.json").write_text(json.dumps(done.card.as_dict()))
    recompute = Path(__file__).parents[3] / "bench" / "recompute_metrics.py"
    files = [str(tmp_path / name) for name in ("attempt.csv", "card.json")]
    found = subprocess.run(
        [sys.executable, "-I", str(recompute), *files], capture_output=True, text=True, check=False
    )
    assert found.returncode == 0, found.stdout + found.stderr
    assert all(f"\n{name} " in found.stdout for name in ("cut_deviation", "cut_deviation_most", "cut_share"))


def test_the_experts_cut_parts_the_sheet_along_the_line(done):
    scene = scene_of(done.task)
    state = SHEET.at_rest(scene)
    SHEET.play(scene, state, done.recording.poses, np.zeros((len(done.recording.poses), 2, RECORD)))
    n, h = scene.lattice.columns, scene.lattice.spacing
    (x0, y0), (x1, y1) = done.task.line.points[8], done.task.line.points[-8]
    along = np.subtract((x1, y1), (x0, y0)) / np.hypot(x1 - x0, y1 - y0)
    aside = np.array([-along[1], along[0]])
    gaps = []
    for share in np.linspace(0, 1, 9):
        middle = np.add((x0, y0), share * np.subtract((x1, y1), (x0, y0)))
        moved = []
        for side in (1, -1):
            i, j = np.rint((middle + side * 1.5 * h * aside) / h).astype(int)
            moved.append(float(state.lattice.places[:2, j * n + i] @ aside))
        gaps.append(moved[0] - moved[1])
    # Griffith's opening of so long a slit is 4.8 mm; frame and tension hold back some of it.
    assert min(gaps) > 3e-4
    assert 1.5e-3 < max(gaps) < 4.8e-3
    assert done.card.metrics["cut_share"] == 1.0
    assert done.card.metrics["cut_deviation"] < 2e-4
    assert done.card.metrics["cut_deviation_most"] < 8e-4  # the first snip begins before the line does
    assert hangs_together(scene.lattice, state.lattice, (x0, y0), (x1, y1)) == 0


def hangs_together(lattice, state, begin, end):
    """Return how many nodes right of a cut can still be reached from its left, past neither of its ends."""
    begin, end = np.array(begin), np.array(end)
    length = np.hypot(*(end - begin))
    along = (end - begin) / length
    near, beside = {}, 6e-3
    for at in range(len(lattice.free)):
        away = lattice.spacing * np.array([at % lattice.columns, at // lattice.columns]) - begin
        aside = along[0] * away[1] - along[1] * away[0]
        if 0 < away @ along < length and abs(aside) < beside:
            near[at] = aside
    reached = {at for at, aside in near.items() if aside > 0.5 * beside}
    assert reached
    held = {
        frozenset((at, at + dy * lattice.columns + dx))
        for way, (dx, dy) in enumerate(AHEAD)
        for at in near
        if state.whole[way, at] != 0.0 and at + dy * lattice.columns + dx in near
    }
    while more := {at for pair in held if pair & reached for at in pair - reached}:
        reached |= more
    return sum(near[at] < -0.5 * beside for at in reached)


def test_a_sheet_with_a_single_link_left_hangs_together():
    lattice = make_lattice(Sheet(), 1e-3)
    state = taut(lattice)
    ends = (0.012, 0.0293), (0.048, 0.0293)
    assert hangs_together(lattice, state, *ends) > 0
    cut_along(lattice, state, 0.01, 0.0293, 0.0292, 0.0293)
    cut_along(lattice, state, 0.0308, 0.0293, 0.05, 0.0293)
    assert hangs_together(lattice, state, *ends) > 0
    cut_along(lattice, state, 0.029, 0.0293, 0.031, 0.0293)
    assert hangs_together(lattice, state, *ends) == 0
