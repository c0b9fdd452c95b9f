"""Print how near the mesh-free model comes to the finite elements, and what it costs.

Tables: equilibria of one layer and of three under a flat tool at rising resolution, with the order of the error; a tap
on one layer; cuts from side to side against finite elements whose nodes are let go; and the longest stable step of
explicit time beside the seconds of computing that a second of motion takes. Takes some minutes; `--quick` leaves the
finest resolutions out.
"""

from __future__ import annotations

import argparse
from dataclasses import replace
from time import process_time
from typing import Any

import numpy as np

from trocar.model import FloatArray, Press, Support, TissueModel
from trocar.reference import FEASolid, MeshSize
from trocar.reference.footprint import footprint_points
from trocar.reference.mesh_free import Cut, MeshFree
from trocar.reference.opening import OpenedBlock
from trocar.tissues import Layer, Tissue

SIZE = (0.06, 0.06)
PRESS = Press(x=0.03, y=0.03, radius=0.004, force=0.05)


def layer(name: str, thickness: float, young_modulus: float) -> Layer:
    """Return a nearly incompressible, damped layer."""
    return Layer(
        name=name,
        thickness=thickness,
        young_modulus=young_modulus,
        poisson_ratio=0.48,
        density=1000.0,
        loss_factor=0.14,
    )


PAD = Tissue(name="one layer", layers=(layer("fat", 0.01, 1e4),))
SKIN = Tissue(
    name="three layers",
    layers=(
        layer("epidermis", 1e-4, 1e6),
        layer("dermis", 1e-3, 5e5),
        layer("fat", 1e-2, 1e4),
    ),
)
ALONG = np.stack([np.linspace(0.03, 0.04, 41), np.full(41, 0.03), np.zeros(41)], axis=1)


def deflections(model: TissueModel[Any]) -> FloatArray:
    """Return the largest deflection of any layer and the mean under the tool [m]."""
    state = model.static((PRESS,))
    largest = max(float(-model.displacement(state, ALONG, name)[:, 2].min()) for name in model.layer_names)
    ends = np.linspace(0.0, SIZE[0], 3)
    points, shares = footprint_points(PRESS, ends, ends)
    return np.array([largest, -shares @ model.displacement(state, points)[:, 2]])


def equilibria(support: str, resolutions: list[float]) -> None:
    """Print a table for each tissue: refined finite elements are the truth."""
    for tissue in (PAD, SKIN):
        mesh = MeshSize(per_radius=2.5, growth=0.5, top=0.35, deepening=0.6, refinement=1)
        fine = FEASolid(tissue, size=SIZE, support=support, around=(PRESS,), mesh=mesh)
        truth, errors = deflections(fine), []
        print(
            f"\n{tissue.name}, {support}: 0.05 N on 8 mm, finite elements of {fine.dofs} unknowns "
            f"{1e3 * truth[0]:.5f} mm, on average under the tool {1e3 * truth[1]:.5f} mm"
        )
        print(f"{'resolution':>10} {'unknowns':>8} {'largest %':>9} {'mean %':>7} {'s':>6}")
        for resolution in resolutions:
            began = process_time()
            model = MeshFree(
                tissue, size=SIZE, support=support, around=(PRESS,), resolution=resolution, mirrored=True
            )
            errors.append(100 * (deflections(model) / truth - 1))
            print(
                f"{resolution:10g} {model.dofs:8d} {errors[-1][0]:9.2f} {errors[-1][1]:7.2f} "
                f"{process_time() - began:6.1f}",
                flush=True,
            )
        means = np.array([error[1] for error in errors])
        if (means > 0).any() and (means < 0).any():
            print("the mean's error changes its sign: no order is read from it")
        else:
            slope = np.polyfit(np.log(resolutions[1:]), np.log(np.abs(means[1:])), 1)[0]
            print(f"order of the mean's error from {resolutions[1]:g} on: {-slope:.1f}")


def tap(model: TissueModel[Any], dt: float, count: int, every: int) -> FloatArray:
    """Return the deflection [m] every so many steps under a force that rises in 5 ms, is held and falls."""
    state, found = model.init(), []

    def load(time: float) -> tuple[Press, ...]:
        return (
            PRESS.with_force(PRESS.force * float(np.interp(time, [0, 5e-3, 2e-2, 2.5e-2], [0, 1, 1, 0]))),
        )

    for number in range(count):
        state = model.step(state, load(number * dt), load((number + 1) * dt), dt)
        if (number + 1) % every == 0:
            found.append(-model.displacement(state, ALONG[:1])[0, 2])
    return np.array(found)


