"""Print every table of the study's third leg, measured tissue, without the rest of the study.

Run: python bench/measured.py DIR [--figures OUT]. DIR holds the sets as sub-folders; OUT takes the figures as SVG.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

from rich.console import Console
from rich.table import Table as Shown

from trocar.study.measured.leg import run_leg
from trocar.study.measured.sets import read_sets
from trocar.study.report.measured_section import measured_parts, measured_pictures


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("data", type=Path, help="folder of the sets")
    parser.add_argument("--figures", type=Path, help="folder for the figures")
    arguments = parser.parse_args()
    began = time.process_time()

    def watch(what: str, share: float) -> None:
        print(f"{100 * share:3.0f} % {what}", file=sys.stderr)

    leg = run_leg(read_sets(arguments.data), watch)
    console = Console(width=150, highlight=False)
    for part in measured_parts(leg):
        for table in part.tables:
            shown = Shown(
                title=table.caption, title_justify="left", caption=table.note, caption_justify="left"
            )
            for column, name in enumerate(table.head):
                shown.add_column(name, justify="right" if column in table.numeric else "left")
            for row in table.rows:
                shown.add_row(*row)
            console.print(shown, "")
    for sentence in leg.sets.missing:
        console.print(sentence)
    console.print(f"processor time {time.process_time() - began:.0f} s, by the clock {leg.seconds:.0f} s")
    if arguments.figures is not None:
        arguments.figures.mkdir(parents=True, exist_ok=True)
        for name, picture in measured_pictures(leg).items():
            (arguments.figures / f"{name}.svg").write_text(picture.svg, encoding="utf-8")
            picture.figure.savefig(arguments.figures / f"{name}.png", dpi=130)


if __name__ == "__main__":
    main()
