"""Knots of a patch: which there are, and what points take from them."""

import numpy as np
import pytest

from trocar.waves.mesh.knots import GAP, knots

OFFSETS = np.array([np.linspace(-1.2e-3, 1.2e-3, 9), np.linspace(-2e-4, 1.8e-3, 9)])


def test_knots_lie_from_end_to_end_and_close_enough():
    places, _ = knots(OFFSETS, 3e-3)
    assert places[:, [0, -1]] == pytest.approx(OFFSETS[:, [0, -1]])
    assert np.diff(places, axis=1).max() <= GAP * 3e-3


def test_points_take_polynomials_exactly_along_both_tangents():
    places, onto = knots(OFFSETS, 3e-3)
    count = places.shape[1]
    for tool in range(2):
        for power in range(count):
            of_knots, of_points = (
                1 + np.multiply.outer((1e3 * at) ** power, (1e3 * at) ** (count - 1))
                for at in (places[tool], OFFSETS[tool])
            )
            assert onto[tool] @ of_knots.ravel() == pytest.approx(of_points.ravel(), rel=1e-12)


@pytest.mark.parametrize(
    ("offsets", "spacing"),
    [(OFFSETS[:, ::3], 3e-3), (OFFSETS, 3e-4), (np.zeros((2, 9)), 3e-3)],
    ids=["few points", "wide apart", "all at one place"],
)
def test_else_every_point_is_one(offsets, spacing):
    places, onto = knots(offsets, spacing)
    assert np.array_equal(places, offsets)
    assert onto.shape == (2, 0, 0)