def taps(resolutions: list[float]) -> None:
    """Print the second table."""
    fea = FEASolid(PAD, size=SIZE, support="base", around=(PRESS,))
    began = process_time()
    truth = tap(fea, 2.5e-4, 200, 4)
    print(f"\na tap of 25 ms on one layer, 50 ms followed; finite elements {process_time() - began:.1f} s")
    print(
        f"{'resolution':>10} {'time':>9} {'critical step us':>16} {'largest error, % of the largest':>32} {'s':>7}"
    )
    for resolution in resolutions:
        for stepping in ("explicit", "implicit"):
            model = MeshFree(
                PAD,
                size=SIZE,
                support="base",
                around=(PRESS,),
                resolution=resolution,
                stepping=stepping,
                mirrored=True,
            )
            critical = model.critical_step
            began = process_time()
            found = tap(model, 1e-3, 50, 1) if stepping == "explicit" else tap(model, 2.5e-4, 200, 4)
            error = np.abs(found - truth).max() / truth.max()
            print(
                f"{resolution:10g} {stepping:>9} {1e6 * critical:16.3g} {100 * error:32.2f} "
                f"{process_time() - began:7.1f}",
                flush=True,
            )


def cuts(resolutions: list[float]) -> None:
    """Print the third table: two tools beside a cut along the middle of a smaller block."""
    size, places = (0.03, 0.03), np.array([[0.0095, 0.015], [0.01499, 0.015]])
    load = tuple(Press(x=x, y=0.015, radius=4e-3, force=0.05) for x in (0.0095, 0.0205))
    fat = PAD.layers[0]
    slabs = Tissue(layers=tuple(replace(fat, name=f"fat {i}", thickness=2.5e-3) for i in range(4)))
    print("\ncut from side to side, 10 mm thick; under a tool, opening and sinking of the lip [mm]")
    for depth in (0.0025, 0.005, 0.0075, 0.01):
        fea = OpenedBlock(slabs, size=size, support=Support.BASE, load=load, depth=depth)
        rows = [("finite elements", fea.displacement(places))]
        cut = Cut(start=(0.015, 0.0), end=(0.015, 0.03), depth=depth)
        for resolution in resolutions:
            model = MeshFree(
                slabs, size=size, support="base", around=load, resolution=resolution, cuts=(cut,)
            )
            moved = model.displacement(model.static(load), np.c_[places, np.zeros(2)])
            rows.append((f"mesh-free {resolution:g}", moved))
        for name, moved in rows:
            under, opening, sinking = 1e3 * np.array([-moved[0, 2], moved[1, 0], -moved[1, 2]])
            print(f"{1e3 * depth:5.1f} mm deep {name:18} {under:.4f} {opening:.4f} {sinking:.4f}", flush=True)


def explicit_costs() -> None:
    """Print the fourth table, from a thousand steps of each or fewer."""
    print("\nexplicit time; a second of motion asks for")
    for tissue in (PAD, SKIN):
        for damped in (False, True):
            layers = (
                tissue.layers if damped else tuple(replace(one, loss_factor=0.0) for one in tissue.layers)
            )
            for resolution in (1.0, 2.0):
                model = MeshFree(
                    replace(tissue, layers=layers),
                    size=SIZE,
                    support="base",
                    around=(PRESS,),
                    resolution=resolution,
                    mirrored=True,
                )
                span = 200 * model.critical_step
                model.step(model.init(), (PRESS,), (PRESS,), 2 * model.critical_step)
                began = process_time()
                model.step(model.init(), (PRESS,), (PRESS,), span)
                seconds = (process_time() - began) / span
                print(
                    f"{tissue.name:13} {'damped' if damped else 'undamped':9} resolution {resolution:g}: critical step "
                    f"{model.critical_step:.2g} s, {1 / model.critical_step:.2g} steps, {seconds:.2g} s of computing",
                    flush=True,
                )


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--quick", action="store_true", help="coarse resolutions alone")
    quick = parser.parse_args().quick
    equilibria("base", [0.75, 1.0, 1.5, 2.0] if quick else [0.75, 1.0, 1.5, 2.0, 3.0, 4.0])
    equilibria("edges", [0.75, 1.0, 1.5, 2.0])
    taps([1.0] if quick else [1.0, 1.5, 2.0])
    cuts([1.0] if quick else [1.0, 1.5, 2.0])
    explicit_costs()


if __name__ == "__main__":
    main()
