"""Run the whole validation study and gather what the report shows."""

from __future__ import annotations

import platform
from collections.abc import Callable
from dataclasses import dataclass, replace
from importlib.metadata import version
from time import perf_counter

import numpy as np

from trocar.model import Support
from trocar.reference.block import MeshSize
from trocar.reference.fea import FEASolid
from trocar.study.cases.experiment import Case
from trocar.study.compare import Comparison, compare
from trocar.study.cost.warm_up import compile_models
from trocar.study.deflection import deflections, search_points
from trocar.study.film import Film, press_and_release
from trocar.study.models import COARSE_MESH, MODELS, QUICK_MODELS, AnyModel
from trocar.study.plan import Plan
from trocar.study.statistics.curves import CurveComparison, compare_curves
from trocar.study.statistics.uncertainty import Refinement, Validation, refinement, validation
from trocar.study.surface import Surface, surface
from trocar.study.validity import DIAMETERS, ValidityMap, validity_map
from trocar.waves.solid import WaveSolid

REFERENCE = "fea"
MODEL = "wave-solid"
JUDGED = ("wave-solid", "wave-membrane")
MARGIN = 0.05  # of the reference's largest deflection: half the 10 % change of force a hand just notices
BLOCK = "block"  # the name under which the largest deflection of any layer is kept

Watch = Callable[[str, float], None]


@dataclass(frozen=True, kw_only=True)
class Numerics:
    """How well one layer's largest deflection is known, and what is left between the models [m]."""

    reference: Refinement
    model: Refinement
    comparison: Validation


@dataclass(frozen=True, kw_only=True)
class Strength:
    """The largest von Mises stress of a layer beside what it bears [Pa]."""

    at_small: float
    at_peak: float
    tensile_strength: float


@dataclass(frozen=True, kw_only=True)
class Study:
    """Everything the validation study found.

    Attributes:
        plan: what was asked for.
        small: the load inside the linear range, through all models.
        paper: the paper's load, the same.
        supports: the small load under each support.
        tilted, pair, tap: the other cases.
        agreement: for "small" and "paper", for each judged model, for each layer and the block.
        numerics: of each layer under the small load.
        strength: of each layer.
        validity: the wave models' error over force and tool, at large deflection.
        surfaces: pictures of `WaveSolid` by case: "small", "tilted", "pair".
        film: press and release.
        compile_seconds: spent compiling before anything was timed [s].
        seconds: of the whole study, wall clock [s].
        machine: processor and versions.
    """

    plan: Plan
    small: Comparison
    paper: Comparison
    supports: dict[Support, Comparison]
    tilted: Comparison
    pair: Comparison
    tap: Comparison
    agreement: dict[str, dict[str, dict[str, CurveComparison]]]
    numerics: dict[str, Numerics]
    strength: dict[str, Strength]
    validity: ValidityMap
    surfaces: dict[str, Surface]
    film: Film
    compile_seconds: float
    seconds: float
    machine: dict[str, str]

    @property
    def cases(self) -> dict[str, Comparison]:
        """The cases shown one by one, by the name they have in files."""
        return {
            "small": self.small,
            "paper": self.paper,
            "tilted": self.tilted,
            "pair": self.pair,
            "tap": self.tap,
        }


def run_study(plan: Plan, watch: Watch = lambda _what, _share: None) -> Study:
    """Run the study.

    Args:
        plan: the choices.
        watch: told what is being done and the share of all done, 0 to 1.

    Raises:
        InputError: the tissue or a number of the plan is impossible.
        SolverError: a model could not be solved.
    """
    began = perf_counter()
    watch("compiling", 0.0)
    compiled = compile_models()
    builders = QUICK_MODELS if plan.quick else MODELS
    watch("press in the middle", 0.02)
    small = compare(plan.central(plan.small), (*JUDGED, REFERENCE), builders=builders)
    paper = compare(plan.central(plan.peak), (*JUDGED, REFERENCE), builders=builders)
    supports = {}
    for i, support in enumerate(Support):
        watch(f"support {support.value}", 0.1 + 0.05 * i)
        same = support is plan.support
        supports[support] = (
            small
            if same
            else compare(plan.central(plan.small, support), (*JUDGED, REFERENCE), builders=builders)
        )
    watch("tool at an angle", 0.25)
    tilted = compare(plan.tilted(), (MODEL, REFERENCE), builders=builders)
    watch("two tools", 0.35)
    pair = compare(plan.pair(), (MODEL, REFERENCE), builders=builders)
    watch("a tap, in time", 0.45)
    tap = compare(plan.tap(), (*JUDGED, REFERENCE), builders=builders)
    watch("refining meshes and modes", 0.65)
    numerics = _numerics(plan)
    watch("stresses", 0.75)
    strength = _strength(plan)
    watch("pressing hard", 0.78)
    validity = validity_map(
        plan.layers,
        size=small.case.size,
        support=plan.support,
        diameters=(plan.diameter,) if plan.quick else DIAMETERS,
        mesh=COARSE_MESH,
        progress=lambda share: watch("pressing hard", 0.78 + 0.15 * share),
    )
    watch("pictures", 0.93)
    surfaces = {
        name: _surface(case)
        for name, case in (("small", small.case), ("tilted", tilted.case), ("pair", pair.case))
    }
    film = press_and_release(plan)
    watch("done", 1.0)
    return Study(
        plan=plan,
        small=small,
        paper=paper,
        supports=supports,
        tilted=tilted,
        pair=pair,
        tap=tap,
        agreement={"small": _agreement(small), "paper": _agreement(paper)},
        numerics=numerics,
        strength=strength,
        validity=validity,
        surfaces=surfaces,
        film=film,
        compile_seconds=compiled,
        seconds=perf_counter() - began,
        machine=_machine(),
    )


