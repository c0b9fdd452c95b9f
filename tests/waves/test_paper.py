"""Equations 4 and 5 to their printed digits, and what they should have given."""

import numpy as np
import pytest

from trocar.waves.paper import (
    coefficient_11,
    corrected_membrane,
    corrected_start,
    printed_membrane,
    printed_start,
)

MIDDLE = np.array([[0.03, 0.03, 0.0]])


def rounded(value, digits):
    return float(f"{value:.{digits - 1}e}")


def test_the_printed_coefficient_and_frequency():
    model = printed_membrane()
    start = printed_start(model)
    assert rounded(model.displacement(start, MIDDLE)[0, 2], 3) == pytest.approx(6.11e-6, rel=1e-3)  # 6.105e-6
    period = 2 * np.pi / 0.686
    swung = model.displacement(model.step(start, (), (), period), MIDDLE)[0, 2]
    quarter = model.displacement(model.step(start, (), (), period / 4), MIDDLE)[0, 2]
    # 0.686 is printed to three digits: half a unit in the last place is 1.1e-3 of a quarter turn.
    assert swung == pytest.approx(6.105e-6, rel=1e-4)
    assert abs(quarter) < 1.2e-3 * 6.105e-6
    sheet = model.stack.sheets[0]
    frequency = np.sqrt(2 * sheet.tension_x / sheet.areal_density) * np.pi / 0.06
    assert rounded(frequency, 3) == 0.686


def test_the_coefficient_with_the_papers_own_factor():
    assert rounded(coefficient_11((0.06, 0.06)), 4) == 6.784e-3
    assert coefficient_11((0.06, 0.06)) * 0.06**2 / 4 == pytest.approx(6.105e-6, rel=1e-4)


def test_the_corrected_dermis():
    model = corrected_membrane()
    (sheet,) = model.stack.sheets
    assert (sheet.tension_x, sheet.tension_y) == pytest.approx((24.0, 9.3))
    assert np.sqrt(sheet.tension_x / sheet.areal_density) == pytest.approx(4.67, abs=0.01)  # [m/s] along
    start = corrected_start(model)
    assert model.displacement(start, MIDDLE)[0, 2] == pytest.approx(
        5 * 0.03**4, rel=1e-4
    )  # 40 odd modes of a bump
    rim = np.array([[0.0, 0.01, 0.0], [0.06, 0.03, 0.0]])
    assert np.abs(model.displacement(start, rim)).max() < 1e-18
