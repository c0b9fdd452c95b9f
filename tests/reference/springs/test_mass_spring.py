"""The mass-spring model against finite elements, and what it refuses."""

from dataclasses import replace
from itertools import pairwise
from math import log2, pi, sin

import numpy as np
import pytest

from sample_tissues import three_layers
from trocar.errors import InputError
from trocar.model import Press
from trocar.reference import FEASolid, MeshSize
from trocar.reference.newton import Directions, NewtonError, balance
from trocar.reference.part import Static
from trocar.reference.springs.lattice import DeformedLattice
from trocar.reference.springs.mass_spring import MassSpring, lattice_size
from trocar.tissues import Layer, NeoHookean, Ogden, Tissue

SIZE = (0.06, 0.06)
PAD = Layer(name="pad", thickness=0.01, young_modulus=1e4, poisson_ratio=0.48, density=1000.0)
MEDIUM = MeshSize(per_radius=2.0, growth=0.6, top=0.4, deepening=0.7, side=0.4)  # within 1.5 %


def pressed(force):
    return (Press(x=0.03, y=0.03, radius=0.004, force=force),)


def springs(tissue, per_radius, *, support="base", linearised=True, **given):
    return MassSpring(
        tissue,
        size=SIZE,
        support=support,
        around=pressed(1.0),
        mesh=lattice_size(per_radius),
        linearised=linearised,
        **given,
    )


def elements(tissue, support="base", mesh=MEDIUM):
    return FEASolid(tissue, size=SIZE, support=support, around=pressed(1.0), mesh=mesh)


def deepest(model, force=1e-3):
    return np.array(list(model.largest_deflection(model.static(pressed(force))).values()))


def lawful(tissue):
    return Tissue(layers=tuple(replace(layer, law=NeoHookean()) for layer in tissue.layers))


def test_it_converges_to_the_finite_elements_with_second_order():
    pad, load = Tissue(layers=(PAD,)), pressed(1e-3)
    expected = deepest(elements(pad, mesh=MeshSize()))[0]  # within 0.2 %
    errors = []
    for refinement in range(3):
        mesh = replace(lattice_size(1.5), refinement=refinement)
        model = MassSpring(pad, size=SIZE, support="base", around=load, mesh=mesh, linearised=True)
        errors.append(abs(deepest(model)[0] / expected - 1))
    assert errors[-1] < 0.015
    for coarse, fine in pairwise(errors):
        assert 1.5 < log2(coarse / fine) < 2.5  # 2 in the limit: `bench/springs.py`


@pytest.mark.parametrize("support", ["base", "edges+base", "edges"])
def test_every_layer_of_skin_is_within_a_tenth_of_the_finite_elements(support):
    found, expected = (
        deepest(make)
        for make in (springs(three_layers(), 4, support=support), elements(three_layers(), support))
    )
    assert found == pytest.approx(expected, rel=0.1)


def test_nearly_incompressible_tissue_does_not_lock():
    pad = Tissue(layers=(replace(PAD, poisson_ratio=0.499),))
    assert deepest(springs(pad, 6)) == pytest.approx(deepest(elements(pad)), rel=0.03)


def test_springs_that_turn_are_linear_under_a_small_load_and_follow_the_finite_elements_under_a_large_one():
    tissue = three_layers()
    turning, still = springs(tissue, 3, linearised=False), springs(tissue, 3)
    assert deepest(turning, 1e-6) == pytest.approx(deepest(still, 1e-6), rel=1e-5)  # as the strain, 1e-6
    large, linear = deepest(turning, 0.6), deepest(still, 0.6)
    expected = deepest(elements(lawful(tissue)), 0.6)
    assert large == pytest.approx(
        expected, rel=0.15
    )  # three boxes to a radius miss 10 % of the linear answer
    assert (large < 0.9 * linear).all()


def test_prestress_stiffens_as_it_does_the_finite_elements():
    tense = Tissue(layers=(replace(PAD, thickness=0.002, prestress_x=8e3, prestress_y=4e3),))
    slack = Tissue(layers=(replace(PAD, thickness=0.002),))
    found, expected = deepest(springs(tense, 4, support="edges")), deepest(elements(tense, "edges"))
    assert found == pytest.approx(expected, rel=0.05)
    assert expected < 0.5 * deepest(elements(slack, "edges"))
    assert deepest(springs(tense, 4, support="edges", linearised=False), 1e-6) == pytest.approx(
        1e-3 * found, rel=1e-3
    )


