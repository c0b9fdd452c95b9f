"""What data tell, in numbers and in sentences."""

from dataclasses import replace

import numpy as np
import pytest

from pressed_pads import blank, filled, pad, problem, softer, triangle
from trocar.study.calibration.fit import fit
from trocar.study.calibration.identifiability import Combination, knowledge

NAMES = ("body.young_modulus", "skin.young_modulus")


def known(names, case=None, noise=4e-6, model_error=0.0, **fields):
    case = case or pad()
    record = filled(blank(*triangle(rows=81)), case, softer(case), noise=noise)
    asked = problem(case, record, names, **fields)
    return knowledge(asked, fit(asked), model_error)


def test_one_modulus_of_one_depth_has_the_interval_of_a_slope():
    found = known(NAMES[:1])
    time, force = triangle(rows=81)
    case = pad()
    rows = filled(blank(time, force), case, softer(case)).series[0].value
    # d ln(depth)/d ln(E): minus one for both moduli together, most of it the body's
    slope = found.estimates[0].from_noise * np.sqrt(((rows - rows.mean()) ** 2).sum()) / 4e-6
    assert 1.0 < slope < 1.5
    assert found.estimates[0].told
    assert found.sentences[0].startswith("The data tell body.young_modulus to ")


def test_one_depth_tells_two_moduli_only_as_a_product():
    found = known(NAMES)
    assert not any(one.told for one in found.estimates)
    best, worst = found.combinations
    assert best.error < 0.02
    assert worst.error > 1.0
    assert (best.exponents > 0).all() or (best.exponents < 0).all()
    assert "cannot tell body.young_modulus and skin.young_modulus apart: they know only" in found.sentences[0]
    assert abs(found.correlation[0, 1]) > 0.99


def test_what_has_no_influence_is_said_to_have_none():
    case = pad(thickness=1e-4)
    found = known(("body.young_modulus", "skin.poisson_ratio"), case)
    assert found.estimates[0].told
    assert found.estimates[1].without_influence
    assert "skin.poisson_ratio has no influence" in found.sentences[1]


def test_a_models_error_is_an_error_of_the_modulus():
    exact, doubted = known(NAMES[:1], noise=1e-7), known(NAMES[:1], noise=1e-7, model_error=0.01)
    assert doubted.estimates[0].from_model == pytest.approx(
        0.012, rel=0.2
    )  # the body bears most of the depth
    assert doubted.estimates[0].error > 10 * exact.estimates[0].error


@pytest.mark.parametrize(
    ("exponents", "words"),
    [
        ((0.71, 0.70), "the product of body.young_modulus and skin.young_modulus"),
        ((-0.71, -0.70), "the product of body.young_modulus and skin.young_modulus"),
        ((0.71, -0.70), "the ratio body.young_modulus/skin.young_modulus"),
        ((0.995, 0.1), "body.young_modulus"),
        ((0.5, -0.87), "skin.young_modulus^0.87 body.young_modulus^−0.50"),
    ],
)
def test_a_combination_in_words(exponents, words):
    case = pad()
    parameters = problem(case, blank(*triangle()), NAMES).parameters
    assert Combination(exponents=np.array(exponents), error=0.1).words(parameters) == words


def test_rows_that_resemble_their_neighbours_widen_the_interval():
    case = pad()
    record = filled(blank(*triangle(rows=401)), case, softer(case), noise=4e-6)
    smooth = np.convolve(
        record.series[0].value - filled(record, case, softer(case)).series[0].value, np.ones(8) / 8, "same"
    )
    rows = filled(record, case, softer(case)).series[0].value
    slow = replace(record, series=(replace(record.series[0], value=rows + smooth * np.sqrt(8)),))
    widths = []
    for one in (record, slow):
        asked = problem(case, one, NAMES[:1])
        widths.append(knowledge(asked, fit(asked), 0.0).estimates[0].error)
    assert widths[1] > 2 * widths[0]  # eight rows are worth one, the root of which is 2.8
