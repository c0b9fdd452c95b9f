"""Waves and finite elements are compared at settings that keep to the tolerance, the cheapest of each."""

import pytest

from trocar.errors import SolverError
from trocar.model import Press
from trocar.study.cost import equal_error
from trocar.study.cost.equal_error import Trial, dynamic_press, half_sine, settled, static_study
from trocar.tissues.catalogue import tissue

SIZE = (0.06, 0.06)
TOOL = Press(x=0.03, y=0.03, radius=0.006, force=0.1)


@pytest.fixture(autouse=True)
def _short_ladders(monkeypatch):
    monkeypatch.setattr(equal_error, "WAVE_LADDER", ((16, 6, 2), (24, 12, 2)))
    monkeypatch.setattr(equal_error, "STATIC_LADDER", (16, 32))
    monkeypatch.setattr(equal_error, "FEA_LADDER", ((1.0, 1.0, 0.5, 1.0), (1.5, 0.7, 0.4, 0.7)))
    monkeypatch.setattr(equal_error, "_QUICK", (96, 16, 3, 1))


@pytest.mark.parametrize("compare", [dynamic_press, static_study])
def test_both_models_keep_to_the_tolerance(compare):
    (result,) = compare(tissue("uterus"), TOOL, size=SIZE, tolerances=(0.05,), quick=True)
    for name, chosen in (("wave-solid", result.wave), ("fea", result.fea)):
        assert chosen.model == name
        assert 0 < chosen.error <= result.tolerance
        enough = [t for t in settled(result.tried, result.tolerance) if t.model == name]
        assert chosen.step_us / (chosen.dt_ms or 1) == min(t.step_us / (t.dt_ms or 1) for t in enough)
    assert result.converged < 0.03  # both methods solve one problem: the coarse meshes above reach 3 %
    assert result.as_dict()["case"] == result.case


def test_a_tolerance_out_of_reach_is_said():
    with pytest.raises(SolverError, match="least error"):
        static_study(tissue("uterus"), TOOL, size=SIZE, tolerances=(1e-9,), quick=True)


def test_a_setting_that_is_right_by_luck_is_not_settled():
    errors = {
        1.0: (0.3, 0.005, 0.02, 0.009, 0.001),
        2.0: (0.009, 0.02),
    }  # from coarse to fine, by step length
    tried = [
        Trial(model="fea", setting=str(e), error=e, dofs=1, set_up_s=0.0, step_us=1.0, dt_ms=dt)
        for dt, row in errors.items()
        for e in row
    ]
    assert [trial.error for trial in settled(tried, 0.01)] == [0.009, 0.001]


def test_the_half_sine_ends():
    forces = half_sine(0.1, 0.02, 1e-3, 0.04)
    assert len(forces) == 40
    assert forces.max() == pytest.approx(0.1, rel=1e-14)  # at 10 ms, rounding
    assert not forces[19:].any()
