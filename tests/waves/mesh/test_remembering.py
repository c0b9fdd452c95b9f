"""A mesh that remembers: closed forms, meshes of long-term and sudden moduli, and presses that move on."""

from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest

from trocar.errors import InputError
from trocar.model import Press
from trocar.tissues import Layer, Tissue
from trocar.waves.mesh.block import block_mesh
from trocar.waves.mesh.wave_mesh import WaveMesh

COVER = Layer(name="cover", thickness=2e-3, young_modulus=4e4, poisson_ratio=0.45, density=1100)
FAT = Layer(name="fat", thickness=4e-3, young_modulus=8e3, poisson_ratio=0.45, density=950, loss_factor=0.1)
UNEVEN = ((0.8, 0.01), (0.3, 5.0)), ((1.5, 0.5),)
EVEN = (((0.8, 2.0),),) * 2
HERE = Press(x=0.01, y=0.01, radius=3e-3, force=0.05, tilt=0.2)
THERE = replace(HERE, x=0.012)
WHERE = np.array([[0.01, 0.01, 0.0], [0.012, 0.009, 0.0]])


def mesh(series, **cover):
    tissue = Tissue(layers=tuple(replace(a, prony=b) for a, b in zip((COVER, FAT), series, strict=True)))
    tissue = replace(tissue, layers=(replace(tissue.layers[0], **cover), tissue.layers[1]))
    across = np.linspace(0.0, 0.02, 5)
    return block_mesh(tissue, (across, across, np.array([-6e-3, -4e-3, -2e-3, 0.0])))


@lru_cache
def made(series, *, massless):
    return WaveMesh(mesh(series), modes=12, massless=massless)


def with_moduli(solid, modulus):
    """The same mesh without memory, as stiff as `modulus` says of each material."""
    materials = tuple(replace(one, young_modulus=modulus(one), prony=()) for one in solid.materials)
    return WaveMesh(replace(solid, materials=materials), modes=5)


def near(found, expected, tolerance):
    assert found == pytest.approx(expected, abs=tolerance * np.abs(expected).max())


def still(model, load=(HERE,)):
    return np.concatenate([model.displacement(model.static(load), WHERE, name) for name in model.layer_names])


def after(model, dt, *, since=None, start=(HERE,), end=(HERE,)):
    state = model.step(since or model.init(), start, end, dt)
    return np.concatenate([model.displacement(state, WHERE, name) for name in model.layer_names])


# Conjugate gradients leave 1e-10 of a static answer, dense matrices of nearly equal vectors some digits more.
@pytest.mark.parametrize("series", [UNEVEN, EVEN])
@pytest.mark.parametrize("massless", [True, False])
def test_after_long_it_stands_where_a_mesh_of_long_term_moduli_does(series, massless):
    model = made(series, massless=massless)
    expected = still(with_moduli(model.mesh, lambda one: one.young_modulus))
    near(still(model), expected, 1e-9)
    near(after(model, 1e4), expected, 1e-9)
    near(after(model, 0.3, since=model.static((HERE,))), expected, 1e-9)


@pytest.mark.parametrize("series", [UNEVEN, EVEN])
def test_at_once_it_answers_as_a_mesh_of_sudden_moduli(series):
    model = made(series, massless=True)
    expected = still(with_moduli(model.mesh, lambda one: one.instantaneous_modulus))
    near(after(model, 1e-11), expected, 1e-7)


def test_one_series_creeps_as_the_standard_linear_solid():
    model = made(EVEN, massless=True)
    for time in (1e-3, 0.5, 3.0, 40.0):
        share = 1 - 0.8 / 1.8 * np.exp(-time / 3.6)
        near(after(model, time), share * still(model), 1e-9)


def test_modes_are_as_stiff_as_at_once():
    """Of one series they are sqrt(1 + g) times as fast as after long."""
    slow = with_moduli(mesh(EVEN), lambda one: one.young_modulus)
    assert made(EVEN, massless=True).frequencies[:5] == pytest.approx(np.sqrt(1.8) * slow.frequencies)


@pytest.mark.parametrize("series", [UNEVEN, EVEN])
@pytest.mark.parametrize("massless", [True, False])
def test_two_half_steps_are_one_and_no_pole_grows(series, massless):
    model = made(series, massless=massless)
    stronger, half = HERE.with_force(0.2), HERE.with_force(0.125)
    once = after(model, 0.08, since=model.static((HERE,)), end=(stronger,))
    between = model.step(model.static((HERE,)), (HERE,), (half,), 0.04)
    near(after(model, 0.04, since=between, start=(half,), end=(stronger,)), once, 1e-11)
    assert np.linalg.eigvals(model.oscillators((HERE,)).matrices).real.max() < 0


@pytest.mark.parametrize(("massless", "pull"), [(True, 0.0), (False, 0.0), (True, 2e3)])
def test_what_a_press_left_behind_creeps_on_when_another_comes(massless, pull):
    """Beside a model in whose basis both have been from the beginning: its vectors say a few parts in 100,000 more."""
    model = WaveMesh(mesh(UNEVEN, prestress_x=pull), modes=12, massless=massless)
    none, idle = HERE.with_force(0.0), THERE.with_force(0.0)
    alone = model.step(model.init(), (HERE,), (HERE,), 0.3)
    both = model.step(model.init(), (HERE, idle), (HERE, idle), 0.3)
    assert len(alone.presses) == 1
    for dt in (0.05, 2.0, 10.0):
        gone = after(model, dt, since=both, start=(none, idle), end=(none, idle))
        assert np.abs(gone).max() > 1e-3 * np.abs(still(model)).max()  # it remembers
        near(after(model, dt, since=alone, start=(none, idle), end=(none, idle)), gone, 1e-4)


def test_a_press_that_is_left_out_at_last_hands_its_memory_on():
    model = made(UNEVEN, massless=True)
    state = model.step(model.init(), (HERE,), (HERE,), 5.0)
    kept = after(model, 1.0, since=state, start=(HERE.with_force(0.0),), end=(HERE.with_force(0.0),))
    for x in np.linspace(0.006, 0.014, 9):
        idle = (replace(HERE, x=x, radius=2.5e-3, force=0.0),)
        state = model.step(state, idle, idle, 1e-9)
    assert HERE.with_force(1.0) not in state.presses
    near(after(model, 1.0, since=state, start=idle, end=idle), kept, 0.02)


def test_too_many_times_are_refused():
    times = [tuple((0.1, start + i) for i in range(5)) for start in (1.0, 10.0)]
    materials = tuple(replace(one, prony=own) for one, own in zip((COVER, FAT), times, strict=True))
    with pytest.raises(InputError, match="mesh: prony: expected at most 8 different times"):
        WaveMesh(replace(mesh(EVEN), materials=materials))


def test_without_inertia_and_memory_it_stands_at_once_where_it_stands_at_rest():
    """A press, another beside it, and the first gone: no state is left of what was."""
    none = ((), ())
    model, moving = made(none, massless=True), made(none, massless=False)
    near(still(model), still(moving), 1e-9)
    near(after(model, 1e-3), still(moving), 1e-9)
    both = model.step(model.init(), (HERE, THERE), (HERE, THERE), 1e-3)
    second = HERE.with_force(0.0), THERE
    near(after(model, 1e-3, since=both, start=(HERE, THERE), end=second), still(moving, (THERE,)), 1e-9)
    none_left = HERE.with_force(0.0), THERE.with_force(0.0)
    assert not after(model, 1e-3, since=both, start=(HERE, THERE), end=none_left).any()
