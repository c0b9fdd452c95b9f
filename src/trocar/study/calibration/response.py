"""Which of the responses serves a case: the one place that knows them all."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from trocar.errors import InputError
from trocar.model import FloatArray
from trocar.study.calibration.measurement import Measurement
from trocar.study.calibration.memory import Creeping, at_rate
from trocar.study.calibration.motion import Moving, Sphere
from trocar.study.calibration.parameter import Parameter, Specimen, of_sheets
from trocar.study.calibration.probes import Probes, probes
from trocar.study.calibration.unit_response import (
    Build,
    ModelUnits,
    RigidUnits,
    SpectrumUnits,
    Units,
    spectrum_serves,
)
from trocar.study.cases.experiment import Case
from trocar.study.cases.tool import Tip
from trocar.study.deflection import deflections, search_points
from trocar.study.models import MODELS, MOST_MEMBRANE_MODES, AnyModel, series_modes
from trocar.tissues.key_table import Words
from trocar.waves.membrane import WaveMembrane

MODEL_NAMES = ("wave-solid", "wave-membrane", "fea")
Response = Callable[[Specimen], tuple[FloatArray, FloatArray]]
_UNLOADED = 0.05  # of the largest force: a record of layers that remember begins below


class Proportional:
    """Readings that follow the force at once.

    Args:
        units: static answers.
        measurement: the force.
        probes: what is read.
    """

    def __init__(self, units: Units, measurement: Measurement, probes: Probes) -> None:
        self._units, self._which = units, probes.which
        self._force = np.interp(probes.time, measurement.time, measurement.force)

    def __call__(self, specimen: Specimen) -> tuple[FloatArray, FloatArray]:
        """Return the rows [m] and how each answers a force [m/N], both of shape (n,)."""
        compliance = self._units(specimen)[self._which]
        return compliance * self._force, compliance


def check_model(case: Case, model: str) -> None:
    """Refuse what cannot be calibrated.

    Raises:
        InputError: the model is unknown or does not take this case, the case has a mesh, there are two tools, or a
            layer's law is not linear.
    """
    if model not in MODEL_NAMES:
        raise InputError("--model", f"one of {', '.join(MODEL_NAMES)}", model)
    if case.mesh is not None:
        raise InputError(
            "mesh",
            "a [block]",
            Words("a [mesh]"),
            "calibrate on a block, as thick as the organ under the tool",
        )
    if len(case.tools) != 1:
        raise InputError("tool", "one tool", len(case.tools), "leave one of them out of the case file")
    if case.tissue.large_deformation:
        raise InputError(
            "law", "linear layers", Words("others"), "calibration is for small strain; leave law out"
        )
    if model == "fea" and case.rigid:
        raise InputError("--model", "a wave model, which takes a rigid tip", model)
    remembers = bool(case.tissue.relaxation_times)
    if model == "wave-membrane" and remembers:
        raise InputError(
            "--model",
            "wave-solid or fea, where layers have a Prony series",
            model,
            "sheets are fitted to the layers",
        )
    if case.sampling.dynamic and remembers and case.support.sides_clamped and model == "wave-solid":
        raise InputError(
            "sampling.dynamic", "false where layers that remember are clamped", True, "or take --model fea"
        )


def first_specimen(case: Case, model: str, names: tuple[str, ...]) -> Specimen:
    """Return where a fit starts: the case's layers, or sheets fitted to them where sheets are sought.

    Raises:
        InputError: parameters of sheets and of layers are mixed.
    """
    sheets = [name for name in names if of_sheets(name)]
    if not sheets or model != "wave-membrane":
        return Specimen(tissue=case.tissue)
    if len(sheets) < len(names):
        other = next(name for name in names if name not in sheets)
        raise InputError(
            "--fit", f"parameters of sheets alone, as {sheets[0]}", other, "fit the others without them"
        )
    fitted: AnyModel = MODELS[model](case)
    assert isinstance(fitted, WaveMembrane)
    return Specimen(tissue=case.tissue, stack=fitted.stack)


def response(
    case: Case, model: str, measurement: Measurement, near: Specimen, wanted: tuple[Parameter, ...]
) -> tuple[Response, Probes]:
    """Return what predicts the rows of a measurement, and where it reads.

    Args:
        case: block and tool; its own force does not matter.
        model: one of `MODEL_NAMES`.
        measurement: the force, and what is read.
        near: like what will be fitted: depths are read at its faces' lowest points.
        wanted: parameters that will change.

    Raises:
        InputError: the measurement asks what the model cannot give.
    """
    build = builder(case, model)
    if case.rigid and any(series.axis < 2 for series in measurement.series):
        raise InputError(
            "--markers", "uz_mm alone under a rigid tip", Words("ux_mm or uy_mm"), "leave them out"
        )
    read = probes(measurement, case.tissue, lowest_points(case, model, near))
    creeps = bool(case.tissue.relaxation_times)
    if (creeps or case.sampling.dynamic) and measurement.force[0] > _UNLOADED * measurement.peak:
        raise InputError(
            f"{measurement.source}: force_n",
            "a record that begins before the load, where the tissue remembers or moves",
            Words(f"{measurement.force[0]:g} N in its first row"),
        )
    if case.sampling.dynamic:
        return Moving(build, case, measurement, read), read
    if case.tools[0].tip is Tip.SPHERE:
        return Sphere(build, case, measurement, read), read
    units: Units
    if case.rigid:
        units = RigidUnits(build, case, read)
    elif model == "wave-solid" and spectrum_serves(case, frozenset(item.name for item in wanted)):
        units = SpectrumUnits(case, read)
    else:
        units = ModelUnits(build, case.tools[0].press(1.0), read)
    return (Creeping if creeps else Proportional)(units, measurement, read), read


def builder(case: Case, model: str) -> Build:
    """Return what builds a model of the case with other layers, or other sheets.

    Args:
        case: block and tool.
        model: one of `MODEL_NAMES`.
    """
    m, n = series_modes(case)

    def build(specimen: Specimen) -> AnyModel:
        if specimen.stack is None:
            return MODELS[model](replace(case, tissue=specimen.tissue))
        return WaveMembrane(
            specimen.stack,
            size=case.size,
            support=case.support,
            modes=(min(m, MOST_MEMBRANE_MODES), min(n, MOST_MEMBRANE_MODES)),
            tissue=specimen.tissue,
            massless=not case.sampling.dynamic,
        )

    return build


def lowest_points(case: Case, model: str, specimen: Specimen) -> FloatArray:
    """Return the lowest point of each layer's upper face when all is relaxed [m], shape (layers, 3).

    Args:
        case: block and tool.
        model: one of `MODEL_NAMES`.
        specimen: the layers or sheets.
    """
    tool, names = case.tools[0], case.tissue.layer_names
    if case.rigid:
        return np.tile([*tool.position, 0.0], (len(names), 1))
    built, load = builder(case, model)(at_rate(specimen, 0.0)), (tool.press(1.0),)
    points = search_points(case.size, load)
    lowest: FloatArray = points[deflections(built, built.static(load), points, names).argmax(axis=1)]
    return lowest
