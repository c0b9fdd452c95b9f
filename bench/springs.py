"""Print how near mass-springs come to finite elements, and what that costs.

Run: python bench/springs.py [flat] [convergence] [poisson] [supports] [tap] [large] [cost]; without a name all of
them, some ten minutes. `FEASolid` on its default mesh is what they are compared with (within 0.2 %:
bench/fea_convergence.py); presses are flat, 8 mm wide and in the middle of 60 x 60 mm; skin is 1000/500/10 kPa,
Poisson's ratio 0.48.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from dataclasses import replace
from itertools import combinations
from math import log2, pi, sin

import numpy as np

from trocar.model import Load, Press
from trocar.reference import FEASolid, MeshSize
from trocar.reference.springs.boxes import Boxes
from trocar.reference.springs.lattice import Lattice
from trocar.reference.springs.mass_spring import MassSpring, lattice_size
from trocar.tissues import Layer, NeoHookean, Tissue

SIZE = (0.06, 0.06)
COARSEST = 1.5  # boxes along the radius
MEDIUM = MeshSize(per_radius=2.0, growth=0.6, top=0.4, deepening=0.7, side=0.4)
TAP, DT = 0.02, 2.5e-4  # half a sine [s]; the step [s]


def layer(name: str, thickness_mm: float, modulus_kpa: float, nu: float = 0.48) -> Layer:
    """Return a damped layer."""
    return Layer(
        name=name,
        thickness=1e-3 * thickness_mm,
        young_modulus=1e3 * modulus_kpa,
        poisson_ratio=nu,
        density=1100.0,
        loss_factor=0.14,
        loss_frequency=50.0,
    )


SKIN = Tissue(layers=(layer("epidermis", 0.1, 1000), layer("dermis", 1, 500), layer("fat", 10, 10)))


def pad(nu: float = 0.48) -> Tissue:
    """Return a single layer of 10 mm."""
    return Tissue(layers=(layer("pad", 10, 10, nu),))


def lawful(tissue: Tissue) -> Tissue:
    """Return the same layers with the neo-Hookean law."""
    return Tissue(layers=tuple(replace(layer, law=NeoHookean()) for layer in tissue.layers))


def pressed(force: float) -> Load:
    """Return the load."""
    return (Press(x=0.03, y=0.03, radius=4e-3, force=force),)


def springs(tissue: Tissue, support: str, mesh: MeshSize, *, turning: bool = False) -> MassSpring:
    """Return the lattice."""
    return MassSpring(
        tissue, size=SIZE, support=support, around=pressed(1.0), mesh=mesh, linearised=not turning
    )


def elements(tissue: Tissue, support: str = "base", mesh: MeshSize | None = None) -> FEASolid:
    """Return the finite elements."""
    return FEASolid(tissue, size=SIZE, support=support, around=pressed(1.0), mesh=mesh)


def deepest(model: MassSpring | FEASolid, force: float = 1e-3) -> np.ndarray:
    """Return each layer's largest deflection [m]."""
    return np.array(list(model.largest_deflection(model.static(pressed(force))).values()))


def shares(found: np.ndarray, expected: np.ndarray) -> str:
    """Return the differences in percent."""
    return " ".join(f"{100 * one:+7.2f}" for one in found / expected - 1)


