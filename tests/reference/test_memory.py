"""FEASolid with Prony series: closed forms where every layer has the same, the recursion, energy."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad

from trocar.errors import InputError
from trocar.model import Press
from trocar.reference import FEASolid, MeshSize
from trocar.reference.branches import _kappa, _theta
from trocar.tissues import Layer, Tissue

SIZE = (0.03, 0.024)
COARSE = MeshSize(per_radius=1.0, growth=1.2, top=0.6, deepening=1.2, side=0.8)
PRESS = Press(x=0.015, y=0.012, radius=3e-3, force=0.05)
UNDER = np.array([[0.015, 0.012, 0.0]])
WEIGHT, TIME = 0.7, 0.4
NONE = (PRESS.with_force(0.0),)


def solid(*series, massless=True, loss_factor=0.0) -> FEASolid:
    wall = Layer(
        name="wall",
        thickness=1e-3,
        young_modulus=2e5,
        poisson_ratio=0.45,
        density=1050.0,
        loss_factor=loss_factor,
    )
    fat = replace(wall, name="fat", thickness=6e-3, young_modulus=1e4, poisson_ratio=0.48, density=950.0)
    tissue = Tissue(layers=(replace(wall, prony=series[0]), replace(fat, prony=series[-1])))
    return FEASolid(tissue, size=SIZE, support="base", around=(PRESS,), mesh=COARSE, massless=massless)


def depth(model, state) -> float:
    return -float(model.displacement(state, UNDER)[0, 2])


def test_the_recursions_factors_are_the_integrals_they_stand_for():
    for x in (1e-6, 9e-4, 1.1e-3, 0.5, 30.0):
        assert _theta(x) == pytest.approx(quad(lambda s, x=x: np.exp(-x * (1 - s)), 0, 1)[0], rel=1e-10)
        mean = quad(lambda t, x=x: -np.expm1(-x * t) / x, 0, 1)[0]
        assert _kappa(x) == pytest.approx(mean, rel=1e-10)


def test_even_layers_creep_as_the_standard_linear_solid():
    """All moduli relax alike, so the deflection is the elastic one times k J(t); steps of a 40th of tau."""
    model = solid(((WEIGHT, TIME),))
    held = depth(model, model.static((PRESS,)))
    state = model.step(model.init(), NONE, (PRESS,), 1e-7)
    # The jump is exact up to its length over tau, then each step is second order: (dt/tau)^2/12.
    assert depth(model, state) == pytest.approx(held / (1 + WEIGHT), rel=1e-6)
    dt = TIME / 40
    for i in range(1, 121):
        state = model.step(state, (PRESS,), (PRESS,), dt)
        if i % 40 == 0:
            expected = held * (1 - WEIGHT / (1 + WEIGHT) * np.exp(-i * dt / (TIME * (1 + WEIGHT))))
            assert depth(model, state) == pytest.approx(expected, rel=5e-5)


def test_uneven_layers_converge_with_the_second_order():
    """Against 160 steps; a smooth load of one second."""
    model = solid(((0.9, 0.2), (0.3, 2.0)), ((1.5, 0.6),))

    def end(count):
        forces = 1 - np.cos(np.pi * np.linspace(0, 1, count + 1))
        state = model.init()
        for f0, f1 in pairwise(forces):
            state = model.step(state, (PRESS.with_force(f0),), (PRESS.with_force(f1),), 1 / count)
        return depth(model, state)

    coarse, fine, finest = end(10), end(20), end(160)
    assert np.log2(abs(coarse - finest) / abs(fine - finest)) == pytest.approx(2.0, abs=0.2)


def test_it_stands_at_last_where_long_term_moduli_hold_it():
    model = solid(((0.9, 0.2), (0.3, 2.0)), ((1.5, 0.6),))
    state = model.step(model.init(), NONE, (PRESS,), 1e-7)
    for _ in range(30):
        state = model.step(state, (PRESS,), (PRESS,), 2.0)
    assert depth(model, state) == pytest.approx(depth(model, model.static((PRESS,))), rel=1e-6)
    assert model.reaction(state, (PRESS,))[2] == pytest.approx(0.05, rel=1e-6)


def test_with_inertia_it_swings_as_the_instantaneous_moduli_at_first():
    """Within 2 ms a series with seconds has not begun to relax."""
    slow, stiff = solid(((WEIGHT, 50.0),), massless=False), solid((), massless=False)
    light = FEASolid(
        Tissue(
            layers=tuple(
                replace(layer, young_modulus=layer.young_modulus * (1 + WEIGHT))
                for layer in stiff.tissue.layers
            )
        ),
        size=SIZE,
        support="base",
        around=(PRESS,),
        mesh=COARSE,
    )
    states = [model.init() for model in (slow, light)]
    for _ in range(20):
        states = [
            model.step(state, (PRESS,), (PRESS,), 1e-4)
            for model, state in zip((slow, light), states, strict=True)
        ]
    assert depth(slow, states[0]) == pytest.approx(depth(light, states[1]), rel=1e-4)


def test_branches_only_take_energy():
    """Long-term elastic, kinetic and the branches' own energy never grow in a released block."""
    model = solid(((0.9, 0.02),), ((1.5, 0.004), (0.5, 1.0)), massless=False)
    system = model._system
    state = model.static((PRESS,))
    before = np.inf
    for _ in range(100):
        state = model.step(state, (), (), 2e-3)
        total = 0.0
        for parity, field in state.displacement.items():
            u, v = field.ravel(), state.velocity[parity].ravel()
            total += u @ (system.stiffness @ u) + v @ (system.mass @ v)
            for part, y in zip(system.branches.stiffness, state.memory[parity], strict=True):
                total += y.ravel() @ (part @ y.ravel())
        assert total <= before * (1 + 1e-9)
        before = total


def test_stress_of_a_state_whose_branches_bear_some_is_refused():
    model = solid(((WEIGHT, TIME),))
    with pytest.raises(InputError, match="no Prony branch bears stress"):
        model.stress(model.step(model.init(), NONE, (PRESS,), 0.1))
    assert model.stress(model.static((PRESS,)))["wall"] > 0


def test_without_series_and_mass_a_step_is_the_equilibrium():
    model = solid(())
    state = model.step(model.init(), NONE, (PRESS,), 0.1)
    assert depth(model, state) == pytest.approx(depth(model, model.static((PRESS,))), rel=1e-9)
