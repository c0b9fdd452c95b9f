"""Waves that stiffen beside hyperelastic finite elements, their one fitted number, their energy and their order.

    python bench/stiffening.py fit|check|energy|order [--steps N] [--dt S] [--fine]

fit     the share of the derived membrane moduli with the least largest error over the cases it is fitted on, up to a
        third of the block's thickness, and the best share of every case by itself
check   errors of waves with the fitted share, of waves with the derived moduli and of linear ones on cases that were
        not fitted, the presets liver and skin among them, and the forces at which each leaves 5 and 10 %
energy  kinetic, elastic and stretching energy of undamped waves let go from a deep dent, over N steps of S seconds
        (0.1, 1 and 10 ms): the most it ever stood above its start, relative
order   how the error of a step falls with its length

Every layer is neo-Hookean, the load dead and the tool flat; a case is a block's sides, layers and tool. Finite elements
are those of `compare --quick`; with --fine the default mesh.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence

import numpy as np

from trocar.model import FloatArray, Support
from trocar.study.models import COARSE_MESH
from trocar.study.stiffening import Dent, error, leaves, linear_waves, reference_curve, wave_curve
from trocar.tissues import Layer, Tissue
from trocar.tissues.catalogue import tissue as preset
from trocar.waves.membrane import WaveMembrane
from trocar.waves.solid import WaveSolid
from trocar.waves.state import WaveState
from trocar.waves.stretch.moduli import FITTED_SHARE
from trocar.waves.stretch.stretching_waves import StretchingWaves, StretchState

SHARES = np.arange(0.5, 1.11, 0.05)


def layers(thickness_mm: Sequence[float], modulus_kpa: Sequence[float]) -> Tissue:
    """Return three layers of Poisson's ratio 0.48."""
    names = ("epidermis", "dermis", "fat")
    return Tissue(
        layers=tuple(
            Layer(name=name, thickness=1e-3 * h, young_modulus=1e3 * e, poisson_ratio=0.48, density=1100.0)
            for name, h, e in zip(names, thickness_mm, modulus_kpa, strict=True)
        )
    )


SKIN = layers((0.1, 1, 10), (1000, 500, 10))
FITTED = (
    Dent(name="8 mm", tissue=SKIN),
    Dent(name="5 mm", tissue=SKIN, diameter=5e-3),
    Dent(name="12 mm", tissue=SKIN, diameter=12e-3),
    Dent(name="fat of 50 kPa", tissue=layers((0.1, 1, 10), (1000, 500, 50))),
)
NOT_FITTED = (
    Dent(name="10 mm", tissue=SKIN, diameter=10e-3),
    Dent(name="16 mm", tissue=SKIN, diameter=16e-3),
    Dent(name="6.5 mm, fat of 30 kPa", tissue=layers((0.1, 1, 10), (1000, 500, 30)), diameter=6.5e-3),
    Dent(name="fat of 5 kPa", tissue=layers((0.1, 1, 10), (1000, 500, 5))),
    Dent(name="fat of 5 mm", tissue=layers((0.1, 1, 5), (1000, 500, 10))),
    Dent(name="fat of 20 mm", tissue=layers((0.1, 1, 20), (1000, 500, 10))),
    Dent(name="dermis of 2 mm", tissue=layers((0.1, 2, 10), (1000, 500, 10))),
    Dent(name="dermis of 2 mm, 16 mm", tissue=layers((0.1, 2, 10), (1000, 500, 10)), diameter=16e-3),
    Dent(name="sides of 40 mm", tissue=SKIN, size=(0.04, 0.04)),
    Dent(name="sides of 100 mm", tissue=SKIN, size=(0.1, 0.1)),
    Dent(name="40 x 80 mm", tissue=SKIN, size=(0.04, 0.08)),
    Dent(name="edges+base", tissue=SKIN, support=Support.EDGES_AND_BASE),
    Dent(name="edges", tissue=SKIN, support=Support.EDGES),
    Dent(name="edges, 40 mm", tissue=SKIN, size=(0.04, 0.04), support=Support.EDGES),
    Dent(name="edges, 16 mm", tissue=SKIN, support=Support.EDGES, diameter=16e-3),
    Dent(name="preset skin, 8 mm", tissue=preset("skin")),
    Dent(name="preset skin, 5 mm", tissue=preset("skin"), diameter=5e-3),
    Dent(name="preset liver, 8 mm", tissue=preset("liver")),
    Dent(name="skin ten times fat", tissue=layers((0.1, 1, 10), (200, 100, 10))),
    Dent(name="skin five times fat", tissue=layers((0.1, 1, 10), (100, 50, 10))),
)


def worst(values: FloatArray) -> float:
    """Return the error of the largest size, with its sign [%]."""
    return 100 * float(values[np.abs(values).argmax()])


