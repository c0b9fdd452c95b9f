"""Even stretch in closed form: the finite elements' stress, and the textbook's formulas."""

from __future__ import annotations

import numpy as np
import pytest

from reference.closed_forms import BULK, LAWS, MU
from trocar.reference.hyperelastic import Material, first_piola
from trocar.study.measured.homogeneous import biaxial, equibiaxial, nominal_stress, uniaxial
from trocar.tissues.law import Law, NeoHookean, Ogden

STRETCH = np.array([0.5, 0.8, 0.99, 1.0, 1.01, 1.3, 1.9])
NAMES = {"ids": lambda law: type(law).__name__}


def of_the_elements(law: Law, stretches: np.ndarray, bulk: float = BULK) -> np.ndarray:
    """Nominal stress along the axes as the finite elements have it, shape (n, 3)."""
    gradient = stretches[:, :, None] * np.eye(3)
    material = Material(law=law, shear_modulus=MU, isochoric_share=1.0, bulk_modulus=bulk)
    stress, _ = material.second_piola(gradient, tangent=False)
    return np.diagonal(first_piola(gradient, stress), axis1=1, axis2=2)


@pytest.mark.parametrize("law", LAWS, **NAMES)
def test_stress_is_that_of_the_finite_elements(law: Law) -> None:
    stretches = 1 + 0.4 * np.random.default_rng(2).uniform(-1, 1, (40, 3))
    theirs = of_the_elements(law, stretches)
    # two ways to the same double, through logarithms and through matrices: rounding times the bulk modulus
    np.testing.assert_allclose(
        nominal_stress(law, MU, stretches, BULK), theirs, rtol=0, atol=1e-12 * np.abs(theirs).max()
    )


@pytest.mark.parametrize("law", LAWS, **NAMES)
@pytest.mark.parametrize("bulk", [None, BULK])
def test_a_strip_has_no_stress_across(law: Law, bulk: float | None) -> None:
    along = uniaxial(law, MU, STRETCH, bulk)
    assert along[3] == pytest.approx(0.0, abs=1e-9 * MU)
    assert (np.diff(along) > 0).all()
    step = 1e-5
    slope = (
        uniaxial(law, MU, np.array([1 + step]), bulk) - uniaxial(law, MU, np.array([1 - step]), bulk)
    ) / (2 * step)
    young = 3 * MU if bulk is None else 9 * bulk * MU / (3 * bulk + MU)
    if law is not LAWS[2]:  # fibres add to it on one side
        assert slope[0] == pytest.approx(young, rel=1e-6)


@pytest.mark.parametrize("law", LAWS, **NAMES)
def test_the_compressible_strip_becomes_the_incompressible_one(law: Law) -> None:
    stiff, tight = (uniaxial(law, MU, STRETCH, share * MU) for share in (1e5, 1e6))
    limit = uniaxial(law, MU, STRETCH)
    apart = [np.abs(one - limit).max() / np.abs(limit).max() for one in (stiff, tight)]
    assert apart[1] < 1e-3
    assert apart[1] == pytest.approx(apart[0] / 10, rel=0.05)  # of first order in mu/K


def test_the_textbook_formulas() -> None:
    free = NeoHookean()
    np.testing.assert_allclose(uniaxial(free, MU, STRETCH), MU * (STRETCH - STRETCH**-2), atol=1e-9 * MU)
    np.testing.assert_allclose(equibiaxial(free, MU, STRETCH), MU * (STRETCH - STRETCH**-5), atol=1e-9 * MU)
    pure_shear = np.column_stack([STRETCH, np.ones(len(STRETCH))])
    expected = np.column_stack([MU * (STRETCH - STRETCH**-3), MU * (1 - STRETCH**-2)])
    np.testing.assert_allclose(biaxial(free, MU, pure_shear), expected, atol=1e-9 * MU)
    same = Ogden(terms=((1.0, 2.0),))
    np.testing.assert_allclose(biaxial(same, MU, pure_shear), expected, atol=1e-9 * MU)
    # Ogden 1972: sum of mu_i (l^(alpha-1) - l^(-alpha/2-1)) with his mu_i = 2 share mu / alpha
    law = LAWS[1]
    assert isinstance(law, Ogden)
    his = sum(
        2 * share * MU / alpha * (STRETCH ** (alpha - 1) - STRETCH ** (-alpha / 2 - 1))
        for share, alpha in law.terms
    )
    np.testing.assert_allclose(uniaxial(law, MU, STRETCH), his, atol=1e-9 * MU)
