"""Where linear elasticity ends: tissues as neo-Hookean solids in CalculiX, and the criterion there.

    python bench/linear_range.py [--jobs 2] [--only skin] [--per-radius 3]

A row is a tissue, a support, a tool in the middle of a block of 60 x 60 mm. "3 %" is the smallest force [N]
at which the largest deflection of some layer, per newton, differs by 3 % from the same mesh's at next to no
force; the layer and the sign follow. Then come the measures of `trocar.study.linear_range` at that force,
from linear finite elements; the force the criterion would allow, and its share of the 3 % force: above 1 the
criterion lets through what it should not. The last columns are the smallest stretch and layer height at
about the 3 % force: the neo-Hookean law must not itself be pushed beyond reason.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from functools import partial
from math import nan
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent.parent / "tests"))

import trocar
from reference.neo_hookean import NeoHookeanBlock, Pressed
from trocar.model import Press, Support
from trocar.reference import FEASolid
from trocar.study.linear_range import AGREEMENT, LinearRange, linear_range
from trocar.tissues import Layer, Tissue

SIZE = (0.06, 0.06)
PAPER_FORCE = 5.0  # [N], what the 2014 paper presses with
DEFLECTION_SHARES = (5e-4, 4e-3, 8e-3, 0.014, 0.022, 0.035, 0.05, 0.07, 0.095, 0.13, 0.18, 0.25)
"""Linear deflection over thickness at the forces that are run; at the first, both laws agree."""

HELD_OUT = (  # name, fat [m], support, tool [m]; run only once the thresholds were fixed
    ("firm", 8e-3, Support.BASE, 6e-3),
    ("firm", 14e-3, Support.EDGES_AND_BASE, 4e-3),
    ("firm", 7e-3, Support.EDGES, 6e-3),
    ("slack", 8e-3, Support.EDGES_AND_BASE, 6e-3),
    ("slack", 14e-3, Support.BASE, 4e-3),
    ("slack", 7e-3, Support.EDGES, 10e-3),
    ("tran", 7e-3, Support.EDGES, 6e-3),
    ("mid", 7e-3, Support.BASE, 12e-3),
)

MODULI = {  # of fat, dermis, epidermis [Pa]
    "mid": (5e3, 2e5, 1e6),
    "soft": (2e3, 3.5e4, 5e5),
    "stiff": (2e4, 1e6, 1e6),
    "tran": (2.5e3, 6.66e6, 7.2e5),  # Tran et al.: C10 of a forearm by imaging and indentation, E = 6 C10
    "firm": (1e4, 2e6, 5e5),
    "slack": (3e3, 1.5e4, 2e5),
}


@dataclass(frozen=True, kw_only=True)
class Case:
    """One row."""

    tissue: Tissue
    support: Support
    diameter: float


@dataclass(frozen=True, kw_only=True)
class Row:
    """What came out; `force` is NaN where the 3 % were not reached."""

    case: Case
    force: float
    layer: str
    sign: str
    criterion: LinearRange
    pressed: Pressed

    @property
    def allowed(self) -> float:
        """The criterion's force limit over the 3 % force, or over the largest force run."""
        return self.criterion.force_limit / (self.force if self.force == self.force else self.pressed.force)


def literature(name: str, fat: float) -> Tissue:
    """Return three layers with moduli from the ends and the middle of what is published; fat [m]."""
    thickness = {"epidermis": 1e-4, "dermis": 1e-3, "fat": fat}
    moduli = dict(zip(("fat", "dermis", "epidermis"), MODULI[name], strict=True))
    return Tissue(
        name=f"{name}, fat {1e3 * fat:.0f} mm",
        layers=tuple(
            Layer(
                name=key, thickness=thickness[key], young_modulus=moduli[key], poisson_ratio=0.49, density=1e3
            )
            for key in thickness
        ),
    )


def cases() -> Iterator[Case]:
    """List the rows."""
    for name in ("skin", "liver", "silicone-pad"):
        for support in (Support.BASE, Support.EDGES_AND_BASE):
            for diameter in (5e-3, 8e-3):
                yield Case(tissue=trocar.tissue(name), support=support, diameter=diameter)
        yield Case(tissue=trocar.tissue(name), support=Support.EDGES, diameter=8e-3)
    for name in ("stomach-wall", "uterus"):
        yield Case(tissue=trocar.tissue(name), support=Support.BASE, diameter=8e-3)
    for name in ("mid", "soft", "stiff", "tran"):
        for fat in (5e-3, 10e-3, 20e-3):
            for diameter in (5e-3, 8e-3):
                yield Case(tissue=literature(name, fat), support=Support.BASE, diameter=diameter)
        yield Case(tissue=literature(name, 10e-3), support=Support.EDGES_AND_BASE, diameter=5e-3)
        yield Case(tissue=literature(name, 20e-3), support=Support.EDGES_AND_BASE, diameter=8e-3)
        yield Case(tissue=literature(name, 10e-3), support=Support.EDGES, diameter=8e-3)
    for name, fat, support, diameter in HELD_OUT:
        tissue = replace(literature(name, fat), name=f"held out: {name}, fat {1e3 * fat:.0f} mm")
        yield Case(tissue=tissue, support=support, diameter=diameter)


