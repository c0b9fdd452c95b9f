"""Press rigid tips of random cases, most of them extreme, and count what the wave models made of them.

Run: python bench/fuzz_rigid.py [--cases 60] [--seed 1]. Exits 1 on any exception but a refusal, and on a deflection
that is negative or not a number.
"""

import argparse
import sys
from collections import Counter

import numpy as np

from trocar.errors import InputError, TrocarError
from trocar.model import Support
from trocar.study.cases.experiment import Case, case_from_tissue
from trocar.study.cases.tool import Contact, Tip, Tool
from trocar.study.compare import compare
from trocar.tissues import Layer, Tissue


def main() -> int:
    """Run and print the counts."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--cases", type=int, default=60)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    rng = np.random.default_rng(arguments.seed)
    counts: Counter[str] = Counter()
    while counts["cases"] < arguments.cases:
        try:
            case = random_case(rng)
        except InputError:
            counts["refused when made"] += 1
            continue
        counts["cases"] += 1
        for model in ("wave-solid", "wave-membrane"):
            try:
                depths = np.array(list(compare(case, (model,))[model].deflection.values()))
            except TrocarError as refusal:
                counts[f"{model}: {str(refusal)[:60]}"] += 1
                continue
            if not (np.isfinite(depths).all() and (depths >= 0).all()):
                print(f"{model}: deflections {depths} of {case}")
                return 1
            counts[f"{model}: pressed"] += 1
    print("\n".join(f"{count:5d} {what}" for what, count in counts.items()))
    return 0


def random_case(rng: np.random.Generator) -> Case:
    """Return one or two rigid tips, flat or round, on one to three layers over seven decades of stiffness and force."""
    side = 10 ** rng.uniform(-2.5, -0.3)
    layers = tuple(
        Layer(
            name=f"layer {i}",
            thickness=side * 10 ** rng.uniform(-3, -0.3),
            young_modulus=10 ** rng.uniform(2.5, 7),
            poisson_ratio=float(rng.choice([0.0, 0.3, 0.48, 0.4999])),
            density=1000.0,
            prestress_x=float(rng.choice([0.0, 1e4])),
            prestress_y=float(rng.choice([0.0, 2e4])),
        )
        for i in range(rng.integers(1, 4))
    )
    diameters = side * 10 ** rng.uniform(-2.9, -0.4, rng.integers(1, 3))
    tools = tuple(
        Tool(
            diameter=float(d),
            position=(rng.uniform(d / 2, side - d / 2), rng.uniform(d / 2, side - d / 2)),
            peak=10 ** rng.uniform(-5, 2),
            rate=10 ** rng.uniform(-2, 1),
            tip=Tip(rng.choice(list(Tip))),
            contact=Contact.RIGID,
        )
        for d in diameters
    )
    return case_from_tissue(
        tissue=Tissue(layers=layers),
        size=(side, side * rng.uniform(0.5, 1)),
        tools=tools,
        support=Support(rng.choice(list(Support))),
        period=max(tool.duration for tool in tools) / 3,
    )


if __name__ == "__main__":
    sys.exit(main())
