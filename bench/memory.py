"""Waves that remember beside finite elements that do: creep, relaxation and hysteresis of examples/creep.toml.

    python bench/memory.py [--figure docs/_static/memory.png] [--organ]

Every layer has a Prony series of its own. The models are those of `compare`, without inertia, under the case's tool;
finite elements on their default mesh. Errors are relative to theirs, the largest at any time; a loop's error is that of
the energy lost. "two steps" is how far one step differs from two of half the length, "poles" the nearest to the
imaginary axis and the farthest [1/s], of the moving waves of `WaveSolid`; none may be to the right of it. The
line after it is the swing under a half sine of 20 ms, with inertia, where series relax within milliseconds too. With
`--organ` follows what memory costs `WaveMesh`, in a liver with a nodule whose series is another.
"""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path
from time import process_time

import numpy as np

from trocar import tissue
from trocar.model import Press
from trocar.reference.fea import FEASolid
from trocar.study.cases.reading import load_case
from trocar.study.half_sine import half_sine
from trocar.study.memory_protocols import creep, hysteresis, relaxation
from trocar.study.models import COARSE_MESH, MODELS
from trocar.study.report.figures.memory import memory_figure
from trocar.study.report.figures.style import settings
from trocar.tissues import Tissue
from trocar.waves.mesh.block import block_mesh, lines_around
from trocar.waves.mesh.inclusion import with_inclusion
from trocar.waves.mesh.organ import Liver
from trocar.waves.mesh.wave_mesh import WaveMesh
from trocar.waves.solid import WaveSolid

CASE = Path(__file__).parents[1] / "examples" / "creep.toml"
DEPTH = 1e-4  # [m] held
FIRST, LAST = 0.01, 300.0  # [s] a fifth of the shortest relaxation time, five times the longest
RATES = (0.5, 0.05, 0.005)  # [N/s]
STEPS = 1000
SHOWN = (0.0, 0.08, 0.96, 10.0, 60.0, 300.0)  # [s]


def protocols(figure: Path | None) -> None:
    """Print creep, relaxation and hysteresis."""
    case = load_case(CASE)
    press = case.tools[0].press(case.tools[0].peak)
    names = ("fea", "wave-solid", "wave-membrane", "wave-mesh")
    creeps, relaxations, loops, spent = {}, {}, {}, {}
    for name in names:
        began = process_time()
        model = MODELS[name](case)
        creeps[name] = creep(model, press, first=FIRST, last=LAST)
        relaxations[name] = relaxation(model, press, DEPTH, first=FIRST, last=LAST)
        loops[name] = {rate: hysteresis(model, press, rate=rate) for rate in RATES}
        spent[name] = process_time() - began
    fea = creeps["fea"]
    at = [int(np.abs(fea.time - time).argmin()) for time in SHOWN]
    times = " | ".join(f"{fea.time[i]:.3g} s" for i in at)
    for title, curves, scale in (("creep / um", creeps, 1e6), ("relaxation / mN", relaxations, 1e3)):
        print(f"| {title} | {times} | largest error |\n|---|{'---|' * (len(at) + 1)}")
        for name, curve in curves.items():
            values = curve.deflection if curves is creeps else curve.force
            truth = fea.deflection if curves is creeps else relaxations["fea"].force
            error = np.abs(values / truth - 1).max()
            cells = " | ".join(f"{scale * values[i]:.4g}" for i in at)
            print(f"| {name} | {cells} | {100 * error:.2f} % |")
        print()
    print("| energy lost | " + " | ".join(f"{rate:g} N/s" for rate in RATES) + " | largest error | CPU s |")
    print(f"|---|{'---|' * (len(RATES) + 2)}")
    for name, own in loops.items():
        error = max(abs(own[rate].lost / loops["fea"][rate].lost - 1) for rate in RATES)
        cells = " | ".join(f"{100 * own[rate].share_lost:.2f} %" for rate in RATES)
        print(f"| {name} | {cells} | {100 * error:.2f} % | {spent[name]:.1f} |")
    if figure is not None:
        drawn = [{name: of[name] for name in names[:3]} for of in (creeps, relaxations, loops)]
        with settings():
            memory_figure(*drawn).savefig(figure, dpi=160)
        print(f"\n{figure}: {figure.stat().st_size / 1000:.0f} kB")