def classical(sides: tuple[float, float, float], lame: float, shear: float) -> np.ndarray:
    """Return the stiffness of a box of central springs and a volume spring, shape (24, 24): edges and all diagonals.

    The body diagonals take half the shear that keeps every diagonal's constant at 0 or above, the face diagonals the
    rest, and the edges what is missing from 3 mu along an axis: it may be negative.
    """
    side = np.array(sides)
    corners = np.array(list(np.ndindex(2, 2, 2))) * side
    volume, squares = side.prod(), (side**2).sum()
    body = 0.5 * shear * side.min() ** 2 * squares / (4 * volume)
    matrix = np.zeros((8, 3, 8, 3))

    def add(ends: tuple[int, int], stiffness: float) -> None:
        way = corners[ends[1]] - corners[ends[0]]
        block = stiffness * np.outer(way, way) / (way @ way)
        for a in ends:
            for b in ends:
                matrix[a, :, b, :] += block if a == b else -block

    for one, other in combinations(range(8), 2):
        way = np.abs(corners[one] - corners[other])
        along = way > 0
        if along.sum() == 3:
            add((one, other), body)
        elif along.sum() == 2:
            i, j = side[along]
            add((one, other), (i**2 + j**2) / 4 * (shear * volume / (i * j) ** 2 - 4 * body / squares))
        else:
            (a,), (b, c) = side[along], side[~along]
            over = 3 - (a / b) ** 2 - (a / c) ** 2 + 0.5 * (a * side.min() / (b * c)) ** 2
            add((one, other), shear * volume * over / (4 * a**2))
    swelling = ((corners > 0) - 0.5) / (2 * side)
    return matrix.reshape(24, 24) + (lame - shear) * volume * np.outer(swelling, swelling)


def flat() -> None:
    """Flatten a box: the least stiffness of central springs, and of ours, besides the six motions that are free."""
    print(
        "box 1 x 1 x h mm, Poisson's ratio 0.48: h; least stiffness over mu h of central springs, of ours [1/mm]"
    )
    one = layer("one", 1, 10)
    for height in (1.0, 0.7, 0.5, 0.3, 0.1):
        shape = (1e-3, 1e-3, 1e-3 * height)
        boxes = Boxes(*(np.array([0.0, side]) for side in shape), np.zeros(1, dtype=np.int64))
        ours = Lattice().stiffness(boxes, (one,)).toarray()
        least = []
        for matrix in (classical(shape, one.lame_lambda, one.shear_modulus), ours):
            values = np.linalg.eigvalsh(matrix)
            least.append(values[np.argsort(np.abs(values))[6:]].min() / (one.shear_modulus * shape[2]))
        print(f"{height:4} {least[0]:+9.4f} {least[1]:+9.4f}")


def convergence() -> None:
    """Halve every box three times; the orders are of the error and, free of the reference, of the changes."""
    print(
        "error of each layer's deflection [%]; order of the error; of the changes; boxes halved; support base"
    )
    for name, tissue in (("pad", pad()), ("skin", SKIN)):
        expected, values = deepest(elements(tissue)), []
        for refinement in range(4):
            model = springs(tissue, "base", replace(lattice_size(COARSEST), refinement=refinement))
            values.append(deepest(model))
            errors = [abs(value[0] / expected[0] - 1) for value in values]
            changes = np.abs(np.diff([value[0] for value in values]))
            print(
                f"{name:5} {COARSEST * 2**refinement:4g} a radius {model.dofs:6} unknowns "
                f"{shares(values[-1], expected)}"
                + (f"; {log2(errors[-2] / errors[-1]):.2f}" if refinement else "")
                + (f"; {log2(changes[-2] / changes[-1]):.2f}" if refinement > 1 else ""),
                flush=True,
            )


def poisson() -> None:
    """Vary Poisson's ratio of the pad."""
    print("Poisson's ratio of the pad; error [%] with 8 boxes a radius")
    for nu in (0.0, 0.25, 0.4, 0.48, 0.49, 0.499):
        found = deepest(springs(pad(nu), "base", lattice_size()))
        print(f"{nu:6} {shares(found, deepest(elements(pad(nu))))}", flush=True)


def supports() -> None:
    """Vary the support under skin."""
    print("support; error of epidermis, dermis, fat [%] with 4 and 8 boxes a radius")
    for support in ("base", "edges+base", "edges"):
        expected = deepest(elements(SKIN, support))
        found = [shares(deepest(springs(SKIN, support, lattice_size(number))), expected) for number in (4, 8)]
        print(f"{support:12} {found[0]} | {found[1]}", flush=True)


