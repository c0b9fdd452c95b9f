"""`WaveSolid` under one tool that stays does what `WaveSolid.step` does."""

import numpy as np
import pytest

from trocar.errors import InputError
from trocar.model import Press
from trocar.tissues.catalogue import tissue
from trocar.waves.held_tool import hold
from trocar.waves.solid import WaveSolid

DT = 1e-3


@pytest.mark.parametrize("place", [0.03, 0.022])
def test_a_held_tool_steps_as_the_model(place):
    model = WaveSolid(tissue("skin"), size=(0.06, 0.06), modes=(24, 24), dynamic_modes=(8, 8), order=2)
    tool = Press(x=place, y=0.03, radius=0.004, force=1.0)
    held = hold(model, tool, DT)
    forces = 0.1 * np.random.default_rng(0).uniform(0, 1, 30)
    found = held.press(forces)
    state, before = model.init(), tool.with_force(0.0)
    centre = np.array([[tool.x, tool.y, 0.0]])
    for force, now in zip(forces, found, strict=True):
        after = tool.with_force(float(force))
        state, before = model.step(state, (before,), (after,), DT), after
        expected = [model.displacement(state, centre, name)[0, 2] for name in model.layer_names]
        # The static response comes from two factorisations of matrices with condition numbers near 1e6.
        assert now == pytest.approx(expected, rel=0, abs=1e-9 * np.abs(expected).max())


def test_a_tool_in_the_middle_moves_odd_waves_alone():
    model = WaveSolid(tissue("uterus"), size=(0.06, 0.06), modes=(12, 12), dynamic_modes=(8, 8), order=2)
    middle = hold(model, Press(x=0.03, y=0.03, radius=0.004, force=1.0), DT)
    aside = hold(model, Press(x=0.0213, y=0.0177, radius=0.004, force=1.0), DT)
    assert aside.blocks == 4 * middle.blocks
    assert not middle.rest.any()


def test_a_tilted_tool_is_refused():
    model = WaveSolid(tissue("uterus"), size=(0.06, 0.06), modes=(4, 4), dynamic_modes=(4, 4))
    with pytest.raises(InputError, match="tilt"):
        hold(model, Press(x=0.03, y=0.03, radius=0.004, force=1.0, tilt=0.3), DT)
