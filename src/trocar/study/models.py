"""The models a case can be run through, by name."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import ceil
from typing import Any

from trocar.errors import InputError
from trocar.model import Profile, TissueModel
from trocar.reference.block import MeshSize
from trocar.reference.fea import FEASolid
from trocar.reference.mesh_free.mesh_free import MeshFree, Stepping
from trocar.reference.springs.mass_spring import MassSpring, lattice_size
from trocar.study.cases.experiment import Case
from trocar.waves.cutoff import modes_for
from trocar.waves.fit import RADII
from trocar.waves.membrane import WaveMembrane
from trocar.waves.mesh.block import block_mesh, lines_around
from trocar.waves.mesh.wave_mesh import WaveMesh
from trocar.waves.solid import WaveSolid
from trocar.waves.stretch.moduli import stretching_layers
from trocar.waves.stretch.stretching_waves import StretchingWaves

AnyModel = TissueModel[Any]
LEAST_MODES, MOST_MODES = 48, 512  # a side; 512 x 512 wavenumbers of three layers fill 100 MiB
STIFFENING_MODES = (48, 48)  # of `WaveSolid`, that stretch the sheet
MOST_MEMBRANE_MODES = 128  # membranes answer short waves less than elastic blocks do
_SHARE_LEFT_OUT = (
    0.004  # by the rule's envelope; of a homogeneous block a quarter of it is missing, of skin far less
)
_RIGID_HALF_WAVE, _MOST_RIGID_MODES = 1e-3, 128
_MOST_LEFT_OUT = 0.1  # where MOST_MODES is not enough: 2 % is missing
_RESOLUTION = 2.0  # of the mesh-free model: within 1.3 % (`bench/mesh_free.py`)
_COARSE_RESOLUTION = 1.5  # within 4.1 %
_MOST_EXPLICIT_STEPS = 2e6  # an hour or two


def _wave_membrane(case: Case) -> AnyModel:
    widest = max(tool.diameter / 2 for tool in case.tools)
    smallest = min(tool.diameter / 2 for tool in case.tools)
    radii = RADII
    (m, n), most = series_modes(case), MOST_MEMBRANE_MODES
    if not (RADII[0] <= smallest and widest <= RADII[-1]):
        radii = (0.75 * smallest, smallest, widest, 1.5 * widest)
    membrane = WaveMembrane.fitted(
        case.tissue,
        size=case.size,
        support=case.support,
        modes=(min(m, most), min(n, most)),
        radii=radii,
        massless=not case.sampling.dynamic,
    )
    return _stiffening(case, membrane)


def _wave_solid(case: Case) -> AnyModel:
    solid = WaveSolid(
        case.tissue,
        size=case.size,
        support=case.support,
        modes=series_modes(case),
        dynamic_modes=STIFFENING_MODES if case.tissue.large_deformation else (32, 32),
        massless=not case.sampling.dynamic,
    )
    return solid if case.support.sides_clamped else _stiffening(case, solid)


def _stiffening(case: Case, linear: WaveMembrane | WaveSolid) -> AnyModel:
    """Return waves that stiffen where layers have laws for large strain and one of them is a sheet."""
    sheet = stretching_layers(case.tissue, case.support)
    if case.rigid or not (case.tissue.large_deformation and sheet):
        return linear
    return StretchingWaves.of(linear, case.tissue)


def _wave_mesh(case: Case) -> AnyModel:
    if case.mesh is not None:
        return WaveMesh(case.mesh, massless=not case.sampling.dynamic)
    lines = lines_around(case.tissue, case.size, case.load_at(0.0), support=case.support)
    mesh = block_mesh(case.tissue, lines, support=case.support)
    return WaveMesh(mesh, massless=not case.sampling.dynamic)


def series_modes(case: Case) -> tuple[int, int]:
    """Return how many modes a case's smallest tool needs; the rule for a flat tool is an upper bound.

    Under a rigid tip shorter waves are counted otherwise (`waves.pads`), and half waves of a millimetre are enough.

    Raises:
        InputError: the tool is too small for the block.
    """
    if case.rigid:
        m, n = (min(max(ceil(side / _RIGID_HALF_WAVE), LEAST_MODES), _MOST_RIGID_MODES) for side in case.size)
        return m, n
    radius = min(tool.diameter / 2 for tool in case.tools)
    wanted = modes_for(radius, Profile.FLAT, case.size, _SHARE_LEFT_OUT)
    least = modes_for(radius, Profile.FLAT, case.size, _MOST_LEFT_OUT)
    if max(least) > MOST_MODES:
        raise InputError(
            "tool: diameter",
            f"at least {2e3 * radius * max(least) / MOST_MODES:.3g} mm on so large a block, for the wave models",
            2e3 * radius,
            "take a smaller block",
        )
    m, n = (min(max(modes, LEAST_MODES), MOST_MODES) for modes in wanted)
    return m, n


def _fea(case: Case) -> AnyModel:
    return _finite_elements(case, None)


def _coarse_fea(case: Case) -> AnyModel:
    return _finite_elements(case, COARSE_MESH)


def _finite_elements(case: Case, mesh: MeshSize | None) -> AnyModel:
    return FEASolid(
        case.tissue,
        size=case.size,
        support=case.support,
        around=case.load_at(0.0),
        mesh=mesh,
        massless=not case.sampling.dynamic,
    )


def _mass_spring(case: Case) -> AnyModel:
    return _springs(case, lattice_size())


def _coarse_mass_spring(case: Case) -> AnyModel:
    return _springs(case, COARSE_LATTICE)


def _springs(case: Case, mesh: MeshSize) -> AnyModel:
    """Make springs that turn where the case's laws hold at large strain, and not where it asks for small strain."""
    return MassSpring(
        case.tissue,
        size=case.size,
        support=case.support,
        around=case.load_at(0.0),
        mesh=mesh,
        linearised=not case.tissue.large_deformation,
        massless=not case.sampling.dynamic,
    )


