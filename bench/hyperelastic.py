"""Print what the finite elements reach under large deformation.

Tables: laws at points against finite differences; Newton's imbalances and its order; an indented block on three nested
meshes; energy over undamped steps; force against deflection, linear and not; CalculiX where it is installed
(Debian package calculix-ccx). `--quick` leaves out the last two.
"""

from __future__ import annotations

import argparse
import sys
import time
from math import log
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from trocar.errors import SolverError
from trocar.model import Press, Profile, Support
from trocar.reference import FEASolid, MeshSize
from trocar.reference.convergence import refine
from trocar.reference.hyperelastic import Material, first_piola, nominal_moduli
from trocar.reference.newton import Directions, balance
from trocar.reference.part import Static
from trocar.tissues import Fibre, Law, Layer, NeoHookean, Ogden, Tissue

sys.path.insert(0, str(Path(__file__).parent.parent / "tests"))

from reference.neo_hookean import NeoHookeanBlock, executable

LAWS: dict[str, Law] = {
    "neo-hookean": NeoHookean(),
    "ogden": Ogden(terms=((0.7, 1.3), (0.25, 5.0), (0.05, -2.0))),
    "fibre": Fibre(k1=2e4, k2=1.2, dispersion=0.1, angle=0.6),
}
COARSE = MeshSize(per_radius=2.0, growth=0.6, top=0.4, deepening=0.7, side=0.4)


def layer(name: str, thickness: float, young_modulus: float, law: Law | None = None, **more: float) -> Layer:
    """Return a layer: thickness [m], Young's modulus [Pa]."""
    values = {"poisson_ratio": 0.48, "density": 1000.0} | more
    return Layer(
        name=name, thickness=thickness, young_modulus=young_modulus, law=law or NeoHookean(), **values
    )


SKIN = Tissue(layers=(layer("epidermis", 2e-4, 4e5), layer("dermis", 1e-3, 1e5), layer("fat", 8e-3, 1e4)))
PRESTRESSED = Tissue(
    layers=(
        layer("wall", 1.5e-3, 1e5, prestress_x=2e4, prestress_y=9e3),
        layer("fat", 6e-3, 1e4, poisson_ratio=0.45),
    )
)
SIZE, RADIUS = (0.04, 0.04), 5e-3
PRESS = Press(x=0.02, y=0.02, radius=RADIUS, force=0.9)


def derivatives() -> None:
    """Compare stress and tangent with central differences at 200 random deformations."""
    print("laws against central differences, largest error relative to the largest entry")
    found = np.eye(3) + 0.3 * np.random.default_rng(1).normal(size=(400, 3, 3))
    found, step = found[np.linalg.det(found) > 0.4][:200], 1e-6
    for name, law in LAWS.items():
        body = Material(law=law, shear_modulus=1e4, isochoric_share=1.0, bulk_modulus=2.5e5)
        stress, moduli = body.second_piola(found, tangent=True)
        assert moduli is not None
        first = first_piola(found, stress)
        tangent = nominal_moduli(found, stress, moduli).reshape(-1, 3, 3, 3, 3)
        errors = np.zeros((2, len(found)))
        for i, j in np.ndindex(3, 3):
            change = np.zeros((3, 3))
            change[i, j] = step
            slope = (body.energy(found + change) - body.energy(found - change)) / (2 * step)
            ends = (
                first_piola(at, body.second_piola(at, tangent=False)[0])
                for at in (found + change, found - change)
            )
            turned = (next(ends) - next(ends)) / (2 * step)
            errors[0] = np.maximum(errors[0], np.abs(slope - first[:, i, j]) / np.abs(first).max(axis=(1, 2)))
            errors[1] = np.maximum(
                errors[1],
                np.abs(turned - tangent[:, :, :, i, j]).max(axis=(1, 2))
                / np.abs(tangent).max(axis=(1, 2, 3, 4)),
            )
        # a fibre that goes slack between the two ends has no derivative there: the median says what the rest is
        print(
            f"  {name:12} stress {errors[0].max():.1e}, tangent {errors[1].max():.1e} "
            f"(median {np.median(errors[1]):.1e})"
        )


def newton() -> None:
    """Print the imbalances on the way from 0.8 to all of the load, every tangent factored."""
    print("\nNewton from 0.72 to 0.9 N on three layers: imbalance over the load, and the order it shows")
    for name, law in LAWS.items():
        tissue = Tissue(
            layers=tuple(layer(one.name, one.thickness, one.young_modulus, law) for one in SKIN.layers)
        )
        model = FEASolid(tissue, size=SIZE, support="base", around=(PRESS,), mesh=COARSE)
        assert model._large is not None
        part = model._large.part((False, False))
        force = part.freed(part.domain.forces(model._forces((PRESS,))))
        start = part.freed(part.domain.field(model.static((PRESS.with_force(0.72),)).displacement))
        found = balance(
            Static(part, force),
            start,
            scale=float(np.linalg.norm(force)),
            tolerance=1e-12,
            directions=Directions("superlu", reuse=False),
        ).imbalances
        orders = [
            log(c / b) / log(b / a)
            for a, b, c in zip(found, found[1:], found[2:], strict=False)
            if b < 0.1 and c > 1e-10
        ]
        print(
            f"  {name:12} {' '.join(f'{value:.1e}' for value in found)}; {' '.join(f'{o:.1f}' for o in orders)}"
        )


