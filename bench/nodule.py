"""What a nodule takes from the dent of a press: springs under live waves against finite elements with the ball in them.

Run: python bench/nodule.py [--tick]. Each line is a press of 8 mm over the middle of a nodule: how much less it sinks
with the nodule than without, by springs (`waves.nodules`) and by axially symmetric elements (scikit-fem), of two
lengths, and by how much more force it takes to come as deep. --tick: what the springs of the task's nodule add to a
tick, as a ratio.
"""

from __future__ import annotations

import argparse
import time
from dataclasses import replace
from math import pi
from typing import Any

import numpy as np
from scipy.special import j1
from skfem import (
    Basis,
    BilinearForm,
    ElementQuad2,
    ElementVector,
    FacetBasis,
    LinearForm,
    MeshQuad,
    condense,
    solve,
)

from trocar import tissue
from trocar.model import FloatArray, Support
from trocar.simulation import HANDLE, JAW, POSE, PRESENT, RECORD, advance, at_rest
from trocar.simulation.scene import DT
from trocar.tissues import Layer, Tissue
from trocar.tissues.nodule import Nodule
from trocar.training.session import scene_of
from trocar.training.tasks.catalogue import task
from trocar.waves.near_field import SMOOTH
from trocar.waves.nodules import springs_under
from trocar.waves.solid import WaveSolid
from trocar.waves.tick import make_tick

TOOL = 4e-3  # [m] radius of the press
ELEMENTS = (5e-4, 2.5e-4)  # [m]
TICKS = 2000
_OUTER = 24  # elements from where they are even to the rim
BLOCK = Tissue(
    name="a block of fat",
    layers=(Layer(name="fat", thickness=0.02, young_modulus=1e4, poisson_ratio=0.48, density=950),),
)
CASES = (
    ("8 mm deep, 5 mm radius, ten times as stiff", BLOCK, 0.04, 8e-3, 5e-3, 1e5),
    ("10 mm deep, 5 mm radius, ten times as stiff", BLOCK, 0.04, 10e-3, 5e-3, 1e5),
    ("8 mm deep, 3 mm radius, ten times as stiff", BLOCK, 0.04, 8e-3, 3e-3, 1e5),
    ("the task's", tissue("silicone-pad"), 0.05, 8e-3, 5e-3, 3e5),
)


def by_springs(layers: Tissue, nodule: Nodule) -> float:
    """Return what the nodule takes from how far a press of 1 N over its middle sinks, in the mean over it [m]."""
    side = 2 * nodule.x
    waves = WaveSolid(layers, size=(side, side), support=Support.BASE, modes=(52, 52), dynamic_modes=(52, 52))
    tick = make_tick(waves, DT, window=SMOOTH, offsets=np.zeros((1, 1)))
    springs = springs_under((nodule,), waves, layers, tick, window=SMOOTH)
    kx, ky = (pi / side * (each + 1.0) for each in (springs.row, springs.column))
    number = springs.row * waves.surface_modes[1] + springs.column
    yielding = waves.surface_oscillators.yielding[number, 0, 0]
    passed = np.exp(-0.25 * SMOOTH**2 * (kx**2 + ky**2))
    own = np.eye(len(springs.answer)) + springs.feel.T @ (yielding[:, None] * springs.feel)
    rim = np.hypot(kx, ky) * TOOL
    pressed = passed * yielding * np.sin(kx * nodule.x) * np.sin(ky * nodule.y) * 2 * j1(rim) / rim
    felt = springs.feel.T @ pressed
    return float(felt @ np.linalg.solve(own, felt))


def by_elements(layers: Tissue, nodule: Nodule, length: float) -> tuple[float, float]:
    """Return how far a press of 1 N over the middle sinks without the nodule, and what that takes from it [m].

    A cylinder as wide as the block, axially symmetric, its rim free to slide sideways; quadratic elements, whose Gauss
    points are of the nodule or not.
    """
    rim, through = 2 * nodule.x / pi**0.5, layers.thickness
    fine = nodule.radius + TOOL
    r = np.concatenate([np.arange(0.0, fine, length), np.geomspace(fine, rim, _OUTER)])
    z = -np.linspace(0.0, through, round(through / length) + 1)[::-1]
    mesh = MeshQuad.init_tensor(r, z)
    basis = Basis(mesh, ElementVector(ElementQuad2()), intorder=4)
    dents = [_dent(basis, layers, nodule if there else None) for there in (False, True)]
    return dents[0], dents[0] - dents[1]


