"""Let the scripted expert and novice do every task with many seeds, and print their scores.

Run: python bench/skills.py [--seeds 20] [--level 1] [--task NAME]. Exits 1 if the novice is ever as good as the expert.
"""

from __future__ import annotations

import argparse
import sys

import numpy as np

from trocar.training.headless import attempt
from trocar.training.players import Skill
from trocar.training.tasks.catalogue import TASKS


def main() -> int:
    """Run and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--level", type=int, default=1)
    parser.add_argument("--task", choices=list(TASKS), action="append", help="all if not given")
    arguments = parser.parse_args()
    worse = True
    for name in arguments.task or TASKS:
        found = {skill: [] for skill in Skill}
        for seed in range(arguments.seeds):
            for skill in Skill:
                found[skill].append(attempt(name, level=arguments.level, skill=skill, seed=seed).card)
            print(f"\r{name}: {seed + 1} of {arguments.seeds} seeds", end="", file=sys.stderr, flush=True)
        print(file=sys.stderr)
        expert, novice = ([card.score for card in found[skill]] for skill in Skill)
        better = all(one > other for one, other in zip(expert, novice, strict=True))
        worse = worse and better
        times = [np.median([card.duration for card in found[skill]]) for skill in Skill]
        print(
            f"{name:14} expert {min(expert):5.1f} to {max(expert):5.1f} in {times[0]:4.1f} s, "
            f"{sum(card.passed for card in found[Skill.EXPERT])} passed; "
            f"novice {min(novice):5.1f} to {max(novice):5.1f} in {times[1]:4.1f} s, "
            f"{sum(card.passed for card in found[Skill.NOVICE])} passed; "
            f"{'expert always better' if better else 'EXPERT NOT ALWAYS BETTER'}",
            flush=True,
        )
    return 0 if worse else 1


if __name__ == "__main__":
    sys.exit(main())
