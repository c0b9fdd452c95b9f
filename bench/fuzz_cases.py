"""Throw thousands of broken case files at the loader and count what it made of them.

Run: python bench/fuzz_cases.py [--cases 5000] [--seed 1]. Exits 1 on any exception but a refusal.
"""

import argparse
import sys
from collections import Counter
from pathlib import Path
from tempfile import TemporaryDirectory

from hypothesis import HealthCheck, given, seed, settings

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

from study.cases.broken_cases import BROKEN, outcome


def main() -> int:
    """Run and print the counts."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cases", type=int, default=5000)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    counts: Counter[str] = Counter()

    with TemporaryDirectory() as folder:

        @seed(arguments.seed)
        @settings(
            max_examples=arguments.cases,
            deadline=None,
            database=None,
            suppress_health_check=list(HealthCheck),
        )
        @given(BROKEN)
        def throw(content: bytes) -> None:
            counts[outcome(content, Path(folder))] += 1

        try:
            throw()
        except Exception as error:  # noqa: BLE001 - any exception at all is the finding
            print(f"after {counts.total()} files: {type(error).__name__}: {error}")
            print("\n".join(getattr(error, "__notes__", [])))
            return 1
    accepted, refused = counts["accepted"], counts["refused"]
    print(f"{counts.total()} files: {accepted} accepted, {refused} refused, 0 other exceptions")
    return 0


if __name__ == "__main__":
    sys.exit(main())
