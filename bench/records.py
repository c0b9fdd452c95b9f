"""Fill records with attempts and print how large the file is and how long a list and a history take to read.

Run: python bench/records.py [--attempts 1000] [--bytes 1470000] [--folder DIR]. The folder must be new; without one, a
temporary one is taken and removed. The bytes are random, so that nothing could have made them smaller.
"""

from __future__ import annotations

import argparse
import os
import sys
import time
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory

from trocar.records.learning import IN_A_ROW
from trocar.records.store import Records
from trocar.training.figures.cusum import cusum
from trocar.training.figures.learning_curve import learning_curve
from trocar.training.metrics.measures import MEASURES
from trocar.training.session import Card

PIECES = 10  # of a recording
ROUNDS = 7  # of reading; the median counts
DT = 1e-3  # [s]


def main() -> int:
    """Fill, read and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--attempts", type=int, default=1000)
    parser.add_argument("--bytes", type=int, default=1_470_000)
    parser.add_argument("--folder", type=Path)
    arguments = parser.parse_args()
    with TemporaryDirectory(prefix="trocar-records-") as temporary:
        folder = arguments.folder or Path(temporary)
        if (folder / "records.db").exists():
            parser.error(f"{folder} has records already; name another folder")
        _fill(folder, arguments.attempts, arguments.bytes)
        size = (folder / "records.db").stat().st_size
        print(f"{arguments.attempts} attempts of {arguments.bytes} bytes: {size / 1e6:.1f} MB")
        print(f"list of all attempts: {1e3 * _seconds(folder, lambda one: one.attempts()):.1f} ms")
        print(
            f"history of one trainee: {1e3 * _seconds(folder, lambda one: one.history('Anna', 'lift')):.1f} ms"
        )
        drawn = _seconds(folder, _history_as_the_page_asks)
        print(
            f"history of one trainee, attempts and both pictures, as the page opens it: {1e3 * drawn:.0f} ms"
        )
    return 0


def _history_as_the_page_asks(records: Records) -> None:
    history = records.history("Anna", "lift")
    records.attempts("Anna", "lift", 1)
    cusum([not one for one in history.passed], history.cusum)
    learning_curve(
        [row.score or 0.0 for row in history.rows], history.passed, pass_score=75.0, in_a_row=IN_A_ROW
    )


def _fill(folder: Path, attempts: int, size: int) -> None:
    card = Card(
        task="lift",
        level=1,
        score=80.0,
        passed=True,
        completed=True,
        duration=30.0,
        metrics={measure.name: 0.5 for measure in MEASURES},
        mistakes=(),
        advice=("Go straight.",),
    )
    with Records.open(folder) as records:
        anna = records.trainee("Anna")
        for count in range(attempts):
            number = records.begin(anna, task="lift", level=1, device="simulated expert", header={}, dt=DT)
            for _ in range(PIECES):
                records.add(number, os.urandom(max(size // PIECES, 1)), 3000)
            records.finish(number, card)
            print(f"\r{count + 1} of {attempts} attempts", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)


def _seconds(folder: Path, ask) -> float:
    """Return how long it takes to open the records, ask and close them: the median of several times [s]."""
    taken = []
    for _ in range(ROUNDS):
        begin = time.perf_counter()
        with Records.open(folder, writing=False) as records:
            ask(records)
        taken.append(time.perf_counter() - begin)
    return median(taken)


if __name__ == "__main__":
    sys.exit(main())
