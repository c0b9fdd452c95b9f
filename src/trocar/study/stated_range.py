"""Which cases each model is stated for, linearity aside; the figures are in docs/explanation/range-of-validity.md."""

from __future__ import annotations

from collections.abc import Mapping
from math import inf

from trocar.model import Profile
from trocar.reference.stress import Deformation
from trocar.study.cases.experiment import Case
from trocar.tissues import Fibre
from trocar.units import MILLIMETRE
from trocar.waves.clamped import SIDE_MODES
from trocar.waves.cutoff import modes_for
from trocar.waves.stretch.moduli import (
    DEEPEST,
    LEAST_CONTRAST,
    MOST_CONTRAST,
    THICKEST,
    TOOLS,
    contrast,
    stretching_layers,
)

LARGEST_FIT_ERROR = 0.05  # what the study asks of fitted membranes
LEAST_GAP = 3.0  # from a tool's rim to a clamped side, in the shortest half waves that resolve it: 1 % beyond
LEAST_STRETCH = 0.3  # of tissue squeezed under large deformation: no law here was fitted to less
_SHARE_LEFT_OUT = 0.05  # by the rule's envelope, of a membrane's series that was cut off

MEMBRANE = "wave-membrane"
WAVES = (MEMBRANE, "wave-solid")


def departures(
    case: Case,
    model: str,
    *,
    fit_error: float,
    modes: tuple[int, int] | None,
    deformation: Mapping[str, Deformation] | None = None,
    dent: float | None = None,
) -> tuple[str, ...]:
    """Return why a model is not stated for a case, a clause each; empty where it is.

    Args:
        case: the experiment.
        model: its name.
        fit_error: how far a fitted model missed what it was fitted to [1].
        modes: highest m and n of its series; None where it has none.
        deformation: of each layer at its largest, where the model follows large deformation.
        dent: the largest deflection [m], of waves that stiffen.
    """
    found = []
    for name, layer in (deformation or {}).items():
        if layer.stretch[0] < LEAST_STRETCH:
            found.append(
                f"{name} is squeezed to {layer.stretch[0]:.2g} of its length, and below {LEAST_STRETCH:g} its law "
                "is no measurement"
            )
    if dent is not None:
        found += _beyond_the_sheet(case, model, dent)
    elif model in (*WAVES, "wave-mesh") and any(isinstance(layer.law, Fibre) for layer in case.tissue.layers):
        found.append("it leaves the fibres out, taking every law as linear")
    if model in WAVES and case.support.sides_clamped:
        if case.sampling.dynamic:
            found.append("clamped sides hold moving waves without inertia of their own")
        least = LEAST_GAP * max(side / m for side, m in zip(case.size, SIDE_MODES, strict=True))
        if _nearest_rim(case) < least:
            found.append(f"a tool's rim is nearer to a clamped side than {least / MILLIMETRE:.3g} mm")
    if model == MEMBRANE:
        if case.sampling.dynamic:
            found.append("membranes are fitted to slow loads")
        if fit_error > LARGEST_FIT_ERROR:
            found.append(f"the fitted membranes miss the layered solid by {100 * fit_error:.0f} %")
        radius = min(tool.diameter / 2 for tool in case.tools)
        wanted = modes_for(radius, Profile.FLAT, case.size, _SHARE_LEFT_OUT)
        if (
            modes is not None
            and not case.rigid
            and any(has < asked for has, asked in zip(modes, wanted, strict=True))
        ):
            found.append(f"the tool needs {max(wanted)} modes a side, and the membranes have {max(modes)}")
    return tuple(found)


def _beyond_the_sheet(case: Case, model: str, dent: float) -> list[str]:
    """Return why waves that stiffen are not stated for a case: `bench/stiffening.py` shows how far they go."""
    found = []
    tissue, support = case.tissue, case.support
    share = dent / tissue.thickness
    if share > DEEPEST:
        found.append(
            f"the dent is {100 * share:.0f} % of the thickness deep, beyond the third they are stated for"
        )
    stiffer = contrast(tissue, support)
    if stiffer < LEAST_CONTRAST:
        found.append(
            f"the sheet is {stiffer:.2g} times stiffer than its bed, and below {LEAST_CONTRAST:g} the bed softens "
            "more than the sheet stiffens"
        )
    if model == MEMBRANE and MOST_CONTRAST < stiffer < inf:
        found.append(f"the sheet is {stiffer:.3g} times stiffer than its bed, beyond {MOST_CONTRAST:g}")
    thickness = sum(layer.thickness for layer in stretching_layers(tissue, support)) / tissue.thickness
    if support.base_held and thickness > THICKEST:
        found.append(f"the layers above the bed are {100 * thickness:.0f} % of the thickness, no thin sheet")
    widths = [tool.diameter for tool in case.tools]
    if min(widths) < TOOLS[0] or max(widths) > TOOLS[1]:
        found.append(
            f"stiffening waves are stated for tools of {TOOLS[0] / MILLIMETRE:g} to {TOOLS[1] / MILLIMETRE:g} mm"
        )
    if any(isinstance(layer.law, Fibre) for layer in tissue.layers):
        found.append("of fibres it takes what they bear at small stretch, and in the stretched sheet alone")
    return found


def _nearest_rim(case: Case) -> float:
    """Return the least distance of a tool's rim from a side [m], the tool taken as upright."""
    return min(
        min(centre, side - centre) - tool.diameter / 2
        for tool in case.tools
        for centre, side in zip(tool.position, case.size, strict=True)
    )
