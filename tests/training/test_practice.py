"""Proficiency and CUSUM, against published charts."""

from math import log

import numpy as np
import pytest

from trocar.errors import InputError
from trocar.training.practice import Cusum, proficient

DEATHS = (34, 53, 55, 59, 63, 64, 67, 68, 100)  # of 104 operations: de Leval et al. 1994


def operations():
    return [number in DEATHS for number in range(1, 105)]


def test_the_published_step_and_limits():
    found = Cusum()
    assert found.step == pytest.approx(0.0919, abs=5e-5)
    assert found.alarm == pytest.approx(1.816, abs=5e-4)
    assert found.proof == pytest.approx(1.816, abs=5e-4)


@pytest.mark.parametrize(
    ("rates", "alarm", "highest"), [((0.02, 0.05), 59, 6.491), ((0.05, 0.10), 64, 4.365)]
)
def test_de_levals_operations(rates, alarm, highest):
    chart = Cusum(acceptable=rates[0], unacceptable=rates[1]).page_chart(operations())
    assert int(np.argmax(chart > log(19))) + 1 == alarm
    assert chart.max() == pytest.approx(highest, abs=5e-4)  # the printed digits
    assert int(np.argmax(chart)) + 1 == 68


def test_a_chart_falls_by_s_and_rises_by_the_rest():
    cusum = Cusum()
    np.testing.assert_allclose(
        cusum.chart([False, True, False]), np.cumsum([-cusum.step, 1 - cusum.step, -cusum.step])
    )


def test_an_acceptable_trainee_falls_and_a_poor_one_rises():
    rng = np.random.default_rng(0)
    cusum = Cusum()
    assert cusum.chart(rng.random(2000) < 0.05)[-1] < -cusum.proof
    assert cusum.chart(rng.random(2000) < 0.15)[-1] > cusum.alarm


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"acceptable": 0.2}, "acceptable < unacceptable"),
        ({"unacceptable": 1.0}, "acceptable < unacceptable"),
        ({"alpha": 0.0}, "alpha"),
        ({"beta": 0.5}, "beta"),
    ],
)
def test_impossible_charts_are_refused(values, words):
    with pytest.raises(InputError, match=words):
        Cusum(**values)


@pytest.mark.parametrize(
    ("passed", "besides", "after"),
    [
        ([], 0, None),
        ([True], 0, None),
        ([True, False, True, True], 0, 4),
        ([True, True], 1, None),
        ([True, True, False, True], 1, 4),
        ([True, False, True, False, True], 0, None),
    ],
)
def test_proficiency(passed, besides, after):
    assert proficient(passed, besides=besides) == after