def exactness() -> None:
    """Print what is exact to rounding."""
    case = load_case(CASE)
    model = WaveSolid(case.tissue, size=case.size, modes=(48, 48))
    load, none = case.load_at(case.corners()[1]), case.load_at(0.0)
    where = np.array([[*case.tools[0].position, 0.0]])
    half = tuple(press.with_force(0.5 * press.force) for press in load)
    apart = 0.0
    for dt in (1e-3, 0.1, 20.0):
        once = model.step(model.init(), none, load, dt)
        twice = model.step(model.step(model.init(), none, half, dt / 2), half, load, dt / 2)
        one, other = (model.displacement(state, where) for state in (once, twice))
        apart = max(apart, np.abs(one / other - 1).max())
    poles = np.linalg.eigvals(model.oscillators_wv.matrices)
    sizes = np.abs(poles[poles != 0])
    print(f"\ntwo steps: {apart:.1e}; poles: real parts up to {poles.real[poles != 0].max():.2e},", end=" ")
    print(f"sizes {sizes.min():.2e} to {sizes.max():.2e}, {poles.shape[1]} blocks a wavenumber")


def swing() -> None:
    """Print the half sine."""
    layers = load_case(CASE).tissue.layers
    quick = (((0.5, 0.002), (1.0, 5.0)), ((0.8, 0.01),), ((1.0, 0.005), (0.4, 60.0)))
    fast = Tissue(layers=tuple(replace(a, prony=b) for a, b in zip(layers, quick, strict=True)))
    press = Press(x=0.03, y=0.03, radius=0.004, force=0.1)
    size = (0.06, 0.06)
    models = {
        "fea": FEASolid(fast, size=size, support="base", around=(press,), mesh=COARSE_MESH),
        "wave-solid": WaveSolid(fast, size=size, modes=(64, 64)),
        "wave-mesh": WaveMesh(block_mesh(fast, lines_around(fast, size, (press,)))),
    }
    curves = half_sine(models, press)
    print()
    for name in models:
        curve = curves[name]
        error = np.abs(curve - curves["fea"]).max() / curves["fea"].max()
        peak = f"{1e3 * curve.max():.4f} mm"
        print(
            f"half sine of 20 ms: {name} peaks at {peak}, differs by {100 * error:.2f} % of the peak at most"
        )


def organ() -> None:
    """Print what memory costs an organ of two series."""
    liver = tissue("liver").layers[-1]
    solid = with_inclusion(
        Liver().mesh(liver, spacing=0.016),
        centre=(0.12, 0.06, -0.03),
        radii=(0.015, 0.015, 0.015),
        layer=replace(liver, name="nodule", young_modulus=10 * liver.young_modulus),
    )
    series = {
        "none": ((), ()),
        "one of three times": (((0.5, 0.05), (0.4, 1.0), (0.3, 20.0)),) * 2,
        "two of three times": (((0.5, 0.05), (0.4, 1.0), (0.3, 20.0)), ((0.8, 0.05), (0.2, 20.0))),
    }
    press = Press(x=0.12, y=0.045, radius=4e-3, force=0.2)
    print("\n| series | unknowns | modes, s | a press, s | blocks | a step, us |\n|" + "---|" * 6)
    for name, own in series.items():
        materials = tuple(replace(one, prony=terms) for one, terms in zip(solid.materials, own, strict=True))
        model = WaveMesh(replace(solid, materials=materials))
        marks = [process_time()]
        _ = model.frequencies
        marks.append(process_time())
        state = model.static((press,))
        marks.append(process_time())
        for _ in range(STEPS):
            state = model.step(state, (press,), (press,), 1e-3)
        marks.append(process_time())
        modes, pressed, stepped = np.diff(marks)
        blocks = state.oscillators[0].shape[1]
        print(
            f"| {name} | {model.dofs} | {modes:.1f} | {pressed:.1f} | {blocks} | "
            f"{1e6 * stepped / STEPS:.0f} |",
            flush=True,
        )


def main() -> None:
    """Print the tables; draw the figure where asked."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--figure", type=Path, default=None, help="a file to draw the protocols into")
    parser.add_argument("--organ", action="store_true", help="also what memory costs an organ")
    arguments = parser.parse_args()
    protocols(arguments.figure)
    exactness()
    swing()
    if arguments.organ:
        organ()


if __name__ == "__main__":
    main()
