"""Compile what is timed, so that compilation is counted once and apart."""

from __future__ import annotations

from time import perf_counter

import numpy as np

from trocar.contact.instrument import default_instruments
from trocar.model import Press, Support
from trocar.simulation import DT, POSE, make_scene, played
from trocar.study.cost.clock import empty_loop, triad_bandwidth
from trocar.tissues import Layer, Tissue
from trocar.waves.held_tool import hold
from trocar.waves.membrane import WaveMembrane
from trocar.waves.solid import WaveSolid

_PAD = Tissue(
    layers=(Layer(name="pad", thickness=0.01, young_modulus=1e4, poisson_ratio=0.45, density=1000.0),)
)
_SIZE = (0.05, 0.05)
_TOOL = Press(x=0.025, y=0.025, radius=0.01, force=1.0)
_MODES, _TOLERANCE = (16, 16), 0.1  # few, of a scene


def compile_models() -> float:
    """Run the compiled pieces of the models once on a few modes; return the wall time it took [s]."""
    began = perf_counter()
    load = (_TOOL,)
    model = WaveSolid(_PAD, size=_SIZE, modes=(2, 2), dynamic_modes=(2, 2))
    model.displacement(model.step(model.static(load), load, load, DT), np.full((1, 3), 0.01))
    return perf_counter() - began


def compile_steps() -> float:
    """Do the same for the models, the live tick and the clocks around it; return the wall time it took [s]."""
    began = perf_counter()
    compile_models()
    hold(WaveSolid(_PAD, size=_SIZE, modes=(3, 3), dynamic_modes=(3, 3), order=1), _TOOL, DT).press(
        np.zeros(1)
    )
    model = WaveMembrane.derived(_PAD, size=_SIZE, modes=_MODES, support=Support.BASE)
    scene = make_scene(model, _PAD, default_instruments(_SIZE, _PAD.thickness), tolerance=_TOLERANCE)
    played(scene, np.zeros((1, 2, POSE)))
    empty_loop()
    triad_bandwidth(1024)
    return perf_counter() - began
