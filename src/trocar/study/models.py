"""The models a case can be run through, by name."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from time import perf_counter
from typing import Any

import numpy as np

from trocar.errors import InputError
from trocar.model import Press, TissueModel
from trocar.reference.fea import FEASolid
from trocar.study.experiment import Case
from trocar.tissues import Layer, Tissue
from trocar.waves.membrane import WaveMembrane
from trocar.waves.solid import WaveSolid

AnyModel = TissueModel[Any]
NOT_BUILT_YET = ("wave-mesh", "mass-spring", "mesh-free")


def _wave_membrane(case: Case) -> AnyModel:
    return WaveMembrane.fitted(case.tissue, size=case.size, support=case.support, modes=(96, 96))


def _wave_solid(case: Case) -> AnyModel:
    return WaveSolid(case.tissue, size=case.size, support=case.support)


def _fea(case: Case) -> AnyModel:
    return FEASolid(case.tissue, size=case.size, support=case.support, around=case.load_at(0.0))


MODELS: dict[str, Callable[[Case], AnyModel]] = {
    "wave-membrane": _wave_membrane,
    "wave-solid": _wave_solid,
    "fea": _fea,
}


def check_names(names: Sequence[str]) -> tuple[str, ...]:
    """Return the names, each once.

    Raises:
        InputError: there is none, or one is unknown or not built yet.
    """
    known = ", ".join(MODELS)
    if not names:
        raise InputError("models", f"at least one of {known}", "none")
    for name in names:
        if name in NOT_BUILT_YET:
            raise InputError("models", f"one of {known}", name, "this model is specified but not built yet")
        if name not in MODELS:
            raise InputError("models", f"one of {known}", name)
    return tuple(dict.fromkeys(names))


def warm_up() -> float:
    """Compile, or load from the cache, what the wave models compile; return the seconds it took [s]."""
    began = perf_counter()
    layer = Layer(name="pad", thickness=0.01, young_modulus=1e4, poisson_ratio=0.45, density=1000.0)
    model = WaveSolid(Tissue(layers=(layer,)), size=(0.05, 0.05), modes=(2, 2), dynamic_modes=(2, 2))
    press = (Press(x=0.02, y=0.02, radius=0.01, force=1.0, tilt=0.1),)
    state = model.step(model.static(press), press, press, 1e-3)
    model.displacement(state, np.zeros((1, 3)))
    return perf_counter() - began