def _mesh_free(case: Case) -> AnyModel:
    return _element_free(case, _RESOLUTION)


def _coarse_mesh_free(case: Case) -> AnyModel:
    return _element_free(case, _COARSE_RESOLUTION)


def _element_free(case: Case, resolution: float) -> AnyModel:
    """Linear layers move in implicit time: thin stiff ones make the steps of explicit time too short."""
    large = case.tissue.large_deformation
    model = MeshFree(
        case.tissue,
        size=case.size,
        support=case.support,
        around=case.load_at(0.0),
        resolution=resolution,
        mirrored=_in_the_middle(case),
        stepping=Stepping.EXPLICIT if large else Stepping.IMPLICIT,
        massless=not case.sampling.dynamic,
    )
    if case.sampling.dynamic and large and case.duration > _MOST_EXPLICIT_STEPS * model.critical_step:
        raise InputError(
            "sampling: dynamic",
            f"at most {_MOST_EXPLICIT_STEPS * model.critical_step:.3g} s in explicit time, for the mesh-free model "
            "with neo-hookean layers",
            case.duration,
            f"its steps are {model.critical_step:.2g} s long; take linear layers, a quasi-static case or fea",
        )
    return model


def _in_the_middle(case: Case) -> bool:
    middle = tuple(0.5 * side for side in case.size)
    return all((press.x, press.y) == middle and press.tilt == 0 for press in case.load_at(0.0))


COARSE_LATTICE = lattice_size(4.0)
COARSE_MESH = MeshSize(per_radius=2.0, growth=0.6, top=0.4, deepening=0.7, side=0.4)
MODELS: dict[str, Callable[[Case], AnyModel]] = {
    "wave-membrane": _wave_membrane,
    "wave-solid": _wave_solid,
    "wave-mesh": _wave_mesh,
    "fea": _fea,
    "mass-spring": _mass_spring,
    "mesh-free": _mesh_free,
}
ON_MESHES = ("wave-mesh",)
"""Models that take a case's mesh; the others are for blocks."""

QUICK_MODELS = {
    **MODELS,
    "fea": _coarse_fea,  # a fifth of the unknowns, within 1.5 % instead of 0.2 %
    "mass-spring": _coarse_mass_spring,  # a sixth of the unknowns, within 7 % instead of 2.2 %
    "mesh-free": _coarse_mesh_free,
}


def usual_models(case: Case) -> tuple[str, ...]:
    """Return the models a case is run through where none are named: finite elements take no rigid tip.

    `WaveSolid` takes no Prony series where sides are clamped.
    """
    if case.mesh is not None:
        return ON_MESHES
    if case.rigid:
        return ("wave-solid", "wave-membrane")
    clamped = case.support.sides_clamped and case.tissue.relaxation_times
    return ("wave-membrane" if clamped else "wave-solid", "fea")


def check_names(names: Sequence[str]) -> tuple[str, ...]:
    """Return the names, each once.

    Raises:
        InputError: there is none, or one is unknown.
    """
    known = ", ".join(MODELS)
    if not names:
        raise InputError("models", f"at least one of {known}", "none")
    for name in names:
        if name not in MODELS:
            raise InputError("models", f"one of {known}", name)
    return tuple(dict.fromkeys(names))
