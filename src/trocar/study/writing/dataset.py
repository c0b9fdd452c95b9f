"""A study as one data set: every curve and surface with its unit, after the CF conventions.

Dimensions are the layers, the models and, for each case, its own samples. A model that was not run through a case
leaves missing values there.

Source: Climate and Forecast Metadata Conventions, version 1.11.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr

from trocar import __version__
from trocar.model import FloatArray
from trocar.study.compare import Comparison
from trocar.study.protocol import Study

PAPER = (
    "S. Patel, J. Suthakorn, Validation Study of a Wave Equation Model of Soft Tissue for a New Virtual Reality "
    "Laparoscopy Training System, doi 10.1007/978-3-319-27707-3_16"
)
MODELS = ("fea", "wave-solid", "wave-membrane")
_TISSUE = {
    "thickness": ("m", "thickness of the layer"),
    "young_modulus": ("Pa", "Young's modulus of the layer"),
    "poisson_ratio": ("1", "Poisson's ratio of the layer"),
    "density": ("kg m-3", "density of the layer"),
    "prestress_x": ("Pa", "prestress of the layer along x"),
    "prestress_y": ("Pa", "prestress of the layer along y"),
    "loss_factor": ("1", "loss factor of the layer"),
}


def study_dataset(study: Study, *, created: str, command: str = "") -> xr.Dataset:
    """Return everything the study computed.

    Args:
        study: the results.
        created: time of writing, ISO 8601.
        command: that made it.
    """
    layers = study.small.case.tissue.layer_names
    cases = study.cases
    first = next(iter(study.surfaces.values()))
    variables: dict[str, xr.Variable] = {
        "layer": _named("layer", layers, "layer, top first"),
        "model": _named("model", MODELS, "model; fea is the reference"),
        "support": _named("support", [support.value for support in study.supports], "how the block is held"),
        "component": _named(
            "component", ("x", "y", "z"), "component of a displacement; z points out of the tissue"
        ),
        "x": _real(("x",), first.x, "m", "place along x"),
        "y": _real(("y",), first.y, "m", "place along y"),
    }
    for name, case in cases.items():
        variables |= _case(name, case, layers)
    for name, surface in study.surfaces.items():
        values = np.stack([surface.displacement[layer] for layer in layers])
        variables[f"displacement_{name}"] = _real(
            ("layer", "component", "x", "y"),
            values,
            "m",
            f"displacement of each layer's upper face at the peak, {name}",
        )
    by_support = np.stack([_depths(comparison, layers) for comparison in study.supports.values()])
    variables["deflection_support"] = _real(
        ("support", "model", "layer", "time_small"),
        by_support,
        "m",
        "largest deflection, small load, each support",
    )
    variables |= _film(study, layers) | _per_layer(study, layers)
    coordinates = {name for name in variables if variables[name].dims == (name,)}
    return xr.Dataset(
        {name: variables[name] for name in variables if name not in coordinates},
        coords={name: variables[name] for name in coordinates},
        attrs=_attributes(study, created, command),
    )


def _case(name: str, comparison: Comparison, layers: Sequence[str]) -> Mapping[str, xr.Variable]:
    time = f"time_{name}"
    one = comparison.histories[0]
    title = comparison.case.title
    costs = {key: np.full(len(MODELS), np.nan) for key in ("cpu_seconds", "setup_seconds", "dofs")}
    for history in comparison.histories:
        for key, values in costs.items():
            values[MODELS.index(history.model)] = getattr(history, key)
    return {
        time: _real((time,), one.time, "s", f"time since first touch, {title}"),
        f"force_{name}": _real((time,), one.force, "N", f"force of all tools along their axes, {title}"),
        f"deflection_{name}": _real(
            ("model", "layer", time),
            _depths(comparison, layers),
            "m",
            f"largest deflection of the upper face, {title}",
        ),
        f"cpu_time_{name}": _real(
            ("model",), costs["cpu_seconds"], "s", f"processor time, set-up included, {title}"
        ),
        f"setup_time_{name}": _real(
            ("model",), costs["setup_seconds"], "s", f"processor time of set-up, {title}"
        ),
        f"unknowns_{name}": _real(("model",), costs["dofs"], "1", f"unknowns solved for, {title}"),
    }


def _depths(comparison: Comparison, layers: Sequence[str]) -> FloatArray:
    """Return largest deflections, shape (models, layers, samples); not a number where a model was not run."""
    depths = np.full((len(MODELS), len(layers), comparison.histories[0].time.size), np.nan)
    for history in comparison.histories:
        depths[MODELS.index(history.model)] = [history.deflection[layer] for layer in layers]
    return depths


def _film(study: Study, layers: Sequence[str]) -> dict[str, xr.Variable]:
    film = study.film
    grid = ("time_film", "x", "y") if film.x.size == next(iter(study.surfaces.values())).x.size else None
    assert grid is not None, "film and surfaces share one grid"
    return {
        "time_film": _real(("time_film",), film.time, "s", "time since first touch, press and release"),
        "force_film": _real(("time_film",), film.force, "N", "force along the tool, press and release"),
        "height_film": _real(
            grid, film.height, "m", "displacement of the top face along z, press and release"
        ),
        "depth_film": _real(
            ("layer", "time_film"),
            np.stack([film.depth[layer] for layer in layers]),
            "m",
            "deflection of the upper face under the tool's centre, press and release",
        ),
    }


def _per_layer(study: Study, layers: Sequence[str]) -> dict[str, xr.Variable]:
    tissue = study.small.case.tissue
    numbers = [study.numerics[layer] for layer in layers]
    strengths = [study.strength[layer] for layer in layers]
    known = np.array([strength.tensile_strength for strength in strengths])
    columns = {
        "uncertainty_fea": (
            [n.reference.standard_uncertainty for n in numbers],
            "m",
            "numerical uncertainty of fea",
        ),
        "uncertainty_wave_solid": (
            [n.model.standard_uncertainty for n in numbers],
            "m",
            "numerical uncertainty of wave-solid",
        ),
        "comparison_error": (
            [n.comparison.error for n in numbers],
            "m",
            "wave-solid minus fea, both refined",
        ),
        "stress_small": ([s.at_small for s in strengths], "Pa", "largest von Mises stress, small load"),
        "stress_paper": ([s.at_peak for s in strengths], "Pa", "largest von Mises stress, the paper's load"),
        "tensile_strength": (
            np.where(np.isfinite(known), known, np.nan),
            "Pa",
            "tensile strength; missing if unknown",
        ),
    }
    for key, (unit, meaning) in _TISSUE.items():
        columns[key] = ([getattr(layer, key) for layer in tissue.layers], unit, meaning)
    return {
        key: _real(("layer",), np.asarray(values, float), *words) for key, (values, *words) in columns.items()
    }


def _attributes(study: Study, created: str, command: str) -> dict[str, str | float]:
    plan = study.plan
    return {
        "Conventions": "CF-1.11",
        "title": "Validation of a wave model of soft tissue against finite elements",
        "source": f"trocar {__version__}",
        "history": f"{created} {command}".strip(),
        "references": PAPER,
        "version": __version__,
        "created": created,
        "comment": "Deflections are positive into the tissue. Loads outside the linear range are not predictions.",
        "tissue": plan.tissue,
        "support": plan.support.value,
        "tool_diameter_m": plan.diameter,
        "small_peak_n": plan.small,
        "paper_peak_n": plan.peak,
        "tilt_rad": plan.tilt,
    }


def _real(dims: tuple[str, ...], values: FloatArray, units: str, long_name: str) -> xr.Variable:
    return xr.Variable(dims, np.asarray(values, dtype=np.float64), {"units": units, "long_name": long_name})


def _named(dim: str, names: Sequence[str], long_name: str) -> xr.Variable:
    return xr.Variable((dim,), np.array(list(names), dtype=str), {"long_name": long_name})
