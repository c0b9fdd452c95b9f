"""The figures of a tick's cost hold together; how long it took is nobody's test."""

import numpy as np
import pytest

from trocar.study.cost import tick_cost as tick_cost_module
from trocar.study.cost.clock import cpu_time, triad_bandwidth
from trocar.study.cost.tick_cost import tick_cost, touched
from trocar.tissues.catalogue import tissue
from trocar.waves.membrane import WaveMembrane
from trocar.waves.tick import make_tick


def test_the_cost_of_a_tick_is_told_with_its_error(monkeypatch):
    monkeypatch.setattr(tick_cost_module, "_RELEASED_TICKS", 400)
    monkeypatch.setattr(tick_cost_module, "_SINGLE_TICKS", 100)
    cost = tick_cost(tissue("uterus"), size=(0.06, 0.06), radius=0.004, tolerance=1e-3)
    assert 0 < cost.error < 1e-3  # what the modes were chosen for
    assert cost.pressing > 2  # both tips touch
    assert cost.oscillators == cost.layers * cost.modes
    assert cost.fea_dofs > 0
    assert cost.floor_us == pytest.approx(cost.kilobytes / cost.triad_gb_s, rel=1e-12)  # kB/(GB/s) = us
    assert cost.as_dict()["fea_solver"] in ("superlu", "pardiso")


def test_bytes_touched_are_those_of_the_planes():
    model = WaveMembrane.derived(tissue("uterus"), size=(0.06, 0.06), modes=(8, 16))
    tick = make_tick(model, 1e-3, window=2e-3, offsets=np.array([[0.0, 1e-3]]))
    # One layer, 8 x 16 modes: 6 coefficients of the step, 2 of the top face; 2 + 2 numbers read and written; 4 points.
    assert touched(tick) == 8 * 16 * 8 * (8 + 2 * 4) + 4 * 4 * 8


def test_the_clock_counts_work_and_bandwidth():
    calls = []
    timing = cpu_time(lambda: calls.append(sum(range(20_000))), repeats=3)
    assert timing.repeats == 3
    assert 0 < timing.least <= timing.median
    assert len(calls) >= 3 + 2
    assert triad_bandwidth(24_000) > 0
