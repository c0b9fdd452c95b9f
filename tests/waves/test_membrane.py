"""Coupled membranes against closed forms, and the exactness the design claims."""

import numpy as np
import pytest

from trocar.errors import InputError
from trocar.model import Press, Profile
from trocar.waves import membrane
from trocar.waves.membrane import WaveMembrane
from trocar.waves.propagator import Propagator
from trocar.waves.stack import Coupling, Sheet, Stack

A = 0.06
SIZE = (A, A)
DRUM = Stack(
    sheets=(Sheet(name="dermis", tension_x=25.7, tension_y=25.7, areal_density=1.1),),
    couplings=(Coupling(stiffness=0.0),),
)


def three_layers(**damping):
    return Stack(
        sheets=(
            Sheet(name="epidermis", tension_x=5.0, tension_y=5.0, areal_density=0.2, bending=1e-7, **damping),
            Sheet(name="dermis", tension_x=25.7, tension_y=10.0, areal_density=1.1, bending=1e-5),
            Sheet(name="fat", tension_x=3.0, tension_y=3.0, areal_density=9.0, **damping),
        ),
        couplings=(Coupling(stiffness=1e8), Coupling(stiffness=1e6), Coupling(stiffness=3e5)),
    )


def mode_shape(m, n):
    return lambda x, y: 1e-3 * np.sin(m * np.pi * x / A) * np.sin(n * np.pi * y / A)


def points(count=20, seed=0):
    return np.random.default_rng(seed).uniform(0, A, (count, 3))


def ramped(force):
    return (Press(x=0.02, y=0.03, radius=0.003, force=force),)


@pytest.mark.parametrize("time", [1e-4, 0.0137, 0.1, 3.0])
def test_a_single_mode_swings_as_a_cosine(time):
    model = WaveMembrane(DRUM, size=SIZE, modes=(8, 8))
    start = model.released(displacement={"dermis": mode_shape(2, 3)}, velocity={"dermis": mode_shape(2, 3)})
    moved = model.step(start, (), (), time)
    omega = np.sqrt(25.7 / 1.1 * (4 + 9)) * np.pi / A  # Kreyszig's lambda_mn
    where = points()
    shape = mode_shape(2, 3)(where[:, 0], where[:, 1])
    expected = shape * (np.cos(omega * time) + np.sin(omega * time) / omega)
    # 1e-10 relative to the mode's own size.
    assert model.displacement(moved, where)[:, 2] == pytest.approx(expected, abs=1e-10 * 1e-3)


def test_an_orthotropic_sheet_with_bending_damping_and_foundation_has_the_textbook_frequency():
    sheet = Sheet(name="s", tension_x=30.0, tension_y=10.0, areal_density=1.3, bending=2e-4, damping=50.0)
    model = WaveMembrane(
        Stack(sheets=(sheet,), couplings=(Coupling(stiffness=4e5),)), size=(0.06, 0.04), modes=(4, 4)
    )
    kx, ky, t = 2 * np.pi / 0.06, 1 * np.pi / 0.04, 0.02
    square = (2e-4 * (kx**2 + ky**2) ** 2 + 30.0 * kx**2 + 10.0 * ky**2 + 4e5) / 1.3
    sigma = 50.0 / 1.3 / 2
    omega = np.sqrt(square - sigma**2)
    start = model.released(displacement={"s": lambda x, y: np.sin(kx * x) * np.sin(ky * y)})
    moved = model.amplitudes(model.step(start, (), (), t))[2, 1]
    expected = np.exp(-sigma * t) * (np.cos(omega * t) + sigma / omega * np.sin(omega * t))
    assert moved == pytest.approx(expected, rel=1e-10)


