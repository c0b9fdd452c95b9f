"""How far a deflection is from that of an infinitely fine mesh, estimated from three nested meshes.

Richardson's extrapolation: with values c, m, f on meshes of spacing 4h, 2h, h and an error C h^p,

    2^p = (c - m) / (m - f),    limit = f + (f - m) / (2^p - 1)

(Roache 1998, Verification and Validation in Computational Science and Engineering, ch. 5).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import inf, log2, nan

from trocar.errors import InputError
from trocar.model import Load, Support
from trocar.reference.block import MeshSize
from trocar.reference.fea import FEASolid
from trocar.tissues import Tissue

_LARGEST_ORDER = 4.0  # quadratic elements converge no faster in displacement; a larger one is chance


@dataclass(frozen=True, kw_only=True)
class Richardson:
    """What three nested meshes tell.

    Args:
        values: from coarse to fine.
        order: p observed; nan where the values do not approach a limit steadily.
        limit: the value extrapolated to an infinitely fine mesh; the finest one's where order is nan.
        uncertainty: of the finest value, at least 0, in its unit.
    """

    values: tuple[float, float, float]
    order: float
    limit: float
    uncertainty: float


def richardson(coarse: float, medium: float, fine: float) -> Richardson:
    """Extrapolate values on meshes whose spacing is halved twice.

    Where they do not approach a limit steadily, the last change is taken for the uncertainty.
    """
    last, values = fine - medium, (coarse, medium, fine)
    if last == 0.0:
        return Richardson(values=values, order=inf, limit=fine, uncertainty=0.0)
    ratio = (medium - coarse) / last
    if ratio <= 1.0:
        return Richardson(values=values, order=nan, limit=fine, uncertainty=abs(last))
    order = log2(ratio)
    correction = last / (2.0 ** min(order, _LARGEST_ORDER) - 1.0)
    return Richardson(values=values, order=order, limit=fine + correction, uncertainty=abs(correction))


def refine(
    tissue: Tissue,
    *,
    size: tuple[float, float],
    support: Support | str,
    load: Load,
    mesh: MeshSize,
    solver: str = "auto",
) -> tuple[Mapping[str, Richardson], tuple[int, ...]]:
    """Solve a static load on a mesh and twice refined, and extrapolate each layer's largest deflection.

    Args:
        tissue: the layers.
        size: sides of the block [m].
        support: how the block is held.
        load: presses.
        mesh: the coarsest mesh; the finest has 64 times its elements.
        solver: as for `FEASolid`.

    Returns:
        By layer, the deflections [m]; and the unknowns of the three meshes.

    Raises:
        InputError: an argument is not possible, or the load is empty.
    """
    if not load:
        raise InputError("load", "at least one press", load)
    deflections, dofs = [], []
    for level in range(3):
        finer = replace(mesh, refinement=mesh.refinement + level)
        model = FEASolid(tissue, size=size, support=support, around=load, mesh=finer, solver=solver)
        deflections.append(model.largest_deflection(model.static(load)))
        dofs.append(model.dofs)
    found = {name: richardson(*(level[name] for level in deflections)) for name in tissue.layer_names}
    return found, tuple(dofs)
