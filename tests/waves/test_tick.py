"""The compiled tick does what `WaveMembrane.step` and `displacement` do."""

import numpy as np
import pytest

from trocar.errors import InputError
from trocar.model import Press, Profile
from trocar.tissues.catalogue import tissue
from trocar.waves.cutoff import cutoff_for
from trocar.waves.membrane import WaveMembrane
from trocar.waves.stack import Coupling, Sheet, Stack
from trocar.waves.tick import advance_tick, at_rest, from_wave_state, make_tick, sines, to_wave_state

DT = 1e-3
SIZE = (0.06, 0.045)
RADII = (0.004, 0.006)
EVEN = Stack(  # one sheet, undamped
    sheets=(Sheet(name="dermis", tension_x=25.7, tension_y=9.0, areal_density=1.1),),
    couplings=(Coupling(stiffness=1e5),),
)
UNEVEN = Stack(  # layers damped differently: complex and real pairs of poles
    sheets=(
        Sheet(name="epidermis", tension_x=5, tension_y=5, areal_density=0.2, bending=1e-7, damping=3.0),
        Sheet(name="dermis", tension_x=25.7, tension_y=10, areal_density=1.1, retardation_time=1e-3),
        Sheet(name="fat", tension_x=3, tension_y=3, areal_density=9.0, damping=300.0),
    ),
    couplings=(
        Coupling(stiffness=1e8, retardation_time=1e-4),
        Coupling(stiffness=1e6),
        Coupling(stiffness=3e5),
    ),
)


def skin():
    return WaveMembrane.fitted(tissue("skin"), size=SIZE, modes=(4, 4)).stack


def places(ticks=50, seed=1):
    rng = np.random.default_rng(seed)
    walk = np.cumsum(rng.normal(0, 2e-4, (ticks, 2, 2)), axis=0) + np.array([[0.02, 0.03], [0.055, 0.004]])
    return np.concatenate([np.clip(walk, 1e-4, [0.0599, 0.0449]), rng.uniform(0, 0.3, (ticks, 2, 1))], axis=2)


def load(tools):
    return tuple(
        Press(x=x, y=y, radius=radius, force=force, profile=Profile.GAUSSIAN)
        for (x, y, force), radius in zip(tools.tolist(), RADII, strict=True)
    )


def read_out(model, state, tools):
    points = np.column_stack([tools[:, :2], np.zeros(2)])
    return np.stack([model.displacement(state, points, name)[:, 2] for name in model.layer_names], axis=1)


@pytest.mark.parametrize(
    ("stack", "modes"),
    [(EVEN, (9, 13)), (UNEVEN, (70, 67)), (skin(), (24, 24))],
    ids=["even", "uneven", "skin"],
)
def test_the_tick_is_the_models_step_and_read_out(stack, modes):
    model = WaveMembrane(stack, size=SIZE, modes=modes)
    tick = make_tick(model, DT, RADII)
    state, out = at_rest(tick), np.zeros((2, len(model.layer_names)))
    history = places()
    slow, before = model.init(), load(history[0] * [1, 1, 0])
    peak = 0.0
    for tools in history:
        slow, before = model.step(slow, before, load(tools), DT), load(tools)
        advance_tick(tick, state, tools, out)
        expected = read_out(model, slow, tools)
        peak = max(peak, np.abs(expected).max())
        # 1e-12 of the deepest so far: sums of thousands of terms in another order, 50 ticks long.
        assert out == pytest.approx(expected, rel=0, abs=1e-12 * peak)
    back = to_wave_state(tick, state, slow.time, slow.load)
    anywhere = np.random.default_rng(2).uniform(0, 0.045, (20, 3))
    for name in model.layer_names:
        found, expected = (model.displacement(which, anywhere, name) for which in (back, slow))
        assert found == pytest.approx(expected, rel=0, abs=1e-12 * peak)  # rounding, as above


def test_a_tick_goes_on_from_where_the_model_stands():
    model = WaveMembrane(UNEVEN, size=SIZE, modes=(12, 12))
    first, second = places(2)
    pressed = model.static(load(first))
    tick = make_tick(model, DT, RADII)
    state, out = from_wave_state(tick, model, pressed), np.zeros((2, 3))
    advance_tick(tick, state, second, out)
    expected = read_out(model, model.step(pressed, load(first), load(second), DT), second)
    assert out == pytest.approx(expected, rel=0, abs=1e-12 * np.abs(expected).max())  # rounding, as above


def test_modes_beyond_the_cut_off_are_left_out():
    model = WaveMembrane(UNEVEN, size=SIZE, modes=(40, 40))
    cutoff = cutoff_for(RADII[0], Profile.GAUSSIAN, 1e-3)
    whole, cut = make_tick(model, DT, RADII), make_tick(model, DT, RADII, cutoff=cutoff)
    assert len(cut.kept) < len(whole.kept) // 2
    out_whole, out_cut = np.zeros((2, 3)), np.zeros((2, 3))
    states = at_rest(whole), at_rest(cut)
    for tools in places() * [1, 1, 0.1] + [0, 0, 0.1]:
        advance_tick(whole, states[0], tools, out_whole)
        advance_tick(cut, states[1], tools, out_cut)
    difference = np.abs(out_whole - out_cut).max() / np.abs(out_whole).max()
    assert 0 < difference < 1e-3  # what the cut-off promises


def test_a_released_tissue_comes_to_rest_without_subnormal_numbers():
    model = WaveMembrane(UNEVEN, size=SIZE, modes=(8, 8))
    tick = make_tick(model, DT, RADII)
    state, out = at_rest(tick), np.zeros((2, 3))
    tools = places(1)[0]
    advance_tick(tick, state, tools, out)
    tools[:, 2] = 0.0
    seen = []
    for _ in range(40_000):
        advance_tick(tick, state, tools, out)
        size = np.abs(state.blocks)
        seen.append(bool(((size > 0) & (size < 1e-300)).any()))
    assert not any(seen)
    assert not state.blocks.any()


@pytest.mark.parametrize("place", [1e-9, 1e-4, 0.013, 0.03, 0.0301, 0.0599])
def test_shapes_by_differences_are_sines(place):
    out = np.empty(128)
    sines(place, 0.06, out)
    m = np.arange(1, 129)
    near = min(place, 0.06 - place)  # the mirrored argument, so that the test's own sine is not the worse one
    expected = np.sin(m * np.pi * near / 0.06) * np.where((place > 0.03) & (m % 2 == 0), -1, 1)
    # Errors of one rounding a step, 128 steps, each amplified by at most m.
    assert out == pytest.approx(expected, rel=0, abs=2e-12 * min(1, np.abs(expected).max()))


@pytest.mark.parametrize(
    ("arguments", "key"),
    [
        ({"radii": ()}, "radii"),
        ({"radii": (0.003, -1.0)}, "radii"),
        ({"dt": 0.0}, "dt"),
        ({"cutoff": 10.0}, "cutoff"),
    ],
)
def test_an_impossible_tick_is_refused(arguments, key):
    model = WaveMembrane(EVEN, size=SIZE, modes=(3, 3))
    with pytest.raises(InputError, match=key):
        make_tick(model, **{"dt": DT, "radii": RADII, **arguments})