def measured(case: Case, per_radius: float) -> Row:
    """Run one row with so many elements along the tool's radius."""
    press = Press(x=SIZE[0] / 2, y=SIZE[1] / 2, radius=case.diameter / 2, force=1.0)
    linear = FEASolid(case.tissue, size=SIZE, support=case.support, around=(press,), solver="superlu")
    criterion = linear_range(linear, case.tissue, (press,))
    share = criterion.deflection_share
    block = NeoHookeanBlock(
        tissue=case.tissue, size=SIZE, support=case.support, radius=press.radius, per_radius=per_radius
    )
    with tempfile.TemporaryDirectory() as folder:
        steps = block.pressed(tuple(wished / share for wished in DEFLECTION_SHARES), Path(folder))
    compliance = np.array([step.deflection for step in steps]) / np.array([[step.force] for step in steps])
    parted = compliance / compliance[0] - 1
    worst = np.abs(parted).max(axis=1)
    beyond = np.flatnonzero(worst > AGREEMENT)
    at = int(beyond[0]) if len(beyond) else len(steps) - 1
    force = nan
    if len(beyond):
        before, after = steps[at - 1].force, steps[at].force
        force = before + (after - before) * (AGREEMENT - worst[at - 1]) / (worst[at] - worst[at - 1])
    which = int(np.abs(parted[at]).argmax())
    return Row(
        case=case,
        force=float(force),
        layer=case.tissue.layer_names[which],
        sign="+" if parted[at, which] > 0 else "-",
        criterion=criterion,
        pressed=steps[at],
    )


def line(row: Row) -> str:
    """Write a row of the table in Markdown."""
    force = row.force if row.force == row.force else row.pressed.force
    beyond = f"{force:.3g}" if row.force == row.force else f"> {force:.3g}"
    one = row.criterion  # at 1 N
    return (
        f"| {row.case.tissue.name} | {row.case.support} | {1e3 * row.case.diameter:.0f} | {beyond} "
        f"| {row.layer} {row.sign} | {force * one.strain:.3f} | {force * one.deflection_share:.3f} "
        f"| {force * one.slope:.3f} | {force**2 * one.stretching:.3f} | {one.force_limit:.3g} "
        f"| {one.limiting.replace('_', ' ')} "
        f"| {row.allowed:.2f} | {row.pressed.stretch:.2f} | {row.pressed.height:.2f} |"
    )


def main() -> None:
    """Print the table, and how often the criterion misjudges."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--only", default="", help="rows whose tissue's name contains this")
    parser.add_argument("--per-radius", type=float, default=2.0, help="elements along the tool's radius")
    arguments = parser.parse_args()
    chosen = [case for case in cases() if arguments.only in case.tissue.name]
    print("| tissue | support | tool mm | 3 % at N | first in | strain | share | slope | stretching ", end="")
    print("| limit N | by | limit / 3 % | stretch | height |")
    print("|---|---|---|---|---|---|---|---|---|---|---|---|---|---|")
    rows = []
    with ProcessPoolExecutor(arguments.jobs) as pool:
        for row in pool.map(partial(measured, per_radius=arguments.per_radius), chosen):
            rows.append(row)
            print(line(row), flush=True)
    reached = [row for row in rows if row.force == row.force]
    allowed = np.array([row.allowed for row in reached])
    print(f"\n{len(rows)} cases, {len(reached)} of them reach 3 %.")
    print(f"called inside though beyond 3 %: {int((allowed > 1).sum())}")
    print(f"called outside though a force twice as large is within 3 %: {int((allowed < 0.5).sum())}")
    print(f"limit / 3 %: median {np.median(allowed):.2f}, {allowed.min():.2f} to {allowed.max():.2f}")
    skins = [row for row in rows if "fat" in row.case.tissue.layer_names]
    if skins:
        shares = [PAPER_FORCE * row.criterion.deflection_share for row in skins]
        print(f"at {PAPER_FORCE:g} N linear theory deflects skin by {min(shares):.1f} to", end=" ")
        print(f"{max(shares):.1f} times its thickness")
    insane = [row.case.tissue.name for row in rows if not row.pressed.sane]
    print(f"states beyond reason (stretch or height below 0.3, volume ratio below 0.8): {insane or 'none'}")


if __name__ == "__main__":
    main()