def test_a_random_shape_follows_kreyszigs_series():
    model = WaveMembrane(DRUM, size=SIZE, modes=(12, 12))
    table = np.random.default_rng(3).normal(size=(13, 13)) * 1e-4
    m, n = np.meshgrid(np.arange(13), np.arange(13), indexing="ij")

    def shape(x, y):
        rows, columns = np.sin(np.pi / A * np.arange(13) * x), np.sin(np.pi / A * np.arange(13)[:, None] * y)
        return rows @ table @ columns

    moved = model.step(model.released(displacement={"dermis": shape}), (), (), 0.05)
    omega = np.sqrt(25.7 / 1.1 * (m**2 + n**2)) * np.pi / A
    expected = (table * np.cos(omega * 0.05))[1:, 1:]
    assert model.amplitudes(moved)[1:, 1:] == pytest.approx(expected, abs=1e-10 * np.abs(table).max())


@pytest.mark.parametrize("damping", [{}, {"damping": 300.0}, {"retardation_time": 0.05}])
def test_one_step_of_100_ms_equals_100_of_1_ms(damping):
    model = WaveMembrane(three_layers(**damping), size=SIZE, modes=(16, 16))
    start = model.released(displacement={"dermis": mode_shape(1, 2), "fat": mode_shape(3, 3)})
    once, often = model.step(start, (), (), 0.1), start
    for _ in range(100):
        often = model.step(often, (), (), 1e-3)
    # 1e-10 of the release's 1 mm.
    assert often.time == pytest.approx(once.time)
    for layer in model.layer_names:
        assert model.amplitudes(often, layer) == pytest.approx(
            model.amplitudes(once, layer), abs=1e-10 * 1e-3
        )


def test_a_ramp_of_1_s_in_one_step_equals_1000_steps():
    model = WaveMembrane(three_layers(damping=200.0), size=SIZE, modes=(16, 16))
    once, often = model.step(model.init(), ramped(0.0), ramped(0.5), 1.0), model.init()
    for step in range(1000):
        often = model.step(often, ramped(0.5 * step / 1000), ramped(0.5 * (step + 1) / 1000), 1e-3)
    scale = np.abs(model.amplitudes(once)).max()
    assert model.amplitudes(often) == pytest.approx(model.amplitudes(once), abs=1e-10 * scale)


def drift(model, start, steps):
    """Return relative changes of the energy: the largest of a mode, and of all."""
    before, state = model.modal_energy(start), start
    for _ in range(steps):
        state = model.step(state, (), (), 1e-3)
    after = model.modal_energy(state)
    return np.abs(after / before - 1).max(), abs(after.sum() / before.sum() - 1)


def comparable_modes():
    """A drum with 100 modes of equal energy."""
    model = WaveMembrane(DRUM, size=SIZE, modes=(10, 10))
    swings = np.random.default_rng(1).normal(size=(100, 1, 2))
    swings /= np.linalg.norm(swings, axis=2, keepdims=True)
    return model, membrane.WaveState(0.0, (swings,))


def test_undamped_energy_is_kept_over_1e5_steps():
    per_mode, total = drift(*comparable_modes(), 100_000)
    # A coefficient rounded to 1e-16 drifts by up to 2e-11 in 1e5 steps; among 100 modes most of it cancels.
    assert per_mode < 1e-10
    assert total < 1e-11


@pytest.mark.parametrize("entry", [(0, 0), (0, 1), (1, 0), (1, 1)])
def test_the_energy_check_notices_a_coefficient_that_is_off_by_1e_8(entry):
    model, start = comparable_modes()
    step = model.oscillators.propagator(1e-3)
    wrong = step.transition.copy()
    wrong[37, 0, entry[0], entry[1]] *= 1 + 1e-8
    model.oscillators._propagators[1e-3] = Propagator(wrong, step.start_gain, step.end_gain)
    per_mode, total = drift(model, start, 100_000)
    assert per_mode > 1e-10
    assert total > 1e-11


def test_three_coupled_layers_keep_their_energy_too():
    model = WaveMembrane(three_layers(), size=SIZE, modes=(6, 6))
    start = model.released(displacement={name: mode_shape(2, 3) for name in model.layer_names})
    state = start
    for _ in range(1000):
        state = model.step(state, (), (), 1e-3)
    # Modes of very different stiffness share the sum; each rounds at 1e-16 a step.
    assert model.modal_energy(state)[1, 2] == pytest.approx(model.modal_energy(start)[1, 2], rel=1e-11)


