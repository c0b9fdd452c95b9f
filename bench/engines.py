"""Print accuracy against cost of soft bodies of other engines, beside our own models on the same block in the same run.

    python bench/engines.py [--block pad] [--case static] [--engines mujoco,newton] [--figure engines.png] [--json]

Cases, errors and references are those of `trocar bench models`. The blocks have no prestress, which no engine knows:
`pad`, one layer, and `skin`, the preset without its prestress; 60 x 60 mm under a flat tool of 8 mm, base held. Engines
hold the sides too, where ours let them slide along their normal; "held sides" says how much that moves. Engines have no
small strain: they are pressed with a small share of the force, and the answer is scaled. They have no equilibria
either: an error is that of the state in which they come to rest, a simulated second is as many steps as it has.

Costs are CPU times over that of finite elements with one element a radius. Needs `trocar[engines]`; without any engine
it exits 2. A case takes some minutes of processor time, large forces more;
`--quick` takes the coarsest of each.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Iterator, Sequence
from dataclasses import replace
from importlib.util import find_spec
from itertools import chain
from math import log
from pathlib import Path

from engine_rungs import ENGINES, MARKS, Rung
from engine_trials import engine_points, held_sides, steps

from trocar.study.cost.accuracy import CASES, DYNAMIC, LARGE, STATIC, Point, climb, trial_of
from trocar.study.cost.warm_up import compile_models
from trocar.study.report.figures.accuracy import accuracy_figure
from trocar.study.report.figures.style import settings
from trocar.study.stiffening import Dent
from trocar.tissues import Layer, Tissue
from trocar.tissues.catalogue import tissue
from trocar.whole_file import whole

OURS = ("wave-solid", "fea")
RUNGS = {STATIC: 5, DYNAMIC: 5, LARGE: 2}  # the coarsest of each
UNIT = ("fea", "1 elements a radius")  # whose cost is 1

BLOCKS = {
    "pad": Tissue(
        name="pad",
        layers=(
            Layer(
                name="pad",
                thickness=0.01,
                young_modulus=1e4,
                poisson_ratio=0.48,
                density=1000.0,
                loss_factor=0.14,
            ),
        ),
    ),
    "skin": Tissue(
        name="skin without prestress",
        layers=tuple(replace(layer, prestress_x=0.0, prestress_y=0.0) for layer in tissue("skin").layers),
    ),
}


def tabulate(points: Sequence[Point]) -> str:
    """Return the table, costs over that of the unit in the same case."""
    lines = ["| case | model | setting | unknowns | error | cost |", "|---|---|---|---|---|---|"]
    for case in CASES:
        own = [point for point in points if point.case == case]
        unit = next((point.second_s for point in own if (point.model, point.setting) == UNIT), None)
        for point in own:
            if point.error is None:
                lines.append(f"| {case} | {point.model} | {point.setting} | | {point.failure} | |")
                continue
            cost = f"{point.second_s / unit:.3g}" if unit else f"{point.second_s:.3g} s"
            lines.append(
                f"| {case} | {point.model} | {point.setting} | {point.dofs} | {100 * point.error:.2g} % | {cost} |"
            )
    return "\n".join(lines)


def orders(points: Sequence[Point]) -> Iterator[str]:
    """Yield the order of each model's error between its two finest, a length being unknowns to the power -1/3."""
    for case, model in dict.fromkeys((point.case, point.model) for point in points):
        own = [
            (point.error, point.dofs)
            for point in points
            if (point.case, point.model) == (case, model) and point.error
        ]
        if len(own) > 1 and own[-1][1] > own[-2][1]:
            (coarse, few), (fine, many) = own[-2:]
            yield f"{case}, {model}: order {3 * log(coarse / fine) / log(many / few):.1f}"


def main(argv: Sequence[str] | None = None) -> int:
    """Print the tables; draw the figure where asked."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--block", choices=tuple(BLOCKS), default="pad")
    parser.add_argument(
        "--poisson", type=float, default=None, help="Poisson's ratio of every layer; default: its own"
    )
    parser.add_argument("--case", choices=CASES, action="append", help="may be repeated; default: all")
    parser.add_argument("--engines", default=",".join(ENGINES), help="of " + ", ".join(ENGINES))
    parser.add_argument("--figure", type=Path, default=None, help="a file.png, .svg or .pdf")
    parser.add_argument("--steps", action="store_true", help="how the time step counts, and no more")
    parser.add_argument("--quick", action="store_true", help="the coarsest of each alone")
    parser.add_argument("--json", action="store_true", help="print JSON alone")
    choice = parser.parse_args(argv)
    wanted = choice.engines.split(",")
    if unknown := [name for name in wanted if name not in ENGINES]:
        parser.error(f"--engines: expected some of {', '.join(ENGINES)}, got {unknown[0]}")
    missing = [name for name in wanted if find_spec(name) is None]
    for name in missing:
        print(
            f"{name} is not installed: expected trocar[engines] (pip install 'trocar[engines]')",
            file=sys.stderr,
        )
    if missing == wanted:
        return 2
    block = BLOCKS[choice.block]
    if choice.poisson is not None:
        block = replace(
            block, layers=tuple(replace(layer, poisson_ratio=choice.poisson) for layer in block.layers)
        )
    dent = Dent(name=choice.block, tissue=block)
    rungs = [rung for name in wanted if name not in missing for rung in ENGINES[name]()]
    if choice.quick:
        rungs = [rung for i, rung in enumerate(rungs) if rung.engine not in {one.engine for one in rungs[:i]}]
    if choice.steps:
        swinging = trial_of(DYNAMIC, dent)
        for name in dict.fromkeys(rung.engine for rung in rungs if DYNAMIC in rung.cases):
            for line in steps(swinging, next(rung for rung in rungs if rung.engine == name)):
                print(line, flush=True)
        return 0
    points = run(dent, choice.case or CASES, rungs, quick=choice.quick)
    if choice.figure is not None:
        with settings(), whole(choice.figure) as partial_file:
            accuracy_figure(points, MARKS).savefig(
                partial_file, dpi=160, format=choice.figure.suffix.removeprefix(".")
            )
    if choice.json:
        print(json.dumps([point.as_dict() for point in points], indent=2, allow_nan=False))
        return 0
    print(f"{dent.tissue.name}: held sides move the static answer by {100 * held_sides(dent):.2g} %")
    print(tabulate(points))
    print("\n".join(orders(points)))
    return 0


def run(dent: Dent, cases: Sequence[str], rungs: Sequence[Rung], *, quick: bool) -> list[Point]:
    """Run our models and the engines, telling of each on standard error."""
    compile_models()
    points = []
    for case in cases:
        trial = trial_of(case, dent)
        own = (climb(trial, model, rungs=2 if quick else RUNGS[case]) for model in OURS)
        for point in chain(*own, engine_points(trial, rungs)):
            points.append(point)
            print(
                f"{point.case}: {point.model}, {point.setting} {point.error} {point.second_s:.3g}",
                file=sys.stderr,
            )
    return points


if __name__ == "__main__":
    sys.exit(main())
