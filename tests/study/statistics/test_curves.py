"""One record for one pair of curves: what the paper's test misses, the others see."""

import json

import numpy as np
import pytest

from trocar.errors import InputError
from trocar.study.statistics.curves import compare_curves

TIME = np.linspace(0, 200, 81)
FORCE = 0.05 * np.minimum(TIME, 200 - TIME)
REFERENCE = 1e-3 * FORCE


def compare(model, margin=1e-4):
    return compare_curves(TIME, FORCE, REFERENCE, model, margin=margin)


def test_fifteen_percent_too_stiff_passes_the_published_test_but_nothing_else():
    found = compare(0.85 * REFERENCE)
    assert found.published_t_test.passes_as_printed
    assert found.nrmse == pytest.approx(0.15 * np.sqrt(np.mean(FORCE**2)) / 5, rel=1e-12)
    assert found.largest_error == pytest.approx(-0.75e-3, rel=1e-12)
    assert found.largest_error_time == 100
    assert not found.equivalence.shown
    assert not found.equivalence_if_independent.shown
    assert found.concordance.value < 0.96


def test_published_test_cannot_reject_a_reversed_curve():
    order = np.random.default_rng(3).permutation(81)
    found = compare(REFERENCE[order])
    assert found.published_t_test.p == pytest.approx(1, abs=1e-9)  # the same values in another order
    assert found.published_t_test.passes_as_printed
    assert found.nrmse > 0.3
    assert found.concordance.value < 0.5


def test_pseudo_replication_is_told_apart():
    wobble = 2e-4 * np.sin(TIME / 30)
    found = compare(REFERENCE + 0.5e-4 + wobble)
    assert found.n == 81
    assert found.effective_n < 3
    assert found.equivalence_if_independent.shown
    assert not found.equivalence.shown


def test_equal_curves():
    found = compare(REFERENCE)
    assert found.nrmse == 0
    assert found.peak.time == 0
    assert found.concordance.value == pytest.approx(1, rel=1e-14)
    assert found.equivalence_if_independent.shown


def test_record_is_json_without_nan():
    text = json.dumps(compare(REFERENCE + 1e-4 * np.sin(TIME)).as_dict(), allow_nan=False)
    back = json.loads(text)
    assert back["n"] == 81
    assert back["unit"] == "m"
    assert back["equivalence"]["shown"] in (True, False)
    assert len(back["limits"]["bias_interval"]) == 2
    json.dumps(compare(REFERENCE).as_dict(), allow_nan=False)


@pytest.mark.parametrize(
    "changes",
    [
        {"reference": np.ones(81)},
        {"reference": REFERENCE[:-1]},
        {"model": np.full(81, np.nan)},
        {"time": TIME[::-1]},
        {"time": TIME[:-1]},
        {"force": FORCE[:-1]},
        {"margin": 0.0},
    ],
    ids=lambda change: next(iter(change)),
)
def test_impossible_comparisons_are_refused(changes):
    arguments = {
        "time": TIME,
        "force": FORCE,
        "reference": REFERENCE,
        "model": REFERENCE,
        "margin": 1e-4,
    } | changes
    with pytest.raises(InputError):
        compare_curves(**arguments)