def meshes() -> None:
    """Print three nested meshes, a smooth press and a flat one."""
    print("\nthree nested meshes: coarse, medium, fine, limit [mm]; order; error of the finest")
    pad = Tissue(layers=(layer("pad", 6e-3, 1e4, poisson_ratio=0.45),))
    smooth = Press(x=0.01, y=0.01, radius=5e-3, force=0.14, profile=Profile.GAUSSIAN)
    for words, tissue, size, press in (
        ("gaussian on a pad", pad, (0.02, 0.02), smooth),
        ("flat on three layers", SKIN, SIZE, PRESS),
    ):
        coarse = MeshSize(per_radius=1.0, growth=1.0, top=0.6, deepening=1.0)
        found, dofs = refine(tissue, size=size, support="base", load=(press,), mesh=coarse)
        for name, result in found.items():
            values = " ".join(f"{1e3 * value:.4f}" for value in (*result.values, result.limit))
            error = 100 * result.uncertainty / result.values[-1]
            print(
                f"  {words:22} {name:10} {'/'.join(map(str, dofs))}: {values}; {result.order:.1f}; {error:.2f} %"
            )


def energy() -> None:
    """Print how far the energy strays over undamped steps after letting go."""
    print(
        "\nenergy over 20 undamped steps of 1 and 0.5 ms, let go from 0.6 N: largest departure, share that is kinetic"
    )
    press = Press(x=0.015, y=0.012, radius=3e-3, force=0.6)
    mesh = MeshSize(per_radius=1.0, growth=1.2, top=0.6, deepening=1.2)
    for name, law in LAWS.items():
        tissue = Tissue(layers=(layer("wall", 1e-3, 2e5, law, prestress_x=2e4), layer("fat", 6e-3, 1e4, law)))
        model = FEASolid(tissue, size=(0.03, 0.024), support="base", around=(press,), mesh=mesh)
        assert model._large is not None
        part = model._large.part((False, False))
        words = []
        for dt in (1e-3, 5e-4):
            state, stray, kinetic = model.static((press,)), 0.0, 0.0
            first = 0.0
            for number in range(21):
                field, velocity = (part.domain.field(each) for each in (state.displacement, state.velocity))
                speed = part.freed(velocity)
                moving = 0.5 * float(speed @ (part.mass @ speed))
                total = moving + part.deformed.energy(field) - float((part.at_rest * field).sum())
                first = total if number == 0 else first
                stray, kinetic = max(stray, abs(total / first - 1)), max(kinetic, moving / first)
                state = model.step(state, (), (), dt)
            words.append(f"{stray:.1e}, {kinetic:.2f}")
        print(f"  {name:12} {'; '.join(words)}")


def forces() -> None:
    """Print force and deflection of blocks whose linear answer leaves them, moduli epidermis/dermis/fat [kPa]."""
    print(
        "\n60 x 60 mm, fat 10 mm, all held, 6 mm tool, nu 0.49: dermis linear and neo-Hookean [mm], smallest stretch, s"
    )
    for moduli in ((1000, 200, 5), (1000, 1000, 20)):
        named = zip(("epidermis", "dermis", "fat"), (1e-4, 1e-3, 1e-2), moduli, strict=True)
        tissue = Tissue(layers=tuple(layer(n, h, 1e3 * e, poisson_ratio=0.49) for n, h, e in named))
        press = Press(x=0.03, y=0.03, radius=3e-3, force=1.0)
        shared = {"size": (0.06, 0.06), "support": "edges+base", "around": (press,), "mesh": COARSE}
        linear, large = FEASolid(tissue.linearised, **shared), FEASolid(tissue, **shared)
        for force in (0.1, 0.25, 0.5, 1.0, 2.5):
            load = (press.with_force(force),)
            start = time.process_time()
            straight = linear.largest_deflection(linear.static(load))["dermis"]
            try:
                state = large.static(load)
            except SolverError as error:
                print(f"  {moduli} {force:5.2f} N: {1e3 * straight:.3f}; {error}")
                continue
            least = min(one.stretch[0] for one in large.deformation(state).values())
            deep = large.largest_deflection(state)["dermis"]
            seconds = time.process_time() - start
            print(
                f"  {moduli} {force:5.2f} N: {1e3 * straight:.3f} {1e3 * deep:.3f}  {least:.3f}  {seconds:.1f}"
            )


def calculix() -> None:
    """Compare two pressed blocks with CalculiX; tests/reference/test_calculix_large.py has the stretched columns."""
    if executable() is None:
        print("\nCalculiX is not installed (Debian package calculix-ccx)")
        return
    print(
        "\npressed blocks against CalculiX, own mesh and load: deflection of each layer [mm], departure [%]"
    )
    for words, tissue, size, support, radius, steps in (
        ("three layers, base", SKIN, SIZE, Support.BASE, RADIUS, (0.3, 0.6, 0.9)),
        ("prestress, edges", PRESTRESSED, (0.04, 0.03), Support.EDGES, 4e-3, (0.3, 0.8)),
    ):
        block = NeoHookeanBlock(tissue=tissue, size=size, support=support, radius=radius, per_radius=2.0)
        with TemporaryDirectory() as folder:
            theirs = block.pressed(steps, Path(folder))
        press = Press(x=size[0] / 2, y=size[1] / 2, radius=radius, force=1.0)
        model = FEASolid(tissue, size=size, support=support, around=(press,), mesh=COARSE)
        for step in theirs:
            ours = list(model.largest_deflection(model.static((press.with_force(step.force),))).values())
            pairs = [
                f"{1e3 * a:.3f}/{1e3 * b:.3f} {100 * (a / b - 1):+.2f}"
                for a, b in zip(ours, step.deflection, strict=True)
            ]
            print(f"  {words:20} {step.force} N: {'; '.join(pairs)}")


def main() -> None:
    """Print all tables."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--quick", action="store_true", help="without the last two tables")
    choice = parser.parse_args()
    derivatives()
    newton()
    meshes()
    energy()
    if not choice.quick:
        forces()
        calculix()


if __name__ == "__main__":
    main()