def fit(fine: bool) -> None:
    """Print the errors over shares, and the share whose largest error is least."""
    largest = np.zeros(len(SHARES))
    shares = " | ".join(f"{share:.2f}" for share in SHARES)
    print(f"| fitted on | model | best share by itself | its error | {shares} |")
    print("|---" * (4 + len(SHARES)) + "|")
    for dent in FITTED:
        reference = reference_curve(dent, mesh=None if fine else COARSE_MESH)
        for name, linear in linear_waves(dent).items():
            found = []
            for share in SHARES:
                model = StretchingWaves.of(linear, dent.tissue, share=share)
                found.append(worst(error(reference, wave_curve(dent, model, reference.force))))
            own = np.array(found)
            largest = np.maximum(largest, np.abs(own))
            best = int(np.abs(own).argmin())
            row = " | ".join(f"{value:+.1f}" for value in own)
            print(f"| {dent.name} | {name} | {SHARES[best]:.2f} | {own[best]:+.1f} % | {row} |", flush=True)
    best = int(largest.argmin())
    print(
        f"\nleast largest error {largest[best]:.1f} % at a share of {SHARES[best]:.2f}; in use: {FITTED_SHARE:g}"
    )


def check(fine: bool) -> None:
    """Print errors up to a third of the thickness and forces where errors leave 5 and 10 %."""
    print(
        "| case | model | third at / N | fitted share | derived | linear | leaves 5 % / N | 10 % / N "
        "| linear leaves 5 % / N | 10 % / N |"
    )
    print("|---" * 10 + "|")
    for dent in (*FITTED, *NOT_FITTED):
        reference = reference_curve(dent, mesh=None if fine else COARSE_MESH)
        for name, linear in linear_waves(dent).items():
            fitted, derived, straight = (
                error(reference, wave_curve(dent, model, reference.force))
                for model in (
                    StretchingWaves.of(linear, dent.tissue),
                    StretchingWaves.of(linear, dent.tissue, share=1.0),
                    linear,
                )
            )
            limits = [
                leaves(reference.force, values, bound)
                for values in (fitted, straight)
                for bound in (0.05, 0.1)
            ]
            told = " | ".join(
                f"{limit:.2f}" if limit < np.inf else f"above {reference.force[-1]:.2f}" for limit in limits
            )
            title = f"{dent.name}{', fitted on' if dent in FITTED else ''}{'; stopped' if reference.stopped else ''}"
            print(
                f"| {title} | {name} | {reference.force[-1]:.2f} | {worst(fitted):+.1f} % | {worst(derived):+.1f} % "
                f"| {worst(straight):+.0f} % | {told} |",
                flush=True,
            )


def _let_go(modes: int) -> tuple[StretchingWaves, StretchState]:
    """Return undamped waves held in a dent of a third of the thickness, and their state."""
    membrane = WaveMembrane.fitted(SKIN, size=(0.06, 0.06), modes=(modes, modes))
    model = StretchingWaves.of(membrane, SKIN)
    return model, model.static(FITTED[0].load(1.25))


def _energy(model: StretchingWaves, state: StretchState) -> float:
    """Return kinetic, elastic and stretching energy [J] of a state under no load."""
    (under_load,), answer = state.waves.oscillators, state.answer
    both = WaveState(state.time, (under_load + answer,))
    assert isinstance(model.linear, WaveMembrane)
    return float(model.linear.modal_energy(both).sum()) + model.stretch_energy(state)


def energy(steps: int, lengths: Sequence[float]) -> None:
    """Print how far energy rises above its start."""
    print(
        "| step | steps | most above the start | at the end | share of the energy in the stretched sheet, at most |"
    )
    print("|---|---|---|---|---|")
    for dt in lengths:
        model, state = _let_go(6)
        first = _energy(model, state)
        share = model.stretch_energy(state) / first
        free = FITTED[0].load(0.0)
        most = last = 0.0
        for _ in range(steps):
            state = model.step(state, free, free, dt)
            last = _energy(model, state) / first - 1
            most = max(most, last)
            share = max(share, model.stretch_energy(state) / first)
        print(f"| {1e3 * dt:g} ms | {steps} | {most:.1e} | {last:+.1e} | {100 * share:.0f} % |", flush=True)


def order() -> None:
    """Print the error of the deflection after 8 ms against steps of 1/128 ms."""
    solid = WaveSolid(SKIN, size=(0.06, 0.06), modes=(32, 32), dynamic_modes=(8, 8))
    free = FITTED[0].load(0.0)
    reached = {}
    for dt in (1 / 128, 1 / 16, 1 / 8, 1 / 4, 1 / 2):
        model = StretchingWaves.of(solid, SKIN)
        state = model.static(FITTED[0].load(1.25))
        for _ in range(round(8 / dt)):
            state = model.step(state, free, free, 1e-3 * dt)
        reached[dt] = model.deflection(state)
    truth = reached.pop(1 / 128)
    print("| step / ms | error |\n|---|---|")
    sizes = {dt: float(np.linalg.norm(w - truth) / np.linalg.norm(truth)) for dt, w in reached.items()}
    for dt, size in sizes.items():
        print(f"| {dt:g} | {size:.2e} |")
    print(f"\norder {np.polyfit(np.log(list(sizes)), np.log(list(sizes.values())), 1)[0]:.2f}")


def main() -> None:
    """Print what is asked for."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("what", choices=("fit", "check", "energy", "order"))
    parser.add_argument("--steps", type=int, default=20_000)
    parser.add_argument("--dt", type=float, action="append", help="length of a step [s]; may be repeated")
    parser.add_argument("--fine", action="store_true")
    asked = parser.parse_args()
    if asked.what == "fit":
        fit(asked.fine)
    elif asked.what == "check":
        check(asked.fine)
    elif asked.what == "energy":
        energy(asked.steps, asked.dt or (1e-4, 1e-3, 1e-2))
    else:
        order()


if __name__ == "__main__":
    main()
