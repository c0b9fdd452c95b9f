"""The hyperelastic laws at a point: derivatives, closed forms, turning, small strain."""

from __future__ import annotations

from math import cos, exp, sin

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation

from reference.closed_forms import BULK, LAWS, MU, RUBBER, principal
from trocar.reference.hyperelastic import Material, first_piola, nominal_moduli
from trocar.tissues import Fibre, Law, NeoHookean, Ogden


def material(law: Law, prestress: tuple[float, float] = (0.0, 0.0)) -> Material:
    return Material(law=law, shear_modulus=MU, isochoric_share=1.0, bulk_modulus=BULK, prestress=prestress)


def nominal(law: Law, gradient: np.ndarray, prestress: tuple[float, float] = (0.0, 0.0)) -> np.ndarray:
    stress, _ = material(law, prestress).second_piola(gradient, tangent=False)
    return first_piola(gradient, stress)


def gradients(count: int = 60) -> np.ndarray:
    found = np.eye(3) + 0.3 * np.random.default_rng(1).normal(size=(4 * count, 3, 3))
    return found[np.linalg.det(found) > 0.4][:count]


def away_from_slack(law: Law, found: np.ndarray) -> np.ndarray:
    """Leave out where a family of fibres is about to go slack: the tangent jumps there."""
    if not isinstance(law, Fibre):
        return found
    stretch = found.transpose(0, 2, 1) @ found / np.linalg.det(found)[:, None, None] ** (2 / 3)
    first = np.trace(stretch, axis1=1, axis2=2)
    kept = np.ones(len(found), dtype=bool)
    for sign in (1, -1):
        a = np.array([cos(law.angle), sign * sin(law.angle), 0.0])
        fourth = np.einsum("i,nij,j->n", a, stretch, a)
        kept &= np.abs(law.dispersion * first + (1 - 3 * law.dispersion) * fourth - 1) > 1e-3
    return found[kept]


@pytest.mark.parametrize("law", LAWS, ids=lambda law: type(law).__name__)
def test_stress_is_the_derivative_of_energy_and_tangent_that_of_stress(law: Law) -> None:
    found, step = away_from_slack(law, gradients()), 1e-6
    assert len(found) > 40
    body = material(law, (3e3, 1e3))
    stress, moduli = body.second_piola(found, tangent=True)
    assert moduli is not None
    first = first_piola(found, stress)
    tangent = nominal_moduli(found, stress, moduli).reshape(-1, 3, 3, 3, 3)
    size = np.abs(first).max(axis=(1, 2))
    # central differences of step 1e-6: truncation 1e-12 of the third derivative, rounding 1e-16 / 1e-6
    for i, j in np.ndindex(3, 3):
        change = np.zeros((3, 3))
        change[i, j] = step
        slope = (body.energy(found + change) - body.energy(found - change)) / (2 * step)
        assert np.abs((slope - first[:, i, j]) / size).max() < 1e-7
        turned = (nominal(law, found + change, (3e3, 1e3)) - nominal(law, found - change, (3e3, 1e3))) / (
            2 * step
        )
        assert np.abs(turned - tangent[:, :, :, i, j]).max() < 1e-7 * np.abs(tangent).max()
    assert np.abs(tangent - tangent.transpose(0, 3, 4, 1, 2)).max() < 1e-12 * np.abs(tangent).max()


@pytest.mark.parametrize("law", LAWS, ids=lambda law: type(law).__name__)
def test_turning_the_tissue_turns_its_stress_and_costs_no_energy(law: Law) -> None:
    found, turn = gradients(), Rotation.from_rotvec([0.4, -1.1, 0.7]).as_matrix()
    body = material(law, (3e3, 1e3))
    np.testing.assert_allclose(body.energy(turn @ found), body.energy(found), rtol=1e-11, atol=1e-9)
    plain = nominal(law, found, (3e3, 1e3))
    # products of matrices: a few roundings of the largest entry
    np.testing.assert_allclose(
        nominal(law, turn @ found, (3e3, 1e3)), turn @ plain, rtol=0, atol=1e-12 * np.abs(plain).max()
    )


@pytest.mark.parametrize("law", LAWS[:2], ids=lambda law: type(law).__name__)
def test_isotropic_laws_do_not_see_how_the_tissue_lies(law: Law) -> None:
    found, turn = gradients(), Rotation.from_rotvec([-0.3, 0.5, 0.9]).as_matrix()
    np.testing.assert_allclose(material(law).energy(found @ turn), material(law).energy(found), rtol=1e-10)


@pytest.mark.parametrize("law", LAWS[:2], ids=lambda law: type(law).__name__)
def test_at_small_strain_every_law_is_hookes(law: Law) -> None:
    rest = np.eye(3)[None]
    stress, moduli = material(law, (3e3, 1e3)).second_piola(rest, tangent=True)
    assert moduli is not None
    np.testing.assert_allclose(stress[0], [3e3, 1e3, 0, 0, 0, 0], atol=1e-9)
    lame = BULK - 2 / 3 * MU
    expected = np.zeros((6, 6))
    expected[:3, :3] = lame
    expected += MU * np.diag([2.0, 2.0, 2.0, 1.0, 1.0, 1.0])
    np.testing.assert_allclose(moduli[0], expected, atol=1e-9 * BULK)


