"""Waves and finite elements at equal measured error: what a press costs either of them.

Each model is tried from coarse to fine; its error is measured against a converged answer, and the cheapest
setting that keeps to the tolerance is taken. Both use the same mirror symmetry: finite elements a quarter of
the block, waves odd modes only. The converged answer is a fine `WaveSolid`; a fine `FEASolid` says how far it
can be trusted.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, field
from functools import partial
from itertools import pairwise
from time import process_time

import numpy as np

from trocar.errors import SolverError
from trocar.model import FloatArray, Press, Support
from trocar.reference import FEASolid, MeshSize
from trocar.study.cost.clock import cpu_time
from trocar.tissues.tissue import Tissue
from trocar.waves.held_tool import hold
from trocar.waves.solid import WaveSolid

WAVE_LADDER = (
    (16, 6, 2),
    (24, 8, 2),
    (32, 10, 2),
    (48, 12, 2),
    (64, 16, 3),
    (96, 24, 3),
)  # static, moving, order
FEA_LADDER = (  # per radius, growth, top, deepening
    (1.0, 1.0, 0.5, 1.0),
    (1.0, 0.5, 0.5, 1.0),
    (1.5, 0.7, 0.4, 0.7),
    (1.5, 0.5, 0.3, 0.5),
    (2.0, 0.7, 0.4, 0.7),
    (2.0, 0.5, 0.3, 0.5),
    (3.0, 0.5, 0.2, 0.5),
    (4.0, 0.35, 0.15, 0.35),
)
Setting = tuple[float, float, float, float]
_RATE = 0.05  # [N/s] of the study
_FEA_STEP_LENGTHS = (2e-3, 1e-3, 0.5e-3)
_FINE_DT = 0.25e-3
STATIC_LADDER = (16, 24, 32, 48, 64, 96, 128)  # static modes
_FINE = (512, 64, 5, 2)  # the converged answer: static, moving modes, order, refinement
_QUICK = (160, 24, 4, 1)  # within 0.2 % of it
_QUICK_LADDER = 3  # rungs of the finite elements' ladder
_TRIALS = (
    400  # copies of a history in one timed batch of waves: one history is shorter than the clock can tell
)


@dataclass(frozen=True, kw_only=True)
class Trial:
    """One model at one setting.

    Attributes:
        model: "wave-solid" or "fea".
        setting: how fine: of waves the modes a side (in motion also how many move, and how many Ritz vectors each),
            of finite elements the elements a radius and their growth.
        error: largest, over the peak of the converged answer [1].
        dofs: what moves or is solved for: oscillators, or unknowns of the quarter.
        set_up_s: CPU time before the first step [s], compilation left out; of the whole job for a static
            case, whose other samples cost next to nothing once the first is known.
        step_us: CPU time of one step [us]; of the whole job for a static case.
        dt_ms: length of a step [ms]; 0 for a static case.
        solver: what solves the finite elements' equations.
    """

    model: str
    setting: str
    error: float
    dofs: int
    set_up_s: float
    step_us: float
    dt_ms: float = 0.0
    solver: str = ""


@dataclass(frozen=True, kw_only=True)
class EqualError:
    """What both models cost at one tolerance.

    Attributes:
        case: in words.
        tolerance: largest relative error allowed [1].
        converged: how far the two fine answers lie apart, over the peak [1].
        wave, fea: the cheapest setting of each that keeps to the tolerance.
        ratio: CPU time of the finite elements over that of the waves, per simulated time or per job.
        tried: every setting looked at.
    """

    case: str
    tolerance: float
    converged: float
    wave: Trial
    fea: Trial
    ratio: float
    tried: tuple[Trial, ...] = field(repr=False)

    def as_dict(self) -> dict[str, object]:
        """Return the fields, for JSON."""
        return asdict(self)


def half_sine(peak: float, length: float, dt: float, until: float) -> FloatArray:
    """Return a half-sine press [N] at the end of every step of length dt [s], shape (steps,)."""
    times = dt * np.arange(1, round(until / dt) + 1)
    result: FloatArray = np.where(times < length, peak * np.sin(np.pi * times / length), 0.0)
    return result


def dynamic_press(
    tissue: Tissue,
    tool: Press,
    *,
    size: tuple[float, float],
    tolerances: tuple[float, ...],
    quick: bool = False,
) -> tuple[EqualError, ...]:
    """Compare a 20 ms half-sine press, seen for 40 ms, at several tolerances.

    Args:
        tissue: the layers.
        tool: in the middle of the block; its force [N] is the peak.
        size: sides of the block [m].
        tolerances: largest relative errors allowed [1].
        quick: take a coarser converged answer and fewer settings: for a look, not for a figure.

    Raises:
        SolverError: no setting reaches a tolerance.
    """
    length, until = 0.02, 0.04
    modes, moving, order, refinement = _QUICK if quick else _FINE
    ladder = FEA_LADDER[:_QUICK_LADDER] if quick else FEA_LADDER[:-1]
    finest = WaveSolid(
        tissue,
        size=size,
        modes=(modes, modes),
        dynamic_modes=(moving, moving),
        order=order,
        refinement=refinement,
    )
    exact = hold(finest, tool, _FINE_DT).press(half_sine(tool.force, length, _FINE_DT, until))[:, 0]
    peak = np.abs(exact).max()

    def error(curve: FloatArray, dt: float) -> float:
        every = round(dt / _FINE_DT)
        return float(np.abs(curve - exact[every - 1 :: every]).max() / peak)

    def forces(dt: float) -> FloatArray:
        return half_sine(tool.force, length, dt, until)

    tried = [_wave_trial(tissue, tool, size, setting, forces(1e-3), error) for setting in WAVE_LADDER]
    for mesh in ladder:
        tried += [_fea_trial(tissue, tool, size, mesh, dt, forces(dt), error) for dt in _FEA_STEP_LENGTHS]
    last = _fea_trial(
        tissue, tool, size, ladder[-1] if quick else FEA_LADDER[-1], _FINE_DT, forces(_FINE_DT), error
    )
    name = f"{tool.force:g} N half-sine of 20 ms, flat {2e3 * tool.radius:g} mm tool in the middle"
    return tuple(_cheapest(name, tolerance, last.error, tried) for tolerance in tolerances)


def static_study(
    tissue: Tissue,
    tool: Press,
    *,
    size: tuple[float, float],
    tolerances: tuple[float, ...],
    quick: bool = False,
) -> tuple[EqualError, ...]:
    """Compare the study's load, up and down at 0.05 N/s sampled each second, from tissue to curves.

    Args:
        tissue: the layers.
        tool: in the middle of the block; its force [N] is the peak.
        size: sides of the block [m].
        tolerances: largest relative errors allowed [1].
        quick: take a coarser converged answer and fewer settings: for a look, not for a figure.

    Raises:
        SolverError: no setting reaches a tolerance.
    """
    up = np.arange(0.0, tool.force / _RATE + 1e-9) * _RATE / tool.force
    shares = np.concatenate([up, up[-2::-1]])
    reach = np.linspace(0.0, tool.radius, 4)
    patch = np.stack(np.meshgrid(tool.x + reach, tool.y + reach, [0.0], indexing="ij")).reshape(3, -1).T

    def curves(model: WaveSolid | FEASolid) -> FloatArray:
        if isinstance(model, WaveSolid):
            pressed = model.static((tool,))
            fields = [model.displacement(pressed, patch, name) for name in tissue.layer_names]
        else:
            equilibrium = model.static((tool,))
            fields = [model.displacement(equilibrium, patch, name) for name in tissue.layer_names]
        return np.outer(shares, [-field[:, 2].min() for field in fields])

    def waves(modes: int, refinement: int = 1) -> WaveSolid:
        return WaveSolid(tissue, size=size, modes=(modes, modes), refinement=refinement)

    def elements(mesh: Setting) -> FEASolid:
        return FEASolid(tissue, size=size, support=Support.BASE, around=(tool,), mesh=_mesh(mesh))

    fine_modes, _, _, refinement = _QUICK if quick else _FINE
    exact = curves(waves(fine_modes, refinement))
    peaks = np.abs(exact).max(axis=0)

    def trial(setting: str, build: Callable[[], WaveSolid | FEASolid]) -> Trial:
        model = build()
        error = float((np.abs(curves(model) - exact).max(axis=0) / peaks).max())
        job = cpu_time(lambda: curves(build()), repeats=5)
        return Trial(
            model="fea" if isinstance(model, FEASolid) else "wave-solid",
            setting=setting,
            error=error,
            dofs=model.dofs if isinstance(model, FEASolid) else ((model.modes[0] + 1) // 2) ** 2,
            set_up_s=job.median,
            step_us=1e6 * job.median,
            solver=model.solver_name if isinstance(model, FEASolid) else "",
        )

    tried = [trial(f"{modes}", partial(waves, modes)) for modes in STATIC_LADDER]
    ladder = FEA_LADDER[:_QUICK_LADDER] if quick else FEA_LADDER
    tried += [trial(_mesh_in_words(mesh), partial(elements, mesh)) for mesh in ladder]
    load = f"{tool.force:g} N at {_RATE:g} N/s up and down, {len(shares)} samples"
    name = f"{load}, flat {2e3 * tool.radius:g} mm tool in the middle"
    return tuple(_cheapest(name, tolerance, tried[-1].error, tried) for tolerance in tolerances)


def _wave_trial(
    tissue: Tissue,
    tool: Press,
    size: tuple[float, float],
    setting: tuple[int, int, int],
    forces: FloatArray,
    error: Callable[[FloatArray, float], float],
) -> Trial:
    modes, moving, order = setting
    dt = 1e-3
    began = process_time()
    model = WaveSolid(tissue, size=size, modes=(modes, modes), dynamic_modes=(moving, moving), order=order)
    held = hold(model, tool, dt)
    set_up = process_time() - began
    curve = held.press(forces)[:, 0]
    batch = np.tile(forces, _TRIALS)
    step = cpu_time(lambda: held.press(batch), executions=len(batch))
    return Trial(
        model="wave-solid",
        setting=f"{modes}/{moving}/{order}",
        error=error(curve, dt),
        dofs=held.blocks,
        set_up_s=set_up,
        step_us=1e6 * step.median,
        dt_ms=1e3 * dt,
    )


def _fea_trial(
    tissue: Tissue,
    tool: Press,
    size: tuple[float, float],
    setting: Setting,
    dt: float,
    forces: FloatArray,
    error: Callable[[FloatArray, float], float],
) -> Trial:
    began = process_time()
    model = FEASolid(tissue, size=size, support=Support.BASE, around=(tool,), mesh=_mesh(setting))
    state = model.step(model.init(), (tool.with_force(0.0),), (tool.with_force(forces[0]),), dt)
    set_up = process_time() - began
    centre = np.array([[tool.x, tool.y, 0.0]])
    curve, taken = [model.displacement(state, centre)[0, 2]], []
    for before, after in pairwise(forces.tolist()):
        began = process_time()
        state = model.step(state, (tool.with_force(before),), (tool.with_force(after),), dt)
        taken.append(process_time() - began)
        curve.append(model.displacement(state, centre)[0, 2])
    return Trial(
        model="fea",
        setting=_mesh_in_words(setting),
        error=error(np.array(curve), dt),
        dofs=model.dofs,
        set_up_s=set_up,
        step_us=1e6 * float(np.median(taken)),
        dt_ms=1e3 * dt,
        solver=model.solver_name,
    )


def _mesh(setting: Setting) -> MeshSize:
    per_radius, growth, top, deepening = setting
    return MeshSize(per_radius=per_radius, growth=growth, top=top, deepening=deepening)


def _mesh_in_words(setting: Setting) -> str:
    per_radius, growth, _, _ = setting
    return f"{per_radius:g}/{growth:g}"


def settled(tried: Sequence[Trial], tolerance: float) -> list[Trial]:
    """Return the settings that keep to a tolerance together with all finer ones of the same model and step.

    One that gets there only because its errors happen to cancel is left out.

    Args:
        tried: settings, those of one model and step length from coarse to fine.
        tolerance: largest error allowed [1].
    """

    def finer(place: int) -> list[Trial]:
        own = tried[place]
        return [t for t in tried[place:] if (t.model, t.dt_ms) == (own.model, own.dt_ms)]

    return [trial for i, trial in enumerate(tried) if all(t.error <= tolerance for t in finer(i))]


def _cheapest(case: str, tolerance: float, converged: float, tried: list[Trial]) -> EqualError:
    def cost(trial: Trial) -> float:
        return trial.step_us / (trial.dt_ms or 1.0)

    best = {}
    for model in ("wave-solid", "fea"):
        enough = [trial for trial in settled(tried, tolerance) if trial.model == model]
        if not enough:
            least = min(trial.error for trial in tried if trial.model == model)
            raise SolverError(
                f"{case}: no setting of {model} reaches {tolerance:g}, the least error is {least:.2g}"
            )
        best[model] = min(enough, key=cost)
    return EqualError(
        case=case,
        tolerance=tolerance,
        converged=converged,
        wave=best["wave-solid"],
        fea=best["fea"],
        ratio=cost(best["fea"]) / cost(best["wave-solid"]),
        tried=tuple(tried),
    )
