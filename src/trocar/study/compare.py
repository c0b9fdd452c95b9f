"""One case through several models, side by side."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

from trocar.errors import InputError
from trocar.study.cases.experiment import Case
from trocar.study.history import History, run
from trocar.study.models import MODELS, ON_MESHES, AnyModel, check_names, usual_models
from trocar.study.stated_range import WAVES
from trocar.units import MILLIMETRE

Watch = Callable[[str, float], None]


@dataclass(frozen=True, kw_only=True)
class Comparison:
    """A case and what each model says of it, in the order asked for."""

    case: Case
    histories: tuple[History, ...]

    def __getitem__(self, model: str) -> History:
        """Return one model's history.

        Raises:
            KeyError: the case was not run through it.
        """
        for history in self.histories:
            if history.model == model:
                return history
        raise KeyError(model)

    def as_dict(self) -> dict[str, object]:
        """Return plain values for JSON: seconds, newtons and millimetres."""
        case = self.case
        return {
            "case": {
                "title": case.title,
                "size_mm": [side / MILLIMETRE for side in case.size],
                "support": case.support.value,
                "layers": list(case.tissue.layer_names),
                "elements": None if case.mesh is None else len(case.mesh.cells),
                "tools": len(case.tools),
                "peak_n": case.peak_force,
                "dynamic": case.sampling.dynamic,
            },
            "models": {history.model: _plain(history) for history in self.histories},
        }


def models_for(case: Case, models: Sequence[str] | None) -> tuple[str, ...]:
    """Return the models that a case is run through, each once.

    Args:
        case: the experiment.
        models: names; None for the usual ones of such a case.

    Raises:
        InputError: a name is unknown, or that model takes no rigid tip or no mesh.
    """
    if models is None:
        return usual_models(case)
    names = check_names(models)
    for name in names:
        if case.mesh is not None and name not in ON_MESHES:
            taking = f"{' or '.join(ON_MESHES)}, which takes a mesh"
            raise InputError("models", taking, name, "the other models are for blocks")
        if case.rigid and name not in WAVES:
            raise InputError("models", f"{' or '.join(WAVES)}, which take a rigid tip", name)
    return names


def compare(
    case: Case,
    models: Sequence[str] | None = None,
    *,
    builders: Mapping[str, Callable[[Case], AnyModel]] = MODELS,
    watch: Watch = lambda _model, _share: None,
) -> Comparison:
    """Run a case through several models.

    Args:
        case: the experiment.
        models: names, of those in `trocar.study.models.MODELS`; None for the usual ones of such a case.
        builders: make each model for the case, by name.
        watch: told the model and the share of it done, 0 to 1, as the work goes on.

    Raises:
        InputError: a name is unknown, or that model takes no rigid tip or no mesh.
        SolverError: a model could not be solved.
    """
    names = models_for(case, models)
    histories = tuple(run(case, name, builders[name], partial(watch, name)) for name in names)
    return Comparison(case=case, histories=histories)


def _plain(history: History) -> dict[str, object]:
    return {
        "time_s": history.time.tolist(),
        "force_n": history.force.tolist(),
        "max_deflection_mm": {
            name: (depth / MILLIMETRE).tolist() for name, depth in history.deflection.items()
        },
        "cpu_s": history.cpu_seconds,
        "dofs": history.dofs,
        "in_range": history.in_range,
    }
