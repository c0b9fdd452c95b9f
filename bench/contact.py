"""Print what the live contact keeps to: energy, quiet after a stop, static answers, penetration, sliding.

Run: python bench/contact.py [--trajectories 10000] [--share 1.0] [--seed 0]. Exits 1 if a figure misses its bound.
"""

import argparse
import sys

from trocar.study.contact.figures import contact_figures, contact_table


def main() -> int:
    """Run and print the table."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--trajectories", type=int, default=10_000)
    parser.add_argument("--share", type=float, default=1.0, help="of the trajectories; CI runs 0.02")
    parser.add_argument("--seed", type=int, default=0)
    arguments = parser.parse_args()
    wanted = max(1, round(arguments.share * arguments.trajectories))

    def tell(done: int) -> None:
        if done % max(1, wanted // 100) == 0:
            print(f"\r{done} of {wanted} trajectories", end="", file=sys.stderr, flush=True)

    figures = contact_figures(wanted, seed=arguments.seed, tell=tell)
    print(file=sys.stderr)
    print(contact_table(figures))
    return 0 if all(figure.kept for figure in figures) else 1


if __name__ == "__main__":
    sys.exit(main())
