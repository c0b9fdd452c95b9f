"""Waves that remember beside finite elements that do: creep, relaxation, hysteresis, a case file, and a swing."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from trocar.errors import InputError
from trocar.model import Press
from trocar.reference.fea import FEASolid
from trocar.study.cases.reading import load_case
from trocar.study.cases.tool import Contact
from trocar.study.compare import compare
from trocar.study.half_sine import half_sine
from trocar.study.memory_protocols import creep, hysteresis, relaxation
from trocar.study.models import COARSE_MESH, QUICK_MODELS
from trocar.tissues import Layer, Tissue
from trocar.waves.membrane import WaveMembrane
from trocar.waves.mesh.block import block_mesh, lines_around
from trocar.waves.mesh.wave_mesh import WaveMesh
from trocar.waves.solid import WaveSolid

SIZE = (0.06, 0.06)
CREEP = Path(__file__).parents[2] / "examples" / "creep.toml"
PRESS = Press(x=0.03, y=0.03, radius=0.004, force=0.05)
AGREED = 0.03  # what the project asks of waves against viscoelastic finite elements
REACHED = {"solid": 0.005, "membrane": 0.03, "mesh": 0.005}  # finite elements on the coarse mesh: 0.002


@pytest.fixture(scope="module")
def tissue():
    return load_case(CREEP).tissue


def mesh(tissue, *, massless):
    lines = lines_around(tissue, SIZE, (PRESS,), coarser=1.3)
    return WaveMesh(block_mesh(tissue, lines), modes=20, massless=massless)


@pytest.fixture(scope="module")
def models(tissue):
    return {
        "fea": FEASolid(tissue, size=SIZE, support="base", around=(PRESS,), mesh=COARSE_MESH, massless=True),
        "solid": WaveSolid(tissue, size=SIZE, modes=(64, 64), massless=True),
        "membrane": WaveMembrane.fitted(tissue, size=SIZE, modes=(64, 64), massless=True),
        "mesh": mesh(tissue, massless=True),
    }


@pytest.mark.parametrize("name", REACHED)
def test_creep_agrees_with_finite_elements(models, name):
    wave, fea = (creep(models[which], PRESS, first=0.01, last=120.0) for which in (name, "fea"))
    assert fea.deflection[-1] > 2 * fea.deflection[0]
    assert wave.deflection == pytest.approx(fea.deflection, rel=REACHED[name])


@pytest.mark.parametrize("name", REACHED)
def test_relaxation_agrees_with_finite_elements(models, name):
    wave, fea = (relaxation(models[which], PRESS, 1e-4, first=0.01, last=120.0) for which in (name, "fea"))
    assert fea.force[-1] < 0.5 * fea.force[0]
    assert wave.force == pytest.approx(fea.force, rel=REACHED[name])


@pytest.mark.parametrize("rate", [0.5, 0.05])
def test_hysteresis_agrees_with_finite_elements(models, rate):
    loops = {name: hysteresis(model, PRESS, rate=rate) for name, model in models.items()}
    fea = loops["fea"]
    assert 0.03 < fea.share_lost < 0.6
    for name, reached in REACHED.items():
        curve = loops[name].curve.deflection
        assert np.abs(curve - fea.curve.deflection).max() < reached * fea.curve.deflection.max()
        assert loops[name].lost == pytest.approx(fea.lost, rel=AGREED)
        assert loops[name].given == pytest.approx(fea.given, rel=AGREED)


def test_hysteresis_vanishes_without_memory_and_with_endless_patience(tissue, models):
    elastic = Tissue(layers=tuple(replace(layer, prony=()) for layer in tissue.layers))
    loop = hysteresis(WaveSolid(elastic, size=SIZE, modes=(16, 16), massless=True), PRESS, rate=0.1)
    assert abs(loop.lost) < 1e-12 * loop.given
    assert hysteresis(models["solid"], PRESS, rate=1e-7).share_lost < 1e-3


def test_relaxation_undoes_creep():
    """For even layers both are closed: J(t) and G(t) of the standard linear solid."""
    layer = Layer(
        name="gel", thickness=0.01, young_modulus=1e4, poisson_ratio=0.45, density=1e3, prony=((0.8, 2.0),)
    )
    model = WaveSolid(Tissue(layers=(layer,)), size=SIZE, modes=(16, 16), massless=True)
    grown = creep(model, PRESS, first=0.02, last=40.0)
    fallen = relaxation(model, PRESS, 1e-4, first=0.02, last=40.0)
    elastic = creep(model, PRESS, first=1e5, last=1e6).compliance[-1]
    assert grown.compliance == pytest.approx(elastic * (1 - 0.8 / 1.8 * np.exp(-grown.time / 3.6)), rel=1e-6)
    # The force is taken as linear over a step, a 12th of (dt/tau)^2 off while steps still are short.
    assert fallen.force == pytest.approx(1e-4 / elastic * (1 + 0.8 * np.exp(-fallen.time / 2.0)), rel=2e-3)


def test_a_case_file_creeps_alike_in_all_models():
    case = load_case(CREEP)
    wide = tuple(replace(tool, diameter=0.012) for tool in case.tools)  # needs the fewer waves
    short = replace(case, tools=wide, sampling=replace(case.sampling, period=10.0))
    found = compare(short, ("wave-solid", "fea", "wave-membrane", "wave-mesh"), builders=QUICK_MODELS)
    fea = found["fea"].deflection
    peak = int(np.argmax(found["fea"].force))
    assert fea["dermis"].argmax() > peak  # it sinks on while the force is held
    for name, reached in (("wave-solid", 0.01), ("wave-membrane", AGREED), ("wave-mesh", 0.01)):
        for layer, depth in fea.items():
            assert found[name].deflection[layer] == pytest.approx(depth, abs=reached * depth.max())


def test_a_rigid_tip_on_a_tissue_that_remembers_is_refused():
    case = load_case(CREEP)
    with pytest.raises(InputError, match='"dead" where a layer has a Prony series'):
        replace(case, tools=tuple(replace(tool, contact=Contact.RIGID) for tool in case.tools))


def test_a_swing_that_relaxation_damps_agrees_with_finite_elements(tissue):
    """Half a sine of 20 ms: relaxation times of milliseconds beside long ones, with inertia."""
    quick = Tissue(
        layers=(
            replace(tissue.layers[0], prony=((0.5, 0.002), (1.0, 5.0))),
            replace(tissue.layers[1], prony=((0.8, 0.01),)),
            replace(tissue.layers[2], prony=((1.0, 0.005), (0.4, 60.0))),
        )
    )
    models = {
        "fea": FEASolid(quick, size=SIZE, support="base", around=(PRESS,), mesh=COARSE_MESH),
        "solid": WaveSolid(quick, size=SIZE, modes=(64, 64), dynamic_modes=(24, 24)),
        "mesh": mesh(quick, massless=False),
    }
    curves = half_sine(models, PRESS)
    for name in ("solid", "mesh"):
        assert np.abs(curves[name] - curves["fea"]).max() < AGREED * np.abs(curves["fea"]).max()
