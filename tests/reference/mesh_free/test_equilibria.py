"""Equilibria of the mesh-free model against finite elements, under small and large deformation."""

from dataclasses import replace

import numpy as np
import pytest

from trocar.errors import InputError, SolverError
from trocar.model import Press, Profile
from trocar.reference import FEASolid
from trocar.reference.block import MeshSize
from trocar.reference.mesh_free import Cut, MeshFree
from trocar.reference.mesh_free.large import Balance
from trocar.tissues import Layer, NeoHookean, Ogden, Tissue

SIZE = (0.03, 0.03)
PRESS = Press(x=0.015, y=0.015, radius=4e-3, force=0.05)
UNDER = np.array([[0.015, 0.015, 0.0]])
MESH = MeshSize(per_radius=2.0, growth=0.6, top=0.4, deepening=0.7, side=0.4)


def stacked(**options):
    base = {"poisson_ratio": 0.48, "density": 1000.0} | options
    return Tissue(
        layers=(
            Layer(name="wall", thickness=2e-3, young_modulus=5e4, **base),
            Layer(name="fat", thickness=8e-3, young_modulus=1e4, **base),
        )
    )


def pair(tissue, support="base", press=PRESS, **options):
    fea = FEASolid(tissue, size=SIZE, support=support, around=(press,), mesh=MESH)
    return fea, MeshFree(tissue, size=SIZE, support=support, around=(press,), **options)


def deflection(solid, press=PRESS, layer=None):
    return -solid.displacement(solid.static((press,)), UNDER, layer)[0, 2]


@pytest.mark.parametrize("support", ["base", "edges", "edges+base"])
def test_every_support_is_met_as_finite_elements_meet_it(support):
    fea, free = pair(stacked(), support, mirrored=True, resolution=1.5)
    for layer in ("wall", "fat"):
        assert deflection(free, layer=layer) == pytest.approx(deflection(fea, layer=layer), rel=0.04)


@pytest.mark.parametrize("profile", list(Profile))
def test_every_profile_is_met(profile):
    fea, free = pair(stacked(), press=replace(PRESS, profile=profile), mirrored=True)
    expected = deflection(fea, replace(PRESS, profile=profile))
    assert deflection(free, replace(PRESS, profile=profile)) == pytest.approx(expected, rel=0.08)  # coarse


def test_prestress_stiffens_as_in_finite_elements():
    tight = stacked(prestress_x=2e4, prestress_y=1e4)
    slack, taut = (pair(tissue, "edges", mirrored=True) for tissue in (stacked(), tight))
    expected, found = (deflection(taut[i]) / deflection(slack[i]) for i in (0, 1))
    assert expected < 0.8
    assert found == pytest.approx(expected, rel=0.02)


def test_a_quarter_answers_as_the_whole_and_its_image_is_mirrored():
    tissue = stacked()
    whole, quarter = (
        MeshFree(tissue, size=SIZE, support="base", around=(PRESS,), mirrored=mirrored, resolution=1.5)
        for mirrored in (False, True)
    )
    assert deflection(quarter) == pytest.approx(deflection(whole), rel=0.03)  # supports end at the mirrors
    places = np.array([[0.011, 0.012, 0.0], [0.019, 0.018, 0.0]])
    here, there = quarter.displacement(quarter.static((PRESS,)), places)
    np.testing.assert_allclose(there, here * [-1, -1, 1], atol=1e-12 * np.abs(here).max())


def test_tilted_presses_are_borne_by_the_support():
    press = replace(PRESS, tilt=0.4, azimuth=0.7, x=0.012)
    free = MeshFree(stacked(), size=SIZE, support="base", around=(press,))
    borne = free.reaction(free.static((press,)), (press,))
    np.testing.assert_allclose(borne, -np.array(press.force_vector), atol=1e-9)


def test_cut_or_not_the_support_bears_all_of_the_force():
    free = MeshFree(stacked(), size=SIZE, support="base", around=(PRESS,))
    cut = free.cut(Cut(start=(0.010, 0.008), end=(0.023, 0.021), depth=0.005, lean=0.3))
    assert cut.reaction(cut.static((PRESS,)), (PRESS,))[2] == pytest.approx(0.05, rel=1e-9)


def test_large_deformation_is_that_of_finite_elements():
    press = PRESS.with_force(0.4)
    fea, free = pair(stacked(law=NeoHookean()), mirrored=True, resolution=1.5)
    found, expected, linear = (
        deflection(one, press) for one in (free, fea, pair(stacked(), mirrored=True)[1])
    )
    assert abs(linear / expected - 1) > 0.08
    assert found == pytest.approx(expected, rel=0.04)
    stretched = free.deformation(free.static((press,)))
    assert stretched["fat"].stretch[0] < 0.8
    assert stretched["fat"].volume_ratio[0] > 0


def test_the_tangent_is_the_derivative_of_the_forces():
    free = MeshFree(
        stacked(law=NeoHookean(), prestress_x=500.0),
        size=SIZE,
        support="base",
        around=(PRESS,),
        mirrored=True,
    )
    body = free._body
    balance = Balance(body, np.zeros(len(body.free)))
    about = free.static((PRESS.with_force(0.2),)).displacement.ravel()[body.free]
    change = 1e-7 * np.random.default_rng(0).standard_normal(len(about))
    difference = 0.5 * (balance.imbalance(about + change) - balance.imbalance(about - change))
    expected = balance.tangent(about) @ change
    assert np.abs(difference - expected).max() < 1e-6 * np.abs(expected).max()  # the third derivative's share


def test_a_load_beyond_any_equilibrium_is_refused_in_a_sentence():
    free = MeshFree(
        stacked(law=NeoHookean()), size=SIZE, support="base", around=(PRESS,), resolution=0.4, mirrored=True
    )
    with pytest.raises(SolverError, match="of the load and no more"):
        free.static((PRESS.with_force(1e3),))


@pytest.mark.parametrize(
    ("tissue", "word"),
    [
        (stacked(prony=((0.5, 0.01),)), "prony"),
        (stacked(law=Ogden(terms=((1.0, 2.0),))), "linear or neo-Hookean"),
    ],
)
def test_tissue_it_does_not_follow_is_refused(tissue, word):
    with pytest.raises(InputError, match=word):
        MeshFree(tissue, size=SIZE, support="base")


@pytest.mark.parametrize("press", [replace(PRESS, x=0.012), replace(PRESS, tilt=0.2)])
def test_a_quarter_takes_presses_in_the_middle_alone(press):
    free = MeshFree(stacked(), size=SIZE, support="base", around=(PRESS,), mirrored=True)
    with pytest.raises(InputError, match="mirrored model"):
        free.static((press,))
    with pytest.raises(InputError, match="mirrored"):
        free.cut(Cut(start=(0.01, 0.01), end=(0.02, 0.01), depth=0.001))
