"""Fourier coefficients and sums."""

import numpy as np
import pytest

from trocar.errors import InputError
from trocar.waves.series import Series

SIZE = (0.06, 0.04)


def test_coefficients_of_a_parabola_match_the_closed_form():
    series = Series(SIZE, (9, 7))
    a, b = SIZE
    table = series.coefficients(lambda x, y: x * (a - x) * y * (b - y))
    m, n = np.arange(1, 10)[:, None], np.arange(1, 8)[None, :]
    # int_0^a x (a - x) sin(m pi x/a) dx = 2 a^3 (1 - (-1)^m)/(m pi)^3
    along = 2 * a**3 * (1 - (-1.0) ** m) / (m * np.pi) ** 3
    across = 2 * b**3 * (1 - (-1.0) ** n) / (n * np.pi) ** 3
    expected = 4 / (a * b) * along * across
    # Quadrature rounds to 1e-16 of the largest coefficient.
    assert table[1:, 1:] == pytest.approx(expected, abs=1e-15 * expected.max())
    assert not table[0].any()
    assert not table[:, 0].any()


def test_a_single_mode_is_found_alone():
    series = Series(SIZE, (12, 12))
    table = series.coefficients(
        lambda x, y: np.sin(3 * np.pi * x / SIZE[0]) * np.sin(5 * np.pi * y / SIZE[1])
    )
    expected = np.zeros_like(table)
    expected[3, 5] = 1.0
    assert table == pytest.approx(expected, abs=1e-14)


def test_sums_match_the_definition():
    series = Series(SIZE, (3, 4))
    table = np.random.default_rng(0).normal(size=(4, 5))
    points = np.array([[0.01, 0.02, 0.0], [0.05, 0.013, 0.0]])
    for p, (x, y, _) in enumerate(points):
        phase_x, phase_y = series.kx[:, None] * x, series.ky[None, :] * y
        assert series.vertical(table, points)[p] == pytest.approx(
            (table * np.sin(phase_x) * np.sin(phase_y)).sum()
        )
        assert series.along_x(table, points)[p] == pytest.approx(
            (table * np.cos(phase_x) * np.sin(phase_y)).sum()
        )
        assert series.along_y(table, points)[p] == pytest.approx(
            (table * np.sin(phase_x) * np.cos(phase_y)).sum()
        )


@pytest.mark.parametrize(
    ("size", "modes", "word"),
    [((0.06, -1.0), (3, 3), "size"), ((0.06, float("nan")), (3, 3), "size"), (SIZE, (0, 3), "modes")],
)
def test_impossible_blocks_are_refused(size, modes, word):
    with pytest.raises(InputError, match=word):
        Series(size, modes)


def test_a_field_that_is_not_finite_is_refused():
    with pytest.raises(InputError, match="finite values"):
        Series(SIZE, (3, 3)).coefficients(lambda x, y: np.where(x > 0.03, np.nan, y))
