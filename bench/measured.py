"""Print every table of the study's third leg, measured tissue, without the rest of the study.

Run: python bench/measured.py DIR [--figures OUT], or python bench/measured.py --disc. DIR holds the sets as
sub-folders; OUT takes the figures. --disc needs no data: how far the bonded disc's force depends on mesh and bulk
modulus, and how its stiffness compares with Gent and Lindley's shape factor.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table as Shown

from trocar.reference.cylinder import Cylinder
from trocar.study.measured.leg import run_leg
from trocar.study.measured.sets import read_sets
from trocar.study.report.measured_section import measured_parts, measured_pictures
from trocar.tissues.law import NeoHookean


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("data", type=Path, nargs="?", help="folder of the sets")
    parser.add_argument("--disc", action="store_true", help="refine the bonded disc instead")
    parser.add_argument("--figures", type=Path, help="folder for the figures")
    arguments = parser.parse_args()
    if arguments.disc:
        refine_disc()
    if arguments.data is not None:
        foretell(arguments.data, arguments.figures)


def refine_disc() -> None:
    """Print the bonded disc's force over mu and radius squared, and its stiffness beside the shape factor's."""
    strains = np.array([0.1, 0.3, 0.45, 0.6, 0.66])
    print(
        "force / (mu R^2) of the phantoms' disc, neo-Hookean, at",
        *(f"{100 * strain:.0f} %" for strain in strains),
    )
    for elements, bulk in (((6, 4), 1e3), ((10, 7), 1e3), ((6, 4), 4e3)):
        disc = Cylinder(
            radius=25,
            height=30,
            law=NeoHookean(),
            shear_modulus=1.0,
            bulk_modulus=bulk,
            bonded=True,
            elements=elements,
        )
        curve = disc.press(strains)
        forces = " ".join(f"{force:8.4f}" for force in curve.force / 25**2)
        print(
            f"{elements[0]} x {elements[1]} elements, K = {bulk:4.0f} mu: {forces}  {curve.stopped}",
            flush=True,
        )
    for shape_factor in (25 / 60, 1.0, 2.5, 5.0):
        disc = Cylinder(
            radius=2 * shape_factor,
            height=1.0,
            law=NeoHookean(),
            shear_modulus=1.0,
            bulk_modulus=1e6,
            bonded=True,
            elements=(16, 6),
        )
        apparent = disc.linear_stiffness / (np.pi * disc.radius**2) / 3
        print(
            f"shape factor {shape_factor:.3f}: apparent over Young's modulus {apparent:.3f}, "
            f"1 + 2 S^2 = {1 + 2 * shape_factor**2:.3f}"
        )


def foretell(data: Path, figures: Path | None) -> None:
    """Print the tables of the sets and draw their figures."""
    began = time.process_time()

    def watch(what: str, share: float) -> None:
        print(f"{100 * share:3.0f} % {what}", file=sys.stderr)

    leg = run_leg(read_sets(data), watch)
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
    if figures is not None:
        figures.mkdir(parents=True, exist_ok=True)
        for name, picture in measured_pictures(leg).items():
            (figures / f"{name}.svg").write_text(picture.svg, encoding="utf-8")


if __name__ == "__main__":
    main()
