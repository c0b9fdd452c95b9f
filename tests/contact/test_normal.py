"""Complementarity: what a solution is, and that one is found from anywhere."""

import numpy as np
import pytest
from hypothesis import given, seed, settings
from hypothesis import strategies as st
from scipy.optimize import nnls

from trocar.contact.normal import press


def solved(compliance, below, holding=None, touching=None):
    pads = len(below)
    holding = np.zeros(pads, dtype=bool) if holding is None else holding
    touching = np.zeros(pads, dtype=bool) if touching is None else touching
    forces = np.full(pads, np.nan)
    found = press(
        compliance,
        below,
        holding,
        touching,
        forces,
        np.empty((pads, pads)),
        np.zeros(pads + 1, dtype=np.int64),
        np.empty(pads, dtype=bool),
    )
    return found, forces, touching


def problem(generator, pads):
    root = generator.normal(size=(pads, pads))
    return root @ root.T / pads + 1e-3 * np.eye(pads), generator.normal(size=pads)


@seed(7)
@settings(max_examples=200, deadline=None, database=None)
@given(number=st.integers(0, 10**9), pads=st.integers(1, 40), start=st.integers(0, 10**9))
def test_pads_press_or_are_apart_from_any_start(number, pads, start):
    compliance, below = problem(np.random.default_rng(number), pads)
    touching = np.random.default_rng(start).integers(0, 2, pads).astype(bool)
    found, forces, touching = solved(compliance, below, touching=touching)
    gaps = compliance @ forces - below
    assert found
    assert (forces >= 0).all()
    assert gaps.min() > -1e-9 * np.abs(below).max()  # condition 1e4 times rounding, with a margin
    assert np.abs(forces * gaps).max() < 1e-9 * np.abs(below).max() * max(forces.max(), 1.0)
    assert (forces[~touching] == 0).all()


def test_it_agrees_with_non_negative_least_squares():
    """min |L^T p - L^-1 b| over p >= 0 has the same conditions, with W = L L^T."""
    generator = np.random.default_rng(1)
    for pads in (3, 12, 30):
        compliance, below = problem(generator, pads)
        lower = np.linalg.cholesky(compliance)
        expected, _ = nnls(lower.T, np.linalg.solve(lower, below))
        _, forces, _ = solved(compliance, below)
        assert forces == pytest.approx(expected, abs=1e-8 * expected.max())


def test_a_pad_that_holds_may_pull():
    compliance, below = np.array([[2.0, 0.5], [0.5, 1.0]]), np.array([-1.0, -1.0])
    assert solved(compliance, below)[1] == pytest.approx([0.0, 0.0])
    found, forces, _ = solved(compliance, below, holding=np.array([True, False]))
    assert found
    assert forces[0] == pytest.approx(-0.5)
    # Pulled up by its neighbour the other pad's surface rises by a quarter: still apart.
    assert forces[1] == 0.0


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_numbers_that_are_none_press_nothing(bad):
    compliance = np.eye(3)
    found, forces, touching = solved(compliance, np.array([1.0, bad, 1.0]), touching=np.ones(3, dtype=bool))
    assert not found
    assert (forces == 0).all()
    assert not touching.any()


def test_a_surface_that_gives_energy_away_is_refused():
    found, forces, _ = solved(
        np.array([[1.0, 2.0], [2.0, 1.0]]), np.array([1.0, 1.1]), touching=np.ones(2, dtype=bool)
    )
    assert not found
    assert (forces == 0).all()


def test_a_factor_that_is_used_again_gives_the_same_bits():
    generator = np.random.default_rng(4)
    compliance, below = problem(generator, 20)
    holding, touching = np.zeros(20, dtype=bool), np.zeros(20, dtype=bool)
    forces, factor = np.empty(20), np.empty((20, 20))
    order, wrong = np.zeros(21, dtype=np.int64), np.empty(20, dtype=bool)
    for _ in range(30):
        below = below + 0.05 * generator.normal(size=20)
        assert press(compliance, below, holding, touching, forces, factor, order, wrong)
        assert (forces == solved(compliance, below, touching=touching.copy())[1]).all()


def test_a_factor_of_another_compliance_is_forgotten_by_its_count():
    generator = np.random.default_rng(5)
    compliance, below = problem(generator, 12)
    holding, touching = np.zeros(12, dtype=bool), np.zeros(12, dtype=bool)
    forces, factor = np.empty(12), np.empty((12, 12))
    order, wrong = np.zeros(13, dtype=np.int64), np.empty(12, dtype=bool)
    press(compliance, below, holding, touching, forces, factor, order, wrong)
    before = forces.copy()
    press(2 * compliance, below, holding, touching, forces, factor, order, wrong)
    assert (forces == before).all()  # the old factor: whoever changes W has to say so
    order[-1] = 0
    press(2 * compliance, below, holding, touching, forces, factor, order, wrong)
    assert forces == pytest.approx(before / 2)
