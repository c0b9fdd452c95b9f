"""Print how fine the finite elements are.

First table: one block on three nested meshes, with Richardson's limit. Second: the default mesh against it
refined once (8 times the elements), for the supports, tools and moduli of the comparison; `--fine` takes
minutes and, with SciPy's solver, gigabytes, so it wants the extra `trocar[pardiso]`.
"""

from __future__ import annotations

import argparse
import time
from math import isnan

from trocar.model import Press
from trocar.reference import FEASolid, MeshSize
from trocar.reference.convergence import refine
from trocar.tissues import Layer, Tissue

SIZE = (0.06, 0.06)
COARSE = MeshSize(per_radius=1.0, growth=1.2, top=0.6, deepening=1.2, side=0.5)
CASES = (  # moduli of epidermis, dermis, fat [kPa]; Poisson's ratio; fat [mm]; tool diameter [mm]
    ((1000, 500, 10), 0.48, 10, 8),
    ((500, 35, 2), 0.48, 5, 5),
    ((4000, 1000, 2), 0.49, 20, 6),
    ((1000, 200, 5), 0.48, 15, 8),
    ((4000, 35, 20), 0.49, 5, 8),
)


def skin(moduli: tuple[float, ...], poisson_ratio: float, fat: float) -> Tissue:
    """Layers of 0.1 mm, 1 mm and `fat` mm."""
    named = zip(("epidermis", "dermis", "fat"), (0.1, 1.0, fat), moduli, (1100, 1100, 950), strict=True)
    return Tissue(
        layers=tuple(
            Layer(
                name=name, thickness=h / 1e3, young_modulus=1e3 * E, poisson_ratio=poisson_ratio, density=rho
            )
            for name, h, E, rho in named
        )
    )


def main() -> None:
    """Print both tables."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--fine", action="store_true", help="the second table too")
    choice = parser.parse_args()
    press = Press(x=0.03, y=0.03, radius=0.004, force=0.1)
    print("three nested meshes, 0.1 N on 8 mm, skin 1000/500/10 kPa, fat 10 mm")
    print(f"{'support':12} {'layer':10} {'dofs':>20}  [mm] coarse, medium, fine, limit; order; error")
    for support in ("base", "edges+base", "edges"):
        found, dofs = refine(skin(*CASES[0][:3]), size=SIZE, support=support, load=(press,), mesh=COARSE)
        for name, result in found.items():
            values = " ".join(f"{1e3 * value:.5f}" for value in (*result.values, result.limit))
            order = "not steady" if isnan(result.order) else f"{result.order:.1f}"
            print(
                f"{support:12} {name:10} {'/'.join(map(str, dofs)):>20}  {values}; {order}; "
                f"{100 * result.uncertainty / result.values[-1]:.3f} %"
            )
    if not choice.fine:
        return
    print("\ndefault mesh against it refined once, [%] of each layer's largest deflection")
    for support in ("base", "edges+base", "edges"):
        for moduli, nu, fat, diameter in CASES:
            press = Press(x=0.03, y=0.03, radius=diameter / 2e3, force=0.1)
            found, dofs, seconds = [], [], []
            for refinement in (0, 1):
                start = time.process_time()
                mesh = MeshSize(refinement=refinement)
                tissue = skin(moduli, nu, fat)
                model = FEASolid(tissue, size=SIZE, support=support, around=(press,), mesh=mesh)
                found.append(model.largest_deflection(model.static((press,))))
                dofs.append(model.dofs)
                seconds.append(time.process_time() - start)
            errors = " ".join(f"{100 * (found[0][name] / found[1][name] - 1):+.3f}" for name in found[0])
            case = f"{'/'.join(map(str, moduli))} kPa, nu {nu}, fat {fat} mm, tool {diameter} mm"
            print(
                f"{support:12} {case:50} {errors}  {dofs[0]}/{dofs[1]} dofs, "
                f"{seconds[0]:.2f}/{seconds[1]:.1f} s, {model.solver_name}",
                flush=True,
            )


if __name__ == "__main__":
    main()
