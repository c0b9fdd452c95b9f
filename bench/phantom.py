"""Write the synthetic records in examples/: a pad pressed in finite elements, with noise from a seed.

    python bench/phantom.py [--out examples]

The waves have no part in these: `FEASolid` on its default mesh gives the largest deflection of both layers' upper
faces and the markers' displacements, `numpy` the noise. `phantom.csv` and `phantom-markers.csv` are of one press up and
down, `phantom-again.csv` is a second press of the same pad at another rate, and `phantom-hold.csv` a ramp that is held
while the body creeps. The truth stands in each file's first lines. Prints what was written.
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path

import numpy as np

from trocar.reference.fea import FEASolid
from trocar.study.cases.experiment import Case
from trocar.study.cases.reading import load_case
from trocar.study.deflection import deflections, search_points
from trocar.tissues import Tissue

EXAMPLES = Path(__file__).parents[1] / "examples"
SKIN, BODY = 60e3, 12e3  # [Pa] the truth
PRONY = ((0.6, 4.0),)  # of the body that remembers: (g, tau [s])
FORCE_NOISE, DEPTH_NOISE, MARKER_NOISE = 3e-4, 4e-6, 1e-5  # [N], [m], [m], standard deviations
MARKERS = 1e-3 * np.array([5.5, 7.0, 9.0, 12.0, 16.0])  # [m] from the tool's axis, on both axes
MARKER_EVERY = 8  # rows
MM = 1e3


@dataclass(frozen=True, kw_only=True)
class Truth:
    """What finite elements say of a press, without noise.

    Attributes:
        time: [s], shape (n,).
        force: [N], shape (n,).
        depths: of skin and body [m], shape (2, n).
        places: of the markers [m], shape (k, 3).
        markers: u_z of each at each time [m], shape (k, n).
    """

    time: np.ndarray
    force: np.ndarray
    depths: np.ndarray
    places: np.ndarray
    markers: np.ndarray


def true_tissue(case: Case, *, remembers: bool) -> Tissue:
    """Return the case's layers with the true moduli."""
    skin, body = case.tissue.layers
    return Tissue(
        layers=(
            replace(skin, young_modulus=SKIN),
            replace(body, young_modulus=BODY, prony=PRONY if remembers else ()),
        )
    )


def truth(case: Case, *, remembers: bool, rate: float = 1.0) -> Truth:
    """Press the true pad in finite elements; `rate` stretches the time axis of an elastic one."""
    tissue = true_tissue(case, remembers=remembers)
    model = FEASolid(tissue, size=case.size, support=case.support, around=case.load_at(0.0), massless=True)
    tool = case.tools[0]
    last = tool.corners()[2] if remembers else case.duration
    count = round(last / case.sampling.period)
    time = np.linspace(0.0, last, count + 1)
    force = np.array([tool.force(float(t)) for t in time])
    points = search_points(case.size, case.load_at(0.0))
    x, y = tool.position
    places = np.array([[x + r, y, 0.0] for r in MARKERS] + [[x, y + r, 0.0] for r in MARKERS])
    if not remembers:
        state = model.static((tool.press(1.0),))
        depths = deflections(model, state, points, tissue.layer_names).max(axis=1)
        sunk = model.displacement(state, places)[:, 2]
        return Truth(
            time=time / rate,
            force=force,
            depths=np.outer(depths, force),
            places=places,
            markers=np.outer(sunk, force),
        )
    state, depths, sunk = model.init(), [np.zeros(2)], [np.zeros(len(places))]
    for f0, f1 in pairwise(force):
        state = model.step(state, (tool.press(f0),), (tool.press(f1),), float(time[1]))
        depths.append(deflections(model, state, points, tissue.layer_names).max(axis=1))
        sunk.append(model.displacement(state, places)[:, 2])
    return Truth(time=time, force=force, depths=np.array(depths).T, places=places, markers=np.array(sunk).T)


def head(what: str, seed: int, *, remembers: bool) -> str:
    """Return a file's first lines."""
    memory = f", prony [[{PRONY[0][0]:g}, {PRONY[0][1]:g}]]" if remembers else ""
    return (
        f"# SYNTHETIC: {what}, by finite elements (bench/phantom.py), not measured. Truth: skin {SKIN / 1e3:g} kPa, "
        f"body {BODY / 1e3:g} kPa{memory}.\n"
        f"# Normal noise, seed {seed}: force {1e3 * FORCE_NOISE:g} mN, depth {1e6 * DEPTH_NOISE:g} um, markers "
        f"{1e6 * MARKER_NOISE:g} um.\n"
    )


def write(place: Path, text: str) -> None:
    """Write a file and say so."""
    place.write_text(text, encoding="utf-8")
    print(f"{place.name}: {len(text.splitlines())} lines")


def record(found: Truth, what: str, seed: int, *, remembers: bool, offset: float) -> str:
    """Return a record of force and depth as CSV; the displacement's zero is off by `offset` [m]."""
    noise = np.random.default_rng(seed)
    force = found.force + noise.normal(0.0, FORCE_NOISE, len(found.time))
    depth = found.depths[0] + offset + noise.normal(0.0, DEPTH_NOISE, len(found.time))
    rows = [f"{t:.3f},{f:.5f},{MM * d:.4f}" for t, f, d in zip(found.time, force, depth, strict=True)]
    head_ = head(what, seed, remembers=remembers)
    return head_ + "\n".join(["time_s,force_n,displacement_mm", *rows]) + "\n"


def marker_record(found: Truth, seed: int) -> str:
    """Return the markers as CSV."""
    noise = np.random.default_rng(seed)
    rows = [
        f"{found.time[i]:.3f},{MM * x:.2f},{MM * y:.2f},{MM * (u + noise.normal(0.0, MARKER_NOISE)):.4f}"
        for i in range(MARKER_EVERY // 2, len(found.time), MARKER_EVERY)
        for (x, y, _), u in zip(found.places, found.markers[:, i], strict=True)
    ]
    head_ = head("markers of phantom.csv", seed, remembers=False)
    return head_ + "\n".join(["time_s,x_mm,y_mm,uz_mm", *rows]) + "\n"


def main() -> None:
    """Write the files."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=EXAMPLES, help="folder")
    out = parser.parse_args().out
    case = load_case(EXAMPLES / "phantom.toml")
    found = truth(case, remembers=False)
    write(out / "phantom.csv", record(found, "a press up and down", 1, remembers=False, offset=2e-5))
    write(out / "phantom-markers.csv", marker_record(found, 2))
    again = truth(case, remembers=False, rate=2.0)
    write(
        out / "phantom-again.csv",
        record(again, "a second press, twice as fast", 3, remembers=False, offset=-1e-5),
    )
    held = truth(load_case(EXAMPLES / "phantom-hold.toml"), remembers=True)
    write(out / "phantom-hold.csv", record(held, "a ramp that is held", 4, remembers=True, offset=0.0))


if __name__ == "__main__":
    main()
