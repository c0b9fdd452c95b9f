"""The fit itself: minima, offsets, weights, errors in both coordinates."""

from dataclasses import replace

import numpy as np
import pytest

from pressed_pads import blank, filled, pad, problem, softer, triangle
from trocar.study.calibration.diagnosis import warnings
from trocar.study.calibration.fit import fit
from trocar.study.calibration.identifiability import knowledge
from trocar.study.calibration.measurement import Readings
from trocar.study.calibration.noise import white_noise

NAME = "body.young_modulus"


def fitted(asked):
    done = fit(asked)
    return [one.value(x) for one, x in zip(asked.parameters, done.free, strict=True)], done


@pytest.mark.parametrize("share", [0.05, 0.5, 3.0])
def test_clean_readings_give_the_truth_from_far_away(share):
    case = pad()
    record = filled(blank(*triangle()), case, softer(case, share))
    (value,), done = fitted(problem(case, record, (NAME,)))
    assert value == pytest.approx(1.2e4 * share, rel=1e-4)
    assert done.evaluations < 60


def test_an_offset_is_found_unless_the_zero_is_trusted():
    case = pad()
    record = filled(blank(*triangle()), case, softer(case), offset=5e-5)
    (value,), done = fitted(problem(case, record, (NAME,)))
    assert value == pytest.approx(1.2e4, rel=1e-5)
    assert done.offsets[0] == pytest.approx(5e-5, rel=1e-4)
    (value,), done = fitted(problem(case, record, (NAME,), zeroed=True))
    assert value < 0.8 * 1.2e4
    assert done.offsets[0] == 0.0


def test_markers_and_depth_tell_two_moduli_and_each_series_its_noise():
    case = pad()
    time, force = triangle()
    places = np.tile([[0.0205, 0.015], [0.015, 0.023], [0.015, 0.027]], (20, 1))
    marks = Readings(name="markers' uz", time=np.repeat(time[10:30], 3), value=np.zeros(60), places=places)
    record = filled(blank(time, force, marks), case, softer(case), noise=2e-6, seed=3)
    body, skin = 1.2e4, 6e4
    start = replace(case, tissue=softer(pad(young_modulus=1e5), 0.7))
    values, done = fitted(problem(start, record, (NAME, "skin.young_modulus")))
    assert values == pytest.approx([body, skin], rel=0.1)  # four standard errors of the skin's modulus
    assert [one.rms for one in done.noise] == pytest.approx([2e-6, 2e-6], rel=0.35)
    assert done.offsets[1] == 0.0


def test_a_noisy_force_flattens_the_slope_unless_its_noise_is_known():
    case = pad()
    time, force = triangle(rows=801)
    clean = filled(blank(time, force), case, softer(case))
    shake = 0.006  # [N], an eighth of the peak
    noisy = replace(clean, force=force + np.random.default_rng(0).normal(0.0, shake, len(force)))
    (plain,), _ = fitted(problem(case, noisy, (NAME,)))
    (known,), _ = fitted(problem(case, noisy, (NAME,), noise_force=shake))
    # attenuation: 1/(1 + shake^2/variance of the force) = 0.85, which reads as a stiffer tissue
    assert plain > 1.1 * 1.2e4
    assert known == pytest.approx(1.2e4, rel=0.04)  # four standard errors


def test_white_noise_is_told_from_a_trend():
    noise = np.random.default_rng(0).normal(0.0, 2.0, 4000)
    assert white_noise(noise + np.linspace(0, 500, 4000)) == pytest.approx(
        2.0, rel=0.06
    )  # four standard errors


def test_a_parameter_without_influence_stays_where_it_starts():
    case = pad(young_modulus=6e4, thickness=1e-4)
    record = filled(blank(*triangle()), case, softer(case, 2.0), noise=5e-6)
    (_, nu), _ = fitted(problem(case, record, (NAME, "skin.poisson_ratio")))
    assert nu == pytest.approx(0.48, rel=0.01)


def test_a_bound_is_where_a_fit_stops_and_is_told():
    case = pad()
    time, force = triangle()
    record = blank(time, force)  # a millimetre a newton

    def hardly(specimen):
        share = (
            0.2 * (specimen.tissue.layers[1].young_modulus / 1.2e4) ** 0.1
        )  # 0.4 at a thousand times the start
        return 1e-3 * share * force, np.full(len(force), 1e-3 * share)

    asked = replace(problem(case, record, (NAME,)), response=hardly, noise_depth=1e-9)
    done = fit(asked)
    assert done.at_bound.all()
    known = knowledge(asked, done, 0.0)
    assert not known.estimates[0].told
    said = " ".join(warnings(asked, done, known, limit=1.0))
    assert "ran into the end" in said
    assert "larger than it can make them" in said