def _dent(basis: Basis, layers: Tissue, nodule: Nodule | None) -> float:
    faces = np.cumsum([layer.thickness for layer in layers.layers])
    lame, shear = (
        np.array([getattr(layer, name) for layer in layers.layers])
        for name in ("lame_lambda", "shear_modulus")
    )

    def moduli(at: FloatArray) -> tuple[FloatArray, FloatArray]:
        number = np.minimum(np.searchsorted(faces, -at[1]), len(faces) - 1)
        first, second = lame[number], shear[number]
        if nodule is not None:
            inside = at[0] ** 2 + (at[1] + nodule.depth) ** 2 < nodule.radius**2
            first = np.where(inside, nodule.bulk_modulus - 2 / 3 * nodule.shear_modulus, first)
            second = np.where(inside, nodule.shear_modulus, second)
        return first, second

    @BilinearForm
    def energy(u: Any, v: Any, w: Any) -> Any:
        first, second = moduli(w.x)
        of_u, of_v = (
            (one.grad[0, 0], one.grad[1, 1], one[0] / w.x[0], (one.grad[0, 1] + one.grad[1, 0]) / 2**0.5)
            for one in (u, v)
        )
        volume = sum(of_u[:3]) * sum(of_v[:3])
        return (first * volume + 2 * second * sum(p * q for p, q in zip(of_u, of_v, strict=True))) * w.x[0]

    @LinearForm
    def pressed(v: Any, w: Any) -> Any:
        return -v[1] * (w.x[0] < TOOL) * w.x[0]

    top = basis.mesh.facets_satisfying(lambda x: np.isclose(x[1], 0.0))
    load = pressed.assemble(FacetBasis(basis.mesh, basis.elem, facets=top, intorder=6))
    load /= -load.sum() * 2 * pi  # 1 N around the whole turn
    held = np.unique(
        np.concatenate(
            [
                basis.get_dofs(lambda x: np.isclose(x[1], -layers.thickness)).all(),
                basis.get_dofs(lambda x: np.isclose(x[0], basis.mesh.p[0].max())).all("u^2"),
                basis.get_dofs(lambda x: np.isclose(x[0], 0.0)).all("u^1"),
            ]
        )
    )
    moved = solve(*condense(energy.assemble(basis), load, D=held))
    return float(2 * pi * load @ moved)


def tick_costs() -> None:
    """Print how much longer a tick of the task takes than one without its nodule."""
    found = task("find-nodule")
    plain, lump = (scene_of(replace(found, nodules=own)) for own in ((), found.nodules))
    x, y = found.nodules[0].x, found.nodules[0].y
    hand = found.instruments[0]
    ways = {
        "without instruments": np.zeros((TICKS, 2, POSE)),
        "pressing over it": np.zeros((TICKS, 2, POSE)),
    }
    for number, pose in enumerate(ways["pressing over it"]):
        depth = min(1e-3, 1e-5 * number)
        place = (x + 2e-3 * np.sin(0.01 * number), y, 5e-4 - depth)
        pose[0, PRESENT], pose[0, JAW] = 1.0, 1.0
        pose[0, HANDLE : HANDLE + 3] = hand.handle_for(place)
    for words, poses in ways.items():
        medians = []
        for scene in (plain, lump) * 2:  # the first round compiles
            state, records, durations = at_rest(scene), np.zeros((2, RECORD)), []
            for pose in poses:
                began = time.perf_counter()
                advance(scene, state, pose, records)
                durations.append(time.perf_counter() - began)
            medians.append(float(np.median(durations[TICKS // 4 :])))
        print(
            f"{words}: {1e6 * medians[2]:.0f} us a tick, with the nodule {medians[3] / medians[2]:.2f} times"
        )


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--tick", action="store_true")
    if parser.parse_args().tick:
        tick_costs()
        return
    print("| nodule | takes, by springs | by elements | half as many | force at one depth, with to without |")
    print("|---|---|---|---|---|")
    for words, layers, side, depth, radius, modulus in CASES:
        nodule = Nodule(x=side / 2, y=side / 2, depth=depth, radius=radius, young_modulus=modulus)
        found = by_springs(layers, nodule)
        (_, coarse), (dent, truth) = (by_elements(layers, nodule, length) for length in ELEMENTS)
        print(
            f"| {words} | {100 * found / dent:.1f} % | {100 * truth / dent:.1f} % | {100 * coarse / dent:.1f} % | "
            f"{1 / (1 - found / dent):.2f}, {1 / (1 - truth / dent):.2f} |",
            flush=True,
        )


if __name__ == "__main__":
    main()
