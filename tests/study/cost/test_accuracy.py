"""Accuracy against cost."""

import pytest

from sample_tissues import three_layers
from trocar.errors import SolverError
from trocar.study.cost import accuracy
from trocar.study.cost.accuracy import DYNAMIC, LADDERS, LARGE, STATIC, Point, accuracy_against_cost
from trocar.study.models import COARSE_MESH
from trocar.study.report.figures.accuracy import accuracy_alt, accuracy_figure
from trocar.study.stiffening import Dent

DENT = Dent(name="three layers", tissue=three_layers(), size=(0.04, 0.04))


@pytest.fixture(autouse=True)
def _coarse_reference(monkeypatch):
    monkeypatch.setattr(accuracy, "_REFERENCE", COARSE_MESH)  # within 1.5 %


def points(case, *models, rungs=1):
    return list(accuracy_against_cost(DENT, cases=(case,), models=models, rungs=rungs))


def test_finer_models_err_less_and_say_what_they_cost():
    coarse, fine = points(STATIC, "mass-spring", rungs=2)
    assert 0.05 < fine.error < coarse.error < 0.5
    assert coarse.dofs < fine.dofs
    assert coarse.second_s > 0.0
    assert fine.setting == LADDERS["mass-spring"][1][0]


def test_a_swing_is_judged_at_every_instant():
    (waves,) = points(DYNAMIC, "wave-solid")
    assert 0.0 < waves.error < 0.05
    assert waves.failure == ""


def test_what_fails_is_told_and_the_rest_goes_on(monkeypatch):
    def breaks(dent, massless):
        raise SolverError("no luck")

    monkeypatch.setattr(accuracy, "LADDERS", {"fea": [("broken", breaks), LADDERS["fea"][0]]})
    broken, whole = points(STATIC, "fea", rungs=2)
    assert broken.error is None
    assert broken.failure == "no luck"
    assert whole.error < 0.1


def test_a_trial_that_takes_long_ends_its_ladder(monkeypatch):
    monkeypatch.setattr(accuracy, "_LONGEST", 0.0)
    assert len(points(STATIC, "fea", rungs=3)) == 1


@pytest.mark.parametrize("error", [0.1, 1e-9])
def test_the_figure_shows_every_model_of_every_case(error):
    found = [
        Point(case=case, model=model, setting="any", error=error, second_s=2.0, set_up_s=0.1, dofs=10)
        for case in (STATIC, LARGE)
        for model in ("fea", "wave-solid", "mass-spring")
    ]
    figure = accuracy_figure(found)
    assert [axes.get_title(loc="left") for axes in figure.axes] == [STATIC, LARGE]
    assert "large force, WaveSolid" in accuracy_alt(found)
