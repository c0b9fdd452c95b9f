"""Compile what the cost figures time, so that compilation is counted once and apart."""

from __future__ import annotations

from time import perf_counter

import numpy as np

from trocar.model import Press
from trocar.study.clock import empty_loop, triad_bandwidth
from trocar.study.tick_cost import DT, played
from trocar.tissues.tissue import Tissue
from trocar.waves.held_tool import hold
from trocar.waves.membrane import WaveMembrane
from trocar.waves.solid import WaveSolid
from trocar.waves.tick import make_tick


def compile_seconds(tissue: Tissue) -> float:
    """Run every compiled piece once on a few modes and return the wall time it took [s].

    Args:
        tissue: the layers.
    """
    began = perf_counter()
    size = (0.03, 0.03)
    tool = Press(x=0.015, y=0.015, radius=0.005, force=1.0)
    solid = WaveSolid(tissue, size=size, modes=(3, 3), dynamic_modes=(3, 3), order=1)
    hold(solid, tool, DT).press(np.zeros(1))
    solid.displacement(solid.step(solid.static((tool,)), (tool,), (tool,), DT), np.full((1, 3), 0.01))
    played(
        make_tick(WaveMembrane.derived(tissue, size=size, modes=(2, 2)), DT, (0.005,)), np.zeros((1, 1, 3))
    )
    empty_loop()
    triad_bandwidth(1024)
    return perf_counter() - began