def test_damping_only_takes_energy():
    model = WaveMembrane(three_layers(damping=300.0, retardation_time=1e-3), size=SIZE, modes=(6, 6))
    state = model.released(displacement={"dermis": mode_shape(2, 3)})
    energies = []
    for _ in range(200):
        state = model.step(state, (), (), 1e-3)
        energies.append(model.modal_energy(state).sum())
    assert (np.diff(energies) <= 0).all()


def test_static_is_where_a_held_load_ends():
    model = WaveMembrane(three_layers(damping=2000.0, retardation_time=1e-3), size=SIZE, modes=(20, 20))
    held = model.step(model.step(model.init(), ramped(0.0), ramped(0.4), 0.1), ramped(0.4), ramped(0.4), 60.0)
    rest = model.static(ramped(0.4))
    assert model.amplitudes(held, "fat") == pytest.approx(model.amplitudes(rest, "fat"), rel=1e-9, abs=1e-15)


def test_a_drum_under_a_small_disc_matches_the_logarithmic_closed_form():
    model = WaveMembrane(DRUM, size=SIZE, modes=(300, 300))
    disc = (Press(x=A / 2, y=A / 2, radius=0.003, force=1.0),)
    bent = model.displacement(model.static(disc), np.array([[A / 2, A / 2, 0], [A / 2 + 0.003, A / 2, 0]]))
    # Inside a uniformly loaded disc u falls by F/(4 pi T) from its centre to its rim, wherever the edge is.
    assert bent[0, 2] - bent[1, 2] == pytest.approx(
        -1.0 / (4 * np.pi * 25.7), rel=5e-3
    )  # 300 modes; square edge


def test_a_press_moves_what_it_touches_and_linearly():
    model = WaveMembrane(three_layers(), size=SIZE, modes=(24, 24))
    where = points()
    small, large = (model.displacement(model.static(ramped(f)), where) for f in (0.1, 0.7))
    assert large == pytest.approx(7 * small)
    assert model.displacement(model.static(ramped(0.1)), np.array([[0.02, 0.03, 0.0]]))[0, 2] < 0


def test_two_presses_add_up():
    model = WaveMembrane(three_layers(), size=SIZE, modes=(24, 24))
    one = Press(x=0.02, y=0.03, radius=0.003, force=0.1)
    two = Press(x=0.04, y=0.03, radius=0.004, force=0.2, profile=Profile.SPHERE, tilt=0.4, azimuth=1.0)
    where = points()
    apart = sum(model.displacement(model.static((press,)), where, "fat") for press in (one, two))
    assert model.displacement(model.static((one, two)), where, "fat") == pytest.approx(apart)


def test_unknown_layers_and_impossible_steps_are_refused():
    model = WaveMembrane(DRUM, size=SIZE, modes=(4, 4))
    with pytest.raises(InputError, match="dermis"):
        model.released(displacement={"fat": mode_shape(1, 1)})
    with pytest.raises(InputError, match="dermis"):
        model.displacement(model.init(), points(), "fat")
    for dt in (0.0, -1.0, float("nan"), float("inf")):
        with pytest.raises(InputError, match="dt"):
            model.step(model.init(), (), (), dt)
    with pytest.raises(InputError, match="load1"):
        model.step(model.init(), ramped(1.0), (), 1e-3)


@pytest.mark.parametrize(
    ("change", "word"),
    [
        ({"areal_density": 0.0}, "areal_density"),
        ({"tension_x": -1.0}, "tension_x"),
        ({"bending": float("nan")}, "bend"),
    ],
)
def test_impossible_sheets_are_refused(change, word):
    sheet = {"name": "s", "tension_x": 1.0, "tension_y": 1.0, "areal_density": 1.0}
    with pytest.raises(InputError, match=word):
        Sheet(**(sheet | change))