def tapped(model: MassSpring | FEASolid, force: float) -> tuple[np.ndarray, float]:
    """Return each face's deflection in the middle [m], shape (steps, layers), and the seconds a step takes."""

    def load(at: float) -> Load:
        return pressed(force * sin(pi * at / TAP) if at < TAP else 0.0)

    where, state, found = np.array([[0.03, 0.03, 0.0]]), model.init(), []
    model.step(state, load(0.0), load(DT), DT)  # factors are kept from here on
    began = time.process_time()
    for tick in range(round(2 * TAP / DT)):
        state = model.step(state, load(tick * DT), load((tick + 1) * DT), DT)
        found.append([model.displacement(state, where, name)[0, 2] for name in model.layer_names])
    return np.array(found), (time.process_time() - began) / len(found)


def tap() -> None:
    """Tap skin for 20 ms and look for 40."""
    print("tap of 20 ms on skin: largest difference over 40 ms of any layer, of its largest deflection [%]")
    for force, law, name in (
        (1e-3, lambda tissue: tissue, "0.001 N, finite elements linear"),
        (0.3, lawful, "0.3 N, finite elements neo-Hookean"),
    ):
        expected, cost = tapped(elements(law(SKIN), mesh=MEDIUM), force)
        print(f"{name}: {1e3 * np.abs(expected).max():.3g} mm, {1e3 * cost:.0f} ms a step")
        for number in (4, 6):
            for turning in (False, True) if force < 0.01 else (True,):
                model = springs(SKIN, "base", lattice_size(number), turning=turning)
                found, cost = tapped(model, force)
                apart = np.abs(found - expected).max(axis=0) / np.abs(expected).max(axis=0)
                print(
                    f"  {number} a radius, {'turning' if turning else 'linearised':10} {100 * apart.max():5.1f}, "
                    f"{model.dofs} unknowns, {1e3 * cost:.0f} ms a step",
                    flush=True,
                )


def large() -> None:
    """Press deep: turning springs against neo-Hookean finite elements."""
    print(
        "deep press on skin: dermis [mm] by linear, turning springs (6 a radius), neo-Hookean elements; error [%]"
    )
    still = springs(SKIN, "base", lattice_size(6))
    turning = springs(SKIN, "base", lattice_size(6), turning=True)
    solid = elements(lawful(SKIN), mesh=MEDIUM)
    for force in (0.1, 0.3, 0.6, 1.0, 2.0):
        one, two, three = (1e3 * deepest(model, force)[1] for model in (still, turning, solid))
        squeezed = turning.deformation(turning.static(pressed(force)))["fat"].stretch[0]
        print(
            f"{force:4} N {one:6.3f} {two:6.3f} {three:6.3f} {100 * (two / three - 1):+6.1f}, "
            f"fat squeezed to {squeezed:.2f}",
            flush=True,
        )


def cost() -> None:
    """Count seconds of set-up and one equilibrium under skin."""
    print("skin, support base: unknowns, seconds of set-up and one equilibrium, error of the dermis [%]")
    fine = deepest(elements(SKIN))

    def timed(make: Callable[[], MassSpring | FEASolid], name: str) -> None:
        began = time.process_time()
        model = make()
        found = deepest(model)
        taken = time.process_time() - began
        print(
            f"{name:28} {model.dofs:6} {taken:6.2f} {100 * (found[1] / fine[1] - 1):+6.2f}, {model.solver_name}",
            flush=True,
        )

    for number in (2, 3, 4, 6, 8, 12):
        for turning in (False, True) if number < 8 else (False,):
            kind = "turning" if turning else "linearised"
            timed(
                lambda number=number, turning=turning: springs(
                    SKIN, "base", lattice_size(number), turning=turning
                ),
                f"{number} a radius, {kind}",
            )
    for name, mesh in (("finite elements, medium", MEDIUM), ("finite elements, default", None)):
        timed(lambda mesh=mesh: elements(SKIN, mesh=mesh), name)


def main() -> None:
    """Run what is asked for."""
    parts = {part.__name__: part for part in (flat, convergence, poisson, supports, tap, large, cost)}
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("parts", nargs="*", choices=[[], *parts])
    for name in parser.parse_args().parts or parts:
        parts[name]()
        print()


if __name__ == "__main__":
    main()
