"""Record scripted attempts at 250, 500 and 1000 Hz with sensor noise, and print which metrics change, and by how much.

Run: python bench/sensor_noise.py [--task NAME] [--seeds 2] [--um 20]. The noise is white, in each direction of both
tips; forces are the attempt's own, so what they do on a noisy way (work on tissue) is left out. Exits 1 if a length or
a jerk changes by more than 2 %; what a threshold decides (who moves, which movements count) may where it is small.
"""

from __future__ import annotations

import argparse
import sys
from dataclasses import replace
from math import inf

import numpy as np

from trocar.simulation import TIP
from trocar.training.headless import attempt
from trocar.training.metrics.attempt import Attempt
from trocar.training.metrics.measures import measured
from trocar.training.players import Skill
from trocar.training.session import replayed
from trocar.training.tasks.catalogue import TASKS

RATES = (250, 500, 1000)  # [Hz]
ALLOWED = 0.02
BOUND = (
    "path_length",
    "angular_path",
    "economy_of_motion",
    "depth_perception",
    "integrated_jerk",
    "log_dimensionless_jerk",
)


def recorded(motion: Attempt, rate: int, noise: float, rng: np.random.Generator) -> Attempt:
    """Return a motion of 1000 Hz as a sensor with noise [m] sees it at another rate."""
    step = 1000 // rate
    records = motion.records[::step].copy()
    records[:, :, TIP : TIP + 3] += rng.normal(0.0, noise, (*records.shape[:2], 3))
    return replace(motion, times=motion.times[::step], records=records)


def changes(motion: Attempt, rate: int, noise: float, rng: np.random.Generator) -> dict[str, float]:
    """Return by how much each metric changes, relative to what it was."""
    before, after = measured(motion), measured(recorded(motion, rate, noise, rng))
    return {
        name: abs(after[name] - value) / max(abs(value), 1e-9) if np.isfinite(after[name]) else inf
        for name, value in before.items()
        if name != "work_on_tissue" and np.isfinite(value)
    }


def main() -> int:
    """Run and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seeds", type=int, default=2)
    parser.add_argument("--um", type=float, default=20.0, help="root mean square of the noise")
    parser.add_argument("--task", choices=list(TASKS), action="append", help="all if not given")
    arguments = parser.parse_args()
    worst = dict.fromkeys(RATES, 0.0)
    decided: dict[str, float] = {}
    for name in arguments.task or TASKS:
        for skill in Skill:
            for seed in range(arguments.seeds):
                done = attempt(name, skill=skill, seed=seed)
                motion = replayed(done.task, done.recording)[0]
                for rate in RATES:
                    found = changes(motion, rate, 1e-6 * arguments.um, np.random.default_rng((seed, rate)))
                    three = sorted(found, key=lambda one: -found[one])[:3]
                    worst[rate] = max(worst[rate], *(found[metric] for metric in BOUND if metric in found))
                    for metric in found.keys() - set(BOUND):
                        decided[metric] = max(decided.get(metric, 0.0), found[metric])
                    print(
                        f"{name:14} {skill:6} seed {seed} at {rate:4} Hz: "
                        + ", ".join(f"{metric} {100 * found[metric]:.2f} %" for metric in three),
                        flush=True,
                    )
    for rate, change in worst.items():
        print(f"lengths and jerks at {rate:4} Hz: at most {100 * change:.2f} %, {100 * ALLOWED:g} % allowed")
    print("others, at most: " + ", ".join(f"{name} {100 * decided[name]:.2f} %" for name in sorted(decided)))
    return 0 if max(worst.values()) <= ALLOWED else 1


if __name__ == "__main__":
    sys.exit(main())
