"""The table of an attempt: what it says, how it is written, and that the card follows from it without this package."""

import ast
import csv
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from trocar.errors import InputError
from trocar.simulation import DT, HANDLE, TIP
from trocar.training.headless import attempt
from trocar.training.session import assess, replayed
from trocar.training.table import COLUMNS, attempt_table, write_table
from trocar.training.tasks.catalogue import task

RECOMPUTE = Path(__file__).parents[2] / "bench" / "recompute_metrics.py"


@pytest.fixture(scope="module", params=["palpate", "bimanual-hold"])
def written(request, tmp_path_factory):
    """A novice's attempt, its table and its card."""
    folder = tmp_path_factory.mktemp(request.param)
    done = attempt(request.param, skill="novice", seed=1)
    write_table(folder / "attempt.csv", done.task, done.recording)
    (folder / "card.json").write_text(json.dumps(done.card.as_dict()))
    return done, folder


def recompute(table, card):
    return subprocess.run(
        [sys.executable, "-I", str(RECOMPUTE), str(table), str(card)],
        capture_output=True,
        text=True,
        check=False,
    )


def test_the_card_follows_from_the_table_alone(written):
    done, folder = written
    asked = {
        (node.module or "") if isinstance(node, ast.ImportFrom) else node.names[0].name
        for node in ast.walk(ast.parse(RECOMPUTE.read_text()))
        if isinstance(node, ast.Import | ast.ImportFrom)
    }
    assert not [name for name in asked if name.split(".")[0] == "trocar"]
    found = recompute(folder / "attempt.csv", folder / "card.json")
    assert found.returncode == 0, found.stdout + found.stderr
    assert all(f"\n{name} " in found.stdout for name in done.card.metrics)
    assert "\n0 differ" in found.stdout


@pytest.mark.parametrize("written", ["palpate"], indirect=True)
@pytest.mark.parametrize(
    ("column", "more", "metrics"),
    [
        ("tip_x_m", 1e-3, ("path_length", "work_on_tissue")),
        ("force_z_n", 1e-3, ("peak_force", "impulse", "peak_stress_ratio", "work_on_tissue")),
        ("roll_rad", 1.0, ("angular_path",)),  # in one tick; the filter leaves a hundredth of it
        ("outside_m", 0.1, ("depth_perception",)),
        ("mistakes", 1.0, ("errors", "score")),
    ],
)
def test_a_changed_value_is_noticed(written, tmp_path, column, more, metrics):
    _, folder = written
    lines = (folder / "attempt.csv").read_text().splitlines()
    at = COLUMNS.index(column)
    number = (
        len(lines) - 2 if column == "mistakes" else _hardest(lines)
    )  # the last left one, or of the hardest press
    cells = lines[number].split(",")
    cells[at] = repr(float(cells[at]) * 1.5 + more)
    lines[number] = ",".join(cells)
    (tmp_path / "attempt.csv").write_text("\n".join(lines) + "\n")
    (tmp_path / "attempt.task.json").write_text((folder / "attempt.task.json").read_text())
    found = recompute(tmp_path / "attempt.csv", folder / "card.json")
    assert found.returncode == 1, found.stderr
    differing = {line.split()[0] for line in found.stdout.splitlines() if line.endswith("DIFFERS")}
    assert set(metrics) <= differing


def _hardest(lines):
    force = COLUMNS.index("force_z_n")
    return max(range(1, len(lines)), key=lambda number: float(lines[number].split(",")[force]))


def test_every_number_comes_back_as_it_was(written):
    done, folder = written
    attempted, progress = replayed(done.task, done.recording)
    with (folder / "attempt.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert tuple(rows[0]) == COLUMNS
    assert [row["instrument"] for row in rows[:4]] == ["left", "right"] * 2
    left = rows[::2]
    assert [float(row["time_s"]) for row in left] == attempted.times.tolist()
    assert [int(row["tick"]) for row in left] == list(range(1, len(attempted.times) + 1))
    assert [float(row["tip_y_m"]) for row in left] == attempted.records[:, 0, TIP + 1].tolist()
    ticks = len(attempted.times)
    assert [float(row["handle_z_m"]) for row in left] == done.recording.poses[:ticks, 0, HANDLE + 2].tolist()
    assert {int(row["touching"]) for row in rows} == {0, 1}
    assert progress.done
    assert int(left[-1]["mistakes"]) == len(progress.mistakes) == 1


def test_steps_are_counted_to_their_ends(written):
    done, _ = written
    _, progress = replayed(done.task, done.recording)
    table = attempt_table(done.task, done.recording)
    step = COLUMNS.index("step")
    numbers = np.array([row[step] for row in table.rows[::2]])
    assert sorted(set(numbers.tolist())) == list(range(1, len(done.task.steps) + 1))
    changes = np.flatnonzero(np.diff(numbers))
    assert (changes + 1) * DT == pytest.approx(
        progress.ended[:-1]
    )  # the tick in which a step ends belongs to it
    assert progress.ended[-1] == pytest.approx(len(numbers) * DT)


def test_an_attempt_that_ends_early_has_a_table_and_no_economy(tmp_path):
    done = attempt("palpate", seed=3)
    half = type(done.recording)(poses=done.recording.poses[: len(done.recording.poses) // 2])
    beside = write_table(tmp_path / "half.csv", done.task, half)
    constants = json.loads(beside.read_text())
    assert beside.name == "half.task.json"
    assert not constants["completed"]
    (tmp_path / "card.json").write_text(json.dumps(assess(done.task, half).as_dict()))
    found = recompute(tmp_path / "half.csv", tmp_path / "card.json")
    assert found.returncode == 0, found.stdout + found.stderr


def test_what_is_no_place_for_a_table_is_refused_and_nothing_is_left(tmp_path):
    recording = attempt("palpate", seed=3).recording
    for place in (tmp_path, tmp_path / "card.json"):
        with pytest.raises(InputError, match="a name for a CSV file"):
            write_table(place, task("palpate"), recording)
    assert list(tmp_path.iterdir()) == []
