"""Accuracy against cost: every model from coarse to fine, on a static, a dynamic and a large-force case.

Error: of the worst layer's largest deflection, or of the swing under the tool, against fine finite elements.
Cost: CPU time for a simulated second of a trainer that ticks every millisecond: a thousand equilibria of a tool that
slides (static) or presses deeper (large), or as many steps as the model needs (dynamic). Set-up is apart.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from functools import partial
from time import process_time
from typing import Any

import numpy as np

from trocar.errors import TrocarError
from trocar.model import FloatArray, Load, Press
from trocar.reference.block import MeshSize
from trocar.reference.fea import FEASolid
from trocar.reference.mesh_free.mesh_free import MeshFree, Stepping
from trocar.reference.springs.mass_spring import MassSpring, lattice_size
from trocar.study.deflection import deflections, search_points
from trocar.study.half_sine import DURATION, half_sine
from trocar.study.stiffening import Dent, neo_hookean, reference_curve
from trocar.waves.membrane import WaveMembrane
from trocar.waves.mesh.block import block_mesh, lines_around
from trocar.waves.mesh.wave_mesh import WaveMesh
from trocar.waves.solid import WaveSolid
from trocar.waves.stretch.stretching_waves import StretchingWaves

STATIC, DYNAMIC, LARGE = "static", "dynamic", "large force"
CASES = (STATIC, DYNAMIC, LARGE)
SMALL = 0.02  # [N] of the static press and the peak of the dynamic one
_TICKS = 1000  # a second
_SLIDE = 1e-4  # [m] a tick
_FORCES = 4  # equilibria on the way to the large force
_TIMED = 5  # equilibria or steps that are timed
_LONGEST = 60.0  # [s] a trial may take before its model's finer ones are left out
_REFERENCE = MeshSize(per_radius=4.0, growth=0.4, top=0.2, deepening=0.4)

Build = Callable[[Dent, bool], Any]  # the case, and whether inertia is left out


@dataclass(frozen=True, kw_only=True)
class Point:
    """One model at one resolution in one case.

    Attributes:
        case: "static", "dynamic" or "large force".
        model: its name.
        setting: how fine.
        error: relative to the reference, of the worst layer or instant [1]; None where it could not be computed.
        second_s: CPU time for a simulated second [s].
        set_up_s: CPU time before the first answer [s].
        dofs: unknowns solved for.
        failure: why there is no answer; empty where there is one.
    """

    case: str
    model: str
    setting: str
    error: float | None
    second_s: float
    set_up_s: float
    dofs: int
    failure: str = ""

    def as_dict(self) -> dict[str, object]:
        """Return plain values for JSON."""
        return asdict(self)


def _membrane(modes: int, dent: Dent, massless: bool) -> Any:
    tissue = dent.tissue
    waves = WaveMembrane.fitted(
        tissue, size=dent.size, support=dent.support, modes=(modes, modes), massless=massless
    )
    return StretchingWaves.of(waves, tissue) if tissue.large_deformation else waves


def _solid(modes: int, dent: Dent, massless: bool) -> Any:
    tissue, moving = dent.tissue, min(modes, 48)
    waves = WaveSolid(
        tissue,
        size=dent.size,
        support=dent.support,
        modes=(modes, modes),
        dynamic_modes=(moving, moving),
        massless=massless,
    )
    return StretchingWaves.of(waves, tissue) if tissue.large_deformation else waves


def _mesh(coarser: float, dent: Dent, massless: bool) -> Any:
    lines = lines_around(dent.tissue, dent.size, dent.load(1.0), support=dent.support, coarser=coarser)
    return WaveMesh(block_mesh(dent.tissue, lines, support=dent.support))


def _fea(per_radius: float, dent: Dent, massless: bool) -> Any:
    size = MeshSize(
        per_radius=per_radius, growth=1.2 / per_radius, top=0.8 / per_radius, deepening=1.4 / per_radius
    )
    return FEASolid(
        dent.tissue, size=dent.size, support=dent.support, around=dent.load(1.0), mesh=size, massless=massless
    )


def _springs(per_radius: float, dent: Dent, massless: bool) -> Any:
    return MassSpring(
        dent.tissue,
        size=dent.size,
        support=dent.support,
        around=dent.load(1.0),
        mesh=lattice_size(per_radius),
        linearised=not dent.tissue.large_deformation,
        massless=massless,
    )


def _mesh_free(resolution: float, dent: Dent, massless: bool) -> Any:
    return MeshFree(
        dent.tissue,
        size=dent.size,
        support=dent.support,
        around=dent.load(1.0),
        resolution=resolution,
        stepping=Stepping.EXPLICIT if dent.tissue.large_deformation else Stepping.IMPLICIT,
        massless=massless,
    )


def _ladder(
    build: Callable[[Any, Dent, bool], Any], words: str, rungs: Sequence[float]
) -> list[tuple[str, Build]]:
    return [(f"{rung:g} {words}", partial(build, rung)) for rung in rungs]


LADDERS: Mapping[str, list[tuple[str, Build]]] = {
    "wave-membrane": _ladder(_membrane, "modes a side", (12, 16, 24, 32, 48, 64)),
    "wave-solid": _ladder(_solid, "modes a side", (12, 16, 24, 32, 48, 64, 96, 128)),
    "wave-mesh": _ladder(_mesh, "times coarser", (3.0, 2.0, 1.5, 1.0)),
    "fea": _ladder(_fea, "elements a radius", (0.75, 1.0, 1.5, 2.0, 3.0)),
    "mass-spring": _ladder(_springs, "boxes a radius", (1.5, 2.0, 3.0, 4.0, 6.0, 8.0)),
    "mesh-free": _ladder(_mesh_free, "times as fine", (0.6, 0.8, 1.0, 1.5, 2.0)),
}
_LINEAR_ONLY = ("wave-mesh",)


@dataclass(frozen=True, kw_only=True)
class Trial:
    """A case with its answer.

    Attributes:
        name: of the case.
        dent: tissue, block and tool.
        load: at its largest.
        answer: what the reference found: deflection of every layer [m], or the swing [m], every `half_sine.SAMPLE`.
    """

    name: str
    dent: Dent
    load: Load
    answer: FloatArray


def accuracy_against_cost(
    dent: Dent,
    *,
    cases: Sequence[str] = CASES,
    models: Sequence[str] = tuple(LADDERS),
    rungs: int | None = None,
    watch: Callable[[str, float], None] = lambda _what, _share: None,
) -> Iterator[Point]:
    """Run every model of every case from coarse to fine, and yield each as it is done.

    Args:
        dent: tissue, block and tool; laws are taken as linear, and under large force as they are or neo-Hookean;
            what layers remember is left out.
        cases: which.
        models: by name, of `LADDERS`.
        rungs: how many resolutions of each model, the coarsest first; all where None.
        watch: told what is being done, and the share of all done.
    """
    done, count = 0, len(cases) * (1 + len(models))
    for name in cases:
        watch(f"{name}: reference", done / count)
        trial = trial_of(name, dent)
        done += 1
        for model in models:
            if name == LARGE and model in _LINEAR_ONLY:
                done += 1
                continue
            yield from climb(trial, model, rungs=rungs, watch=partial(_tell, watch, done / count))
            done += 1
    watch("done", 1.0)


def climb(
    trial: Trial, model: str, *, rungs: int | None = None, watch: Callable[[str], None] = lambda _what: None
) -> Iterator[Point]:
    """Run one model of a case from coarse to fine, and yield each resolution as it is done.

    Args:
        trial: the case.
        model: by name, of `LADDERS`.
        rungs: how many resolutions, the coarsest first; all where None.
        watch: told what is being done.
    """
    for setting, build in LADDERS[model][:rungs]:
        watch(f"{trial.name}: {model}, {setting}")
        began = process_time()
        yield _point(trial, model, setting, build)
        if process_time() - began > _LONGEST:
            break


def _tell(watch: Callable[[str, float], None], share: float, what: str) -> None:
    watch(what, share)


def trial_of(name: str, dent: Dent) -> Trial:
    """Return a case of a dent, with the answer of fine finite elements.

    Args:
        name: "static", "dynamic" or "large force".
        dent: as of `accuracy_against_cost`.
    """
    if name == LARGE:
        hard = replace(dent, tissue=neo_hookean(dent.tissue.long_term))
        curve = reference_curve(hard)
        return Trial(
            name=name, dent=hard, load=hard.load(float(curve.force[-1])), answer=curve.deflection[-1]
        )
    soft = replace(dent, tissue=dent.tissue.linearised.long_term)
    load = soft.load(SMALL)
    reference = FEASolid(soft.tissue, size=soft.size, support=soft.support, around=load, mesh=_REFERENCE)
    answer = _swing(reference, load[0]) if name == DYNAMIC else _depths(reference, soft, load)
    return Trial(name=name, dent=soft, load=load, answer=answer)


def _point(trial: Trial, model: str, setting: str, build: Build) -> Point:
    began = process_time()
    try:
        made = build(trial.dent, trial.name != DYNAMIC)
        if trial.name == DYNAMIC:
            answer, set_up, second = _moving(made, trial, began)
            error = float(np.abs(answer - trial.answer).max() / np.abs(trial.answer).max())
        else:
            answer, set_up, second = _standing(made, trial, began)
            error = float(np.abs(answer / trial.answer - 1).max())
    except TrocarError as problem:
        return Point(
            case=trial.name,
            model=model,
            setting=setting,
            error=None,
            second_s=0.0,
            set_up_s=process_time() - began,
            dofs=0,
            failure=str(problem),
        )
    return Point(
        case=trial.name,
        model=model,
        setting=setting,
        error=error,
        second_s=second,
        set_up_s=set_up,
        dofs=made.dofs,
    )


def _standing(model: Any, trial: Trial, began: float) -> tuple[FloatArray, float, float]:
    """Return every layer's deflection, the time to the first answer and the time of a second's equilibria."""
    (press,) = trial.load
    if trial.name == LARGE:
        first, *others = (
            press.with_force(press.force * share) for share in np.arange(1, _FORCES + 1) / _FORCES
        )
    else:
        first, *others = (replace(press, x=press.x + _SLIDE * i) for i in range(_TIMED + 1))
    model.displacement(model.static((first,)), _under(press))
    ready = process_time()
    for one in others:
        model.displacement(model.static((one,)), _under(press))
    taken = process_time() - ready
    return _depths(model, trial.dent, trial.load), ready - began, _TICKS * taken / len(others)


def _moving(model: Any, trial: Trial, began: float) -> tuple[FloatArray, float, float]:
    """Return the swing, the time to the first step's end and the time of a second's steps."""
    (press,) = trial.load
    dt = min(model.longest_step, 1 / _TICKS)
    state = model.step(model.init(), trial.load, trial.load, dt)
    model.displacement(state, _under(press))
    ready = process_time()
    for _ in range(_TIMED):
        state = model.step(state, trial.load, trial.load, dt)
        model.displacement(state, _under(press))
    taken = process_time() - ready
    return _swing(model, press), ready - began, taken / (_TIMED * dt)


def _depths(model: Any, dent: Dent, load: Load) -> FloatArray:
    points = search_points(dent.size, load)
    result: FloatArray = deflections(model, model.static(load), points, model.layer_names).max(axis=1)
    return result


def _swing(model: Any, press: Press) -> FloatArray:
    curves = half_sine({"model": model}, press)
    return curves["model"][curves["time"] <= 2 * DURATION]


def _under(press: Press) -> FloatArray:
    return np.array([[press.x, press.y, 0.0]])