def tapped(model, force, steps, dt=5e-4):
    """Return the top's deflection [m] while half a sine of 20 ms taps it."""

    def load(time):
        return pressed(force * sin(pi * time / 0.02) if time < 0.02 else 0.0)

    state, found = model.init(), []
    for i in range(steps):
        state = model.step(state, load(i * dt), load((i + 1) * dt), dt)
        found.append(model.displacement(state, np.array([[0.03, 0.03, 0.0]]))[0, 2])
    return np.array(found)


def test_a_tap_is_within_a_tenth_of_the_finite_elements():
    expected = tapped(elements(three_layers()), 1e-3, 44)
    for linearised in (True, False):
        found = tapped(springs(three_layers(), 3, linearised=linearised), 1e-3, 44)
        assert np.abs(found - expected).max() < 0.1 * np.abs(expected).max()


def energy(model, state):
    """Return what a lattice in a single quarter stores and moves with [J]."""
    part = model._large.part((False, False))
    lattice = DeformedLattice(model.boxes, model.tissue.layers, part.domain.free)
    velocity = part.freed(part.domain.field(state.velocity))
    return lattice.energy(part.domain.field(state.displacement)) + 0.5 * velocity @ (part.mass @ velocity)


@pytest.mark.parametrize("damped", [False, True])
def test_energy_never_grows_once_the_load_is_gone(damped):
    tissue = three_layers()
    if not damped:
        tissue = Tissue(layers=tuple(replace(layer, loss_factor=0.0) for layer in tissue.layers))
    model = springs(tissue, 1.0, linearised=False)
    state = model.static(pressed(0.5))
    assert model.deformation(state)["fat"].stretch[0] < 0.9  # far from small strain
    stored = [energy(model, state)]
    for _ in range(15):
        state = model.step(state, pressed(0.0), pressed(0.0), 2e-3)
        stored.append(energy(model, state))
    # Three Gauss points of the force along the step leave an error of the step's seventh power.
    assert max(stored) < (1 + 1e-4) * stored[0]
    assert (stored[-1] < 0.1 * stored[0]) if damped else (stored[-1] > 0.999 * stored[0])


def test_the_support_bears_the_force():
    for linearised in (True, False):
        model = springs(three_layers(), 1.5, linearised=linearised)
        load = (Press(x=0.02, y=0.035, radius=0.005, force=0.05, tilt=0.4, azimuth=1.0),)
        reaction = model.reaction(model.static(load), load)
        assert reaction == pytest.approx(-np.array(load[0].force_vector), abs=1e-7)


def test_what_springs_cannot_follow_is_refused():
    with pytest.raises(InputError, match="neo-hookean"):
        springs(Tissue(layers=(replace(PAD, law=Ogden(terms=((1.0, 2.0),))),)), 1.5)
    with pytest.raises(InputError, match="linearised"):
        springs(Tissue(layers=(replace(PAD, prony=((0.5, 0.1),)),)), 1.5, linearised=False)
    for number in (0.0, -1.0, float("nan")):
        with pytest.raises(InputError, match="per_radius"):
            lattice_size(number)


def test_from_far_astray_the_convex_stand_in_leads_home_where_newtons_method_alone_is_stuck(monkeypatch):
    model = springs(Tissue(layers=(PAD,)), 2, linearised=False)
    part = model._large.part((False, False))
    load = part.freed(part.domain.forces(model._forces(pressed(0.05))))
    home = part.freed(part.domain.field(model.static(pressed(0.05)).displacement))
    astray = home + 4e-4 * np.random.default_rng(0).normal(size=len(home))  # a fifth of the smaller boxes

    def found():
        scale = float(np.linalg.norm(load))
        return balance(
            Static(part, load), astray, scale=scale, tolerance=1e-10, directions=Directions("superlu")
        )

    solution = found()
    assert solution.unknowns == pytest.approx(home, abs=1e-8 * np.abs(home).max())
    least = [np.linalg.eigvalsh(Static(part, load).tangent(place).toarray())[0] for place in (home, astray)]
    assert least[0] > 0 > least[1]
    monkeypatch.setattr(DeformedLattice, "convex", lambda _self, _field: None)
    with pytest.raises(NewtonError, match="not stable"):
        found()
