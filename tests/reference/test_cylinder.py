"""A disc between platens: the even solution where its faces slide, shape factors where they are held."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq

from reference.closed_forms import MU, principal
from trocar.errors import InputError
from trocar.reference.cylinder import Cylinder
from trocar.tissues.law import Fibre, Law, NeoHookean, Ogden

RUBBERY = NeoHookean()
OGDEN = Ogden(terms=((0.8, 3.0), (0.2, -2.0)))


def disc(law: Law = RUBBERY, *, radius=0.025, height=0.03, bulk=50 * MU, bonded=False, **options) -> Cylinder:
    return Cylinder(
        radius=radius, height=height, law=law, shear_modulus=MU, bulk_modulus=bulk, bonded=bonded, **options
    )


def even_force(law: Law, strain: float, bulk: float, radius: float) -> float:
    """Force on faces that slide, from the laws' formulas: no stress across."""

    def stress(across: float) -> np.ndarray:
        return principal(law, np.array([across, across, 1 - strain]), bulk)

    across = brentq(lambda stretch: stress(stretch)[0], 0.9, 3.0, xtol=1e-14)
    return -np.pi * radius**2 * stress(across)[2]


@pytest.mark.parametrize("law", [NeoHookean(), OGDEN], ids=lambda law: type(law).__name__)
def test_faces_that_slide_give_the_even_solution(law: Law) -> None:
    strains = np.array([0.01, 0.2, 0.5])
    curve = disc(law, elements=(3, 2)).press(strains)
    assert curve.stopped == ""
    expected = [even_force(law, strain, 50 * MU, 0.025) for strain in strains]
    # quadratic elements hold even strain: what is left is what Newton's method leaves
    np.testing.assert_allclose(curve.force, expected, rtol=1e-8)


def test_a_small_press_has_the_linear_stiffness() -> None:
    for bonded in (False, True):
        body = disc(bonded=bonded)
        strain = 1e-5
        force = body.press(np.array([strain])).force[0]
        # the force is off by its curvature, about strain itself
        assert force / (strain * body.height) == pytest.approx(body.linear_stiffness, rel=3 * strain)
    young = 9 * 50 * MU * MU / (3 * 50 * MU + MU)
    assert disc().linear_stiffness == pytest.approx(young * np.pi * 0.025**2 / 0.03, rel=1e-9)


@pytest.mark.parametrize("shape_factor", [2.5, 5.0])
def test_wide_bonded_discs_have_gent_and_lindleys_shape_factor(shape_factor: float) -> None:
    # A. N. Gent and P. B. Lindley 1959, Proc. Inst. Mech. Eng. 173:111: E (1 + 2 S^2) while the disc is much stiffer
    # against volume change, S = radius / (2 height); a parabola of pressure leaves out edges, of order 1/S^2
    height = 0.01
    body = disc(radius=2 * shape_factor * height, height=height, bulk=1e6 * MU, bonded=True, elements=(16, 3))
    apparent = body.linear_stiffness * height / (np.pi * body.radius**2)
    assert apparent == pytest.approx(3 * MU * (1 + 2 * shape_factor**2), rel=0.5 / shape_factor**2)


def test_held_faces_stiffen_and_twice_as_many_elements_change_little() -> None:
    strains = np.array([0.1, 0.3, 0.45])
    free, held = (disc(bonded=bonded).press(strains).force for bonded in (False, True))
    fine = disc(bonded=True, elements=(9, 6)).press(strains)
    assert fine.stopped == ""
    assert (held > 1.2 * free).all()
    np.testing.assert_allclose(
        held, fine.force, rtol=0.015
    )  # the singular edge: first order, 1 % on this mesh


def test_the_side_of_a_bonded_disc_lays_itself_on_the_platen() -> None:
    curve = disc(bonded=True).press(np.array([0.2, 0.6]))
    assert curve.stopped == ""
    assert curve.past[0] == 0.0
    assert 0.0 < curve.past[1] < 0.01  # of the height: what a spring gives under its share of the pressure
    assert curve.force[1] > 1.3 * even_force(NeoHookean(), 0.6, 50 * MU, 0.025)


def test_what_cannot_be_pressed_is_refused() -> None:
    with pytest.raises(InputError, match="cylinder: law: expected neo-Hookean or Ogden, got 'Fibre'"):
        disc(Fibre(k1=1.0, k2=1.0))
    with pytest.raises(InputError, match="cylinder: radius: expected a number above 0"):
        disc(radius=0.0)
    with pytest.raises(InputError, match="ascending numbers"):
        disc().press(np.array([0.2, 0.1]))