def _agreement(comparison: Comparison) -> dict[str, dict[str, CurveComparison]]:
    reference = comparison[REFERENCE]
    table: dict[str, dict[str, CurveComparison]] = {}
    for name in JUDGED:
        model = comparison[name]
        curves = {
            layer: (reference.deflection[layer], model.deflection[layer]) for layer in reference.deflection
        }
        curves[BLOCK] = (reference.block, model.block)
        table[name] = {
            layer: compare_curves(reference.time, reference.force, one, two, margin=MARGIN * float(one.max()))
            for layer, (one, two) in curves.items()
        }
    return table


def _numerics(plan: Plan) -> dict[str, Numerics]:
    """Refine both models three times; sizes are relative to the finest."""
    case = plan.central(plan.small)
    load = case.load_at(case.tools[0].ramp_time)
    sizes = (2.0, 1.5, 1.0) if plan.quick else (2.0, 2**0.5, 1.0)
    fine = 1.0 if plan.quick else 0.75

    def reference(size: float) -> AnyModel:
        base = COARSE_MESH if plan.quick else MeshSize()
        scale = size * fine
        mesh = replace(
            base,
            per_radius=base.per_radius / scale,
            growth=base.growth * scale,
            top=base.top * scale,
            deepening=base.deepening * scale,
            side=base.side * scale,
        )
        return FEASolid(case.tissue, size=case.size, support=case.support, around=load, mesh=mesh)

    def model(size: float) -> AnyModel:
        modes = round(128 / size)
        return WaveSolid(case.tissue, size=case.size, support=case.support, modes=(modes, modes))

    points = search_points(case.size, load)
    layers = case.tissue.layer_names

    def depth(model: AnyModel) -> np.ndarray:
        result: np.ndarray = deflections(model, model.static(load), points, layers).max(axis=1)
        return result

    by_mesh = np.array([depth(reference(size)) for size in sizes])
    by_modes = np.array([depth(model(size)) for size in sizes])
    table = {}
    for i, layer in enumerate(layers):
        one, two = refinement(by_mesh[:, i].tolist(), sizes), refinement(by_modes[:, i].tolist(), sizes)
        difference = validation(
            float(by_modes[-1, i]), float(by_mesh[-1, i]), one.standard_uncertainty, two.standard_uncertainty
        )
        table[layer] = Numerics(reference=one, model=two, comparison=difference)
    return table


def _strength(plan: Plan) -> dict[str, Strength]:
    case = plan.central(plan.small)
    load = case.load_at(case.tools[0].ramp_time)
    model = FEASolid(case.tissue, size=case.size, support=case.support, around=load)
    scale = plan.peak / plan.small
    small = model.stress(model.static(load))
    large = model.stress(model.static(tuple(press.with_force(scale * press.force) for press in load)))
    return {
        layer.name: Strength(
            at_small=small[layer.name], at_peak=large[layer.name], tensile_strength=layer.tensile_strength
        )
        for layer in case.tissue.layers
    }


def _surface(case: Case) -> Surface:
    model = WaveSolid(case.tissue, size=case.size, support=case.support)
    return surface(model, model.static(case.load_at(case.tools[0].ramp_time)))


def _machine() -> dict[str, str]:
    return {
        "processor": platform.processor() or platform.machine(),
        "system": f"{platform.system()} {platform.machine()}",
        "python": platform.python_version(),
        **{package: version(package) for package in ("numpy", "scipy", "numba", "scikit-fem")},
    }
