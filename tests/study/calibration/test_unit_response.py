"""Static answers: by lengths of waves, from whole models, under rigid tips."""

from dataclasses import replace

import numpy as np
import pytest

from pressed_pads import PEAK, blank, pad, triangle
from trocar.study.calibration.measurement import Readings
from trocar.study.calibration.parameter import Specimen, parameters
from trocar.study.calibration.probes import probes
from trocar.study.calibration.response import builder, response
from trocar.study.calibration.unit_response import ModelUnits, SpectrumUnits, spectrum_serves
from trocar.study.compare import compare

PLACES = 1e-3 * np.array([[10.0, 14.0], [21.0, 20.0], [5.0, 25.0]])


def watched(case):
    """Probes of the depth, of the body and of markers' three components."""
    time, force = triangle(11)
    marks = [
        Readings(name=f"u{axis}", time=time[1:4], value=np.zeros(3), places=PLACES, axis=axis)
        for axis in range(3)
    ]
    body = Readings(name="body", layer="body", time=time, value=force)
    lowest = np.array([[*case.tools[0].position, 0.0]] * 2)
    return probes(blank(time, force, body, *marks), case.tissue, lowest)


@pytest.mark.parametrize(
    "case",
    [pad(), pad(place=(0.012, 0.017), prestress_x=2e3, prestress_y=2e3)],
    ids=["central", "aside, prestressed"],
)
def test_waves_by_their_lengths_are_the_solid(case):
    read, specimen = watched(case), Specimen(tissue=case.tissue)
    whole = ModelUnits(builder(case, "wave-solid"), case.tools[0].press(1.0), read)(specimen)
    short = SpectrumUnits(case, read)(specimen)
    # the spline of 60 lengths misses 4e-7 under the tool, and as much of that aside, where less is moved
    assert np.abs(short - whole).max() < 2e-6 * np.abs(whole).max()
    assert short[0] > short[1] > 0


def test_finite_elements_say_the_same_within_their_mesh():
    case = pad()
    read, specimen = watched(case), Specimen(tissue=case.tissue)
    elements = ModelUnits(builder(case, "fea"), case.tools[0].press(1.0), read)(specimen)
    # 0.2 % is what `study/models.py` states of the elements' default mesh
    assert np.abs(SpectrumUnits(case, read)(specimen) - elements).max() < 0.003 * elements[0]


def test_a_directed_prestress_a_clamp_a_tilt_or_a_rigid_tip_asks_for_the_whole_model():
    assert spectrum_serves(pad(), frozenset())
    assert not spectrum_serves(pad(), frozenset({"skin.prestress_x"}))
    for case in (pad(prestress_x=1.0), pad(support="edges+base"), pad(tilt=0.2), pad(contact="rigid")):
        assert not spectrum_serves(case, frozenset())


def test_sensitivities_to_all_stiffnesses_add_up_to_minus_one():
    case = pad(prestress_x=2e3, prestress_y=2e3)
    specimen, units = Specimen(tissue=case.tissue), SpectrumUnits(case, watched(case))
    names = ("skin.young_modulus", "body.young_modulus", "skin.prestress")
    start, step = units(specimen), 1e-4
    total = sum(
        (units(one.put(specimen, one.get(specimen) * np.exp(step))) - start) / step
        for one in parameters(names, specimen)
    )
    assert np.allclose(
        total, -start, rtol=0, atol=2 * step * start[0]
    )  # forward differences: half a step times a curvature near 1


@pytest.mark.parametrize("tip", ["flat", "sphere"])
def test_a_rigid_tips_depth_is_that_of_compare(tip):
    case = pad(contact="rigid", tip=tip)
    time, force = triangle(11)
    predict, read = response(case, "wave-solid", blank(time, force), Specimen(tissue=case.tissue), ())
    rows, slopes = predict(Specimen(tissue=case.tissue))
    deepest = compare(case, ("wave-solid",)).histories[0].deflection["skin"].max()
    # a flat tip's skin sinks a little away from its middle; a sphere's deepest point is the tip's
    assert rows.max() == pytest.approx(deepest, rel=0.02 if tip == "flat" else 1e-3)
    power = 1.0 if tip == "flat" else 2 / 3
    assert slopes[5] == pytest.approx(power * rows[5] / PEAK, rel=1e-9)
    assert len(read.points) == 1


def test_a_specimen_that_remembers_is_read_relaxed():
    case = pad(prony=((0.5, 0.3),))
    plain = replace(case, tissue=pad().tissue)
    read = watched(case)
    assert np.array_equal(
        SpectrumUnits(case, read)(Specimen(tissue=case.tissue)),
        SpectrumUnits(plain, read)(Specimen(tissue=plain.tissue)),
    )
