"""Say what recording costs the servo: the same hand with an attempt under way and without, in turns.

Prints how long ticks took and how many were missed in each, and what writing a tick's row costs by itself.
Run: python bench/recording.py [--seconds 20] [--rounds 3]
"""

from __future__ import annotations

import argparse
import os
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from numba import njit

sys.path.insert(0, str(Path(__file__).parent.parent / "tests"))

from trocar.realtime.shared import TRAIL, TRAIL_TICKS, Trail
from trocar.realtime.tracking import TrackState, absent
from trocar.realtime.trail import leave
from trocar.simulation import RECORD
from web.doomed_lesson import Trainer

TICKS = 1_000_000


@njit
def leave_often(trail: Trail, track: TrackState, records: np.ndarray, ticks: int) -> None:
    """Write so many rows."""
    for tick in range(ticks):
        leave(trail, False, tick, track, records)


def row_cost() -> float:
    """Return what a row costs [s], the least of five."""
    trail = Trail(written=np.zeros(1, np.int64), rows=np.zeros((TRAIL_TICKS, TRAIL)))
    track, records = absent(), np.zeros((2, RECORD))
    leave_often(trail, track, records, 10)
    found = []
    for _ in range(5):
        began = time.perf_counter()
        leave_often(trail, track, records, TICKS)
        found.append((time.perf_counter() - began) / TICKS)
    return min(found)


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--rounds", type=int, default=3)
    arguments = parser.parse_args()
    print(f"a row of the trail: {1e9 * row_cost():.0f} ns")
    seen = {"free": [], "recorded": []}
    with TemporaryDirectory(prefix="trocar-recording-") as folder:
        os.environ["TROCAR_DATA"] = folder
        trainer = Trainer(Path(folder))
        try:
            while trainer.newest is None:
                time.sleep(0.05)
            for _ in range(arguments.rounds):
                for what, found in seen.items():
                    if what == "recorded":
                        row = trainer.ask("POST", "/api/attempts", {"trainee": "Ada", "task": "palpate"})
                    first = trainer.newest
                    time.sleep(arguments.seconds)
                    last = trainer.newest
                    found.append(
                        (
                            last.tick - first.tick,
                            last.missed_ticks - first.missed_ticks,
                            last.tick_p50,
                            last.tick_p99,
                        )
                    )
                    if what == "recorded":
                        trainer.ask("POST", f"/api/attempts/{row['id']}/end", {})
                        time.sleep(2.0)  # it is being marked
        finally:
            trainer.close()
    for what, found in seen.items():
        ticks, missed = sum(each[0] for each in found), sum(each[1] for each in found)
        p50, p99 = (1e6 * np.median([each[k] for each in found]) for k in (2, 3))
        print(
            f"{what:9} {ticks} ticks, {missed} missed ({100 * missed / (ticks + missed):.3f} %), "
            f"median {p50:.0f} us, 99 % {p99:.0f} us"
        )


if __name__ == "__main__":
    main()