def test_fibres_add_their_stiffness_in_tension_and_none_in_compression() -> None:
    law = Fibre(k1=3e4, k2=2.0, dispersion=0.0, angle=0.0)  # both families along x
    plain = NeoHookean()
    for stretch, fibres in ((1.05, True), (0.95, False)):
        found = np.diag([stretch, stretch**-0.5, stretch**-0.5])[None]
        extra = nominal(law, found)[0, 0, 0] - nominal(plain, found)[0, 0, 0]
        strain = stretch**2 - 1
        pulled = 2 * 2 * 3e4 * strain * exp(2 * strain**2) * stretch  # dW/dl of both families, W(l^2 - 1)
        assert extra == pytest.approx(
            pulled * (1 - 1 / 3) if fibres else 0.0, rel=1e-9
        )  # a third is pressure


@pytest.mark.parametrize("law", LAWS, ids=lambda law: type(law).__name__)
@pytest.mark.parametrize("stretches", [(1.7, 0.8, 0.75), (1.4, 1.4, 0.5), (0.5, 1.45, 1.4), (1.2, 1.2, 1.2)])
def test_principal_stretches_give_the_closed_form(law: Law, stretches: tuple[float, ...]) -> None:
    found = nominal(law, np.diag(stretches)[None])[0]
    np.testing.assert_allclose(np.diag(found), principal(law, np.array(stretches)), rtol=1e-10)
    assert np.abs(found - np.diag(np.diag(found))).max() < 1e-9 * np.abs(found).max()


@pytest.mark.parametrize("law", LAWS[:2], ids=lambda law: type(law).__name__)
def test_uniaxial_stretch_nears_the_incompressible_formula(law: Law) -> None:
    """Sides free; neo-Hooke's P = mu (l - l^-2) and Ogden's like it, for K far above mu."""
    bulk = 1e4 * MU
    stiff = Material(law=law, shear_modulus=MU, isochoric_share=1.0, bulk_modulus=bulk)
    for stretch in (0.6, 1.5, 2.0):
        side = brentq(lambda s, x=stretch: principal(law, np.array([x, s, s]), bulk)[1], 0.3, 2.0, xtol=1e-14)
        gradient = np.diag([stretch, side, side])[None]
        found = first_piola(gradient, stiff.second_piola(gradient, tangent=False)[0])[0, 0, 0]
        terms = law.terms if isinstance(law, Ogden) else ((1.0, 2.0),)
        expected = sum(
            2 * share * MU / alpha * (stretch ** (alpha - 1) - stretch ** (-alpha / 2 - 1))
            for share, alpha in terms
        )
        assert found == pytest.approx(expected, rel=1e-3)  # a few times mu / K = 1e-4


def test_simple_shear_of_a_neo_hookean_solid_is_proportional_to_its_amount() -> None:
    """J = 1: P_12 = mu g, and the normal stresses differ by mu g^2 (Rivlin's relation for Cauchy stress)."""
    for amount in (0.2, 1.0, 2.5):
        gradient = np.eye(3)
        gradient[0, 1] = amount
        first = nominal(NeoHookean(), gradient[None])[0]
        cauchy = first @ gradient.T
        assert cauchy[0, 1] == pytest.approx(MU * amount, rel=1e-12)
        assert cauchy[0, 0] - cauchy[1, 1] == pytest.approx(MU * amount**2, rel=1e-12)


def test_ogden_with_exponent_two_is_neo_hooke() -> None:
    found = gradients()
    one, two = (nominal(law, found) for law in (Ogden(terms=((1.0, 2.0),)), NeoHookean()))
    np.testing.assert_allclose(one, two, rtol=0, atol=1e-11 * np.abs(two).max())


def test_equal_principal_stretches_are_no_exception() -> None:
    """The tangent of an Ogden law at rest and under equibiaxial stretch, where the principal axes are anyone's."""
    law = Ogden(terms=RUBBER)
    for stretches in ((1.0, 1.0, 1.0), (1.3, 1.3, 0.6), (1.3, 1.3 + 1e-9, 0.6)):
        found = np.diag(stretches)[None]
        stress, moduli = material(law).second_piola(found, tangent=True)
        assert moduli is not None
        tangent = nominal_moduli(found, stress, moduli).reshape(3, 3, 3, 3)
        for i, j in np.ndindex(3, 3):
            change = np.zeros((3, 3))
            change[i, j] = 1e-6
            slope = (nominal(law, found + change) - nominal(law, found - change))[0] / 2e-6
            np.testing.assert_allclose(slope, tangent[:, :, i, j], rtol=0, atol=1e-7 * np.abs(tangent).max())


def test_dispersed_all_ways_fibres_are_isotropic() -> None:
    law = Fibre(k1=2e4, k2=1.0, dispersion=1 / 3, angle=0.3)
    found, turn = gradients(), Rotation.from_rotvec([-0.3, 0.5, 0.9]).as_matrix()
    np.testing.assert_allclose(material(law).energy(found @ turn), material(law).energy(found), rtol=1e-9)
