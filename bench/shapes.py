"""How much the mesh of a shape matters: a nodule of whole elements, a wedge, the liver.

Run: python bench/shapes.py [--fine]. Each line is a mesh: its unknowns, and how far the compliance felt by a tool (the
displacement under it for 1 N) and the lowest frequency are from those of the last line, the finest. For the nodule it
is also given relative to what the nodule changes at all.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator

import numpy as np

from trocar import tissue
from trocar.model import Press
from trocar.tissues import Layer, Tissue
from trocar.waves.mesh.block import block_mesh
from trocar.waves.mesh.inclusion import with_inclusion
from trocar.waves.mesh.layered import layered_mesh
from trocar.waves.mesh.organ import Liver
from trocar.waves.mesh.solid_mesh import SolidMesh
from trocar.waves.mesh.wave_mesh import WaveMesh

SIDE, DEPTH, RADIUS, BELOW = 0.04, 0.02, 5e-3, 8e-3
FAT = Layer(name="fat", thickness=DEPTH, young_modulus=1e4, poisson_ratio=0.48, density=950)
NODULE = Layer(name="nodule", thickness=DEPTH, young_modulus=1e5, poisson_ratio=0.48, density=1050)
MIDDLE = Press(x=0.5 * SIDE, y=0.5 * SIDE, radius=4e-3, force=1.0)
ON_LIVER = Press(x=0.13, y=0.05, radius=6e-3, force=1.0)


def compliance(mesh: SolidMesh, press: Press) -> tuple[int, float, float]:
    """Return the unknowns, the work of 1 N over the displacement under it [m/N], and the lowest frequency [Hz]."""
    model = WaveMesh(mesh, modes=1)
    forces = model.nodal_forces(press)
    return model.dofs, float(forces @ model.matrices.answer(forces)), float(model.frequencies[0])


def around(middle: float, side: float, reach: float, inner: int, outer: int) -> np.ndarray:
    """Return lines from 0 to a side: even and close within reach of the middle, wider beyond."""
    low, high = max(middle - reach, 0.0), min(middle + reach, side)
    pieces = [np.linspace(low, high, inner + 1)]
    if low > 0:
        pieces.insert(0, np.linspace(0.0, low, outer + 1)[:-1])
    if high < side:
        pieces.append(np.linspace(high, side, outer + 1)[1:])
    return np.concatenate(pieces)


def nodules(fine: bool) -> Iterator[tuple[str, SolidMesh, SolidMesh]]:
    """Yield the block with its nodule, and without."""
    for inner in (4, 6, 8, 10, *((12,) if fine else ())):
        across = around(0.5 * SIDE, SIDE, 1.2 * RADIUS, inner, max(2, inner // 3))
        through = around(DEPTH - BELOW, DEPTH, 1.2 * RADIUS, inner, max(1, inner // 4)) - DEPTH
        plain = block_mesh(Tissue(layers=(FAT,)), (across, across, through))
        centre = 0.5 * SIDE, 0.5 * SIDE, -BELOW
        yield f"{inner / 2.4:.1f} a radius", with_inclusion(plain, centre, (RADIUS,) * 3, NODULE), plain


def wedges(fine: bool) -> Iterator[tuple[str, SolidMesh]]:
    """Yield a block whose base is plane and whose upper face slopes and bulges."""
    for count in (8, 12, 16, *((20,) if fine else ())):
        across, through = np.linspace(0, SIDE, count + 1), np.linspace(-DEPTH, 0, count // 2 + 1)
        mesh = layered_mesh(
            Tissue(layers=(FAT,)),
            (across, across, through),
            {"fat": lambda x, y: 0.012 + 0.2 * x + 0.003 * np.sin(np.pi * y / SIDE)},
        )
        yield f"{count} elements a side", mesh


def livers(fine: bool) -> Iterator[tuple[str, SolidMesh]]:
    """Yield the liver."""
    for spacing in (0.03, 0.02, 0.016, 0.0125, *((0.0105,) if fine else ())):
        yield f"{1e3 * spacing:g} mm", Liver().mesh(tissue("liver").layers[-1], spacing=spacing)


def closer_livers(fine: bool) -> Iterator[tuple[str, SolidMesh]]:
    """Yield the liver with shorter elements around the tool."""
    for spacing in (0.03, 0.025, 0.02, 0.0165, *((0.014,) if fine else ())):
        mesh = Liver().mesh(tissue("liver").layers[-1], spacing=spacing, around=(ON_LIVER.x, ON_LIVER.y))
        yield f"{1e3 * spacing:g} mm", mesh


def told(
    title: str, meshes: Callable[[bool], Iterator[tuple[str, SolidMesh]]], press: Press, fine: bool
) -> None:
    """Print a table."""
    found = [(name, *compliance(mesh, press)) for name, mesh in meshes(fine)]
    print(title)
    _, _, last, lowest = found[-1]
    for name, unknowns, value, frequency in found:
        print(
            f"  {name}: {unknowns} unknowns, {1e3 * value:.4f} mm/N, {100 * (value / last - 1):+.2f} %; "
            f"lowest mode {frequency:.3f} Hz, {100 * (frequency / lowest - 1):+.2f} %"
        )


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--fine", action="store_true", help="one finer mesh each: minutes")
    fine = parser.parse_args().fine
    print("nodule ten times as stiff, radius 5 mm, 8 mm deep")
    found = [
        (name, *compliance(with_it, MIDDLE)[:2], compliance(without, MIDDLE)[1])
        for name, with_it, without in nodules(fine)
    ]
    _, _, last, plain = found[-1]
    for name, unknowns, value, without in found:
        effect, truth = 1 - value / without, 1 - last / plain
        print(
            f"  {name}: {unknowns} unknowns, {1e3 * value:.4f} mm/N, {100 * (value / last - 1):+.2f} %; "
            f"it takes {100 * effect:.2f} % away, {100 * (effect / truth - 1):+.1f} % of that"
        )
    told("wedge that bulges", wedges, MIDDLE, fine)
    told("liver", livers, ON_LIVER, fine)
    told("liver, elements a third as long around the tool", closer_livers, ON_LIVER, fine)


if __name__ == "__main__":
    main()
