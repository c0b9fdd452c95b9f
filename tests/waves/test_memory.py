"""Prony series in the waves: closed forms, one step against two, and poles that only decay."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, seed, settings
from hypothesis import strategies as st
from scipy.linalg import eigh

from trocar.errors import InputError
from trocar.model import Press
from trocar.tissues import Layer, Tissue
from trocar.waves.membrane import WaveMembrane
from trocar.waves.memory import Memory, creeping
from trocar.waves.oscillators import Oscillators
from trocar.waves.solid import WaveSolid
from trocar.waves.stack import Coupling, Sheet, Stack

SIZE = (0.05, 0.05)
ONE = np.ones((1, 1))


def one_mode(mass, damping, stiffness, series):
    """Return a single amplitude under a unit force."""
    times = np.array([time for _, time in series])
    branches = stiffness * np.array([weight for weight, _ in series]).reshape(-1, 1, 1, 1)
    matrices = (np.full((1, 1, 1), value) for value in (mass, damping, stiffness, 1.0, 1.0))
    return Oscillators.of(*matrices, Memory(times, branches))


def sudden_response(mass, damping, stiffness, weight, time, at):
    """Return the displacement under a step of force of one mode with one Maxwell branch, from its Laplace poles.

    U(s) = (1 + s tau) / (s P(s)),  P = (m s^2 + c s + k)(1 + s tau) + g k s tau: three poles by Cardano's rule, each
    polished by Newton, and partial fractions.
    """
    cubic = [
        mass * time,
        mass + damping * time,
        damping + stiffness * time * (1 + weight),
        stiffness,
    ]
    slope = np.polyder(cubic)
    poles = np.roots(np.array(cubic)).astype(complex)
    for _ in range(5):
        poles -= np.polyval(cubic, poles) / np.polyval(slope, poles)
    residues = (1 + poles * time) / (poles * np.polyval(slope, poles))
    return 1 / stiffness + (residues * np.exp(poles * at)).sum().real


@pytest.mark.parametrize(
    ("mass", "damping", "stiffness", "weight", "time"),
    [
        (0.01, 0.0, 1e4, 1.0, 0.01),  # as slow as the swing
        (0.01, 0.3, 1e4, 0.5, 1.0),
        (0.01, 0.3, 1e8, 2.0, 300.0),  # minutes beside 16 kHz
        (0.01, 400.0, 1e4, 3.0, 20.0),  # overdamped
        (1e-3, 0.1, 1e9, 0.2, 1e4),  # hours beside 160 kHz
    ],
)
def test_one_mode_follows_the_standard_linear_solid(mass, damping, stiffness, weight, time):
    mode = one_mode(mass, damping, stiffness, [(weight, time)])
    for at in (1e-5, 1e-3, 0.3 * time, 3 * time, 30 * time):
        moved = mode.read(mode.step(mode.rest, ONE, ONE, at))[0, 0]
        assert moved == pytest.approx(
            sudden_response(mass, damping, stiffness, weight, time, at), abs=1e-10 / stiffness
        )
    assert mode.read(mode.equilibrium(ONE))[0, 0] == pytest.approx(1 / stiffness, rel=1e-12)


@pytest.mark.parametrize("weight", [0.1, 1.0, 50.0])
def test_one_mode_without_mass_creeps_as_the_standard_linear_solid(weight):
    """J(t) = (1 - g/(1 + g) exp(-t/(tau (1 + g))))/k: the textbook's creep of one Maxwell branch."""
    stiffness, time = 1e4, 2.0
    branches = np.full((1, 1, 1, 1), weight * stiffness)
    mode = Oscillators.massless(
        np.full((1, 1, 1), stiffness),
        np.ones((1, 1, 1)),
        np.ones((1, 1, 1)),
        Memory(np.array([time]), branches),
    )
    for at in (1e-9, 0.1, 1.0, 20.0, 1000.0):
        state = mode.step(mode.rest, ONE, ONE, at)
        lack = mode.read(state - mode.equilibrium(ONE))[0, 0]
        expected = -weight / (1 + weight) * np.exp(-at / (time * (1 + weight))) / stiffness
        assert lack == pytest.approx(expected, abs=1e-12 / stiffness)


@pytest.mark.parametrize("damped", [0.0, 1e-5])
def test_systems_that_relax_evenly_are_standard_linear_solids_in_their_modes(damped):
    generator = np.random.default_rng(8)
    roots = generator.normal(size=(2, 5, 4, 4))
    mass, stiffness = (root @ np.swapaxes(root, 1, 2) + 0.1 * np.eye(4) for root in roots)
    stiffness *= 1e6
    weight, time = 0.8, 0.05
    memory = Memory(np.array([time]), weight * stiffness[None])
    push = generator.normal(size=(5, 4, 1))
    waves = Oscillators.of(
        mass, damped * stiffness, stiffness, push, np.broadcast_to(np.eye(4), mass.shape), memory
    )
    for at in (1e-3, 0.02, 0.4):
        moved = waves.read(waves.step(waves.rest, np.ones((5, 1)), np.ones((5, 1)), at))
        for system in range(5):
            squares, shapes = eigh(stiffness[system], mass[system])
            answers = [sudden_response(1.0, damped * k, k, weight, time, at) for k in squares]
            expected = shapes @ (answers * (shapes.T @ push[system, :, 0]))
            assert moved[system] == pytest.approx(expected, abs=1e-10 * np.abs(expected).max())


def test_a_held_amplitude_relaxes_as_the_series():
    """A ramp to 1 in no time under a force that follows k (1 + sum of g exp(-t/tau)) stays at 1."""
    stiffness, series = 1e4, [(0.7, 0.05), (1.3, 2.0)]
    mode = one_mode(1e-9, 1e-2, stiffness, series)
    state = mode.equilibrium(np.zeros((1, 1)))

    def force(t):
        return stiffness * (1 + sum(g * np.exp(-t / tau) for g, tau in series)) * ONE

    dt = 1e-4
    for i in range(3000):
        state = mode.step(state, force(i * dt), force((i + 1) * dt), dt)
    # The force is cut into straight pieces: dt^2/(12 tau^2) of it; damping takes 1e-6 s to let it in.
    assert mode.read(state)[0, 0] == pytest.approx(1.0, abs=1e-4)


def random_systems(generator, count=4, order=3, times=(0.003, 1.0, 200.0)):
    parts = [generator.normal(size=(count, order, 2)) for _ in range(order)]
    layers = [1e7 * part @ np.swapaxes(part, 1, 2) for part in parts]
    weights = generator.uniform(0, 3, (len(times), order)) * generator.integers(0, 2, (len(times), order))
    stiffness = sum(layers) + 1e5 * np.eye(order)
    root = generator.normal(size=(count, order, order))
    mass = root @ np.swapaxes(root, 1, 2) + 0.1 * np.eye(order)
    damping = 1e-4 * sum(generator.uniform(0, 2) * layer for layer in layers)
    branches = np.array([sum(w * layer for w, layer in zip(row, layers, strict=True)) for row in weights])
    return mass, damping, stiffness, Memory(np.array(times), branches)


@seed(11)
@settings(max_examples=40, deadline=None, database=None)
@given(number=st.integers(0, 2**32 - 1), undamped=st.booleans())
def test_no_pole_grows_and_two_half_steps_are_one(number, undamped):
    generator = np.random.default_rng(number)
    mass, damping, stiffness, memory = random_systems(generator)
    push = generator.normal(size=(4, 3, 1))
    reading = np.broadcast_to(np.eye(3), mass.shape)
    waves = Oscillators.of(mass, 0 * damping if undamped else damping, stiffness, push, reading, memory)
    poles = np.linalg.eigvals(waves.matrices)
    # Rounding of an undamped pole of size |s|; a mode that no branch touches may stand on the axis.
    assert (poles.real <= 1e-12 * np.abs(poles).max()).all()
    start, end = generator.normal(size=(2, 4, 1))
    once = waves.step(waves.step(waves.rest, start, end, 0.01), end, start, 0.02)
    half = waves.step(waves.step(waves.rest, start, end, 0.01), end, 0.5 * (start + end), 0.01)
    twice = waves.step(half, 0.5 * (start + end), start, 0.01)
    size = np.abs(waves.read(once)).max()
    assert np.abs(waves.read(once) - waves.read(twice)).max() < 1e-12 * size


@seed(12)
@settings(max_examples=40, deadline=None, database=None)
@given(number=st.integers(0, 2**32 - 1))
def test_creep_only_decays_and_lies_between_the_series_bounds(number):
    """Every retardation time is between the shortest relaxation time and (1 + g) times the longest."""
    _, _, stiffness, memory = random_systems(np.random.default_rng(number))
    if not memory.stiffness.any():
        return
    rates, _, _ = creeping(stiffness, memory)
    assert (rates > 0).all()
    assert rates.max() <= (1 + 1e-12) / memory.times.min()


@seed(13)
@settings(max_examples=25, deadline=None, database=None)
@given(number=st.integers(0, 2**32 - 1))
def test_at_every_frequency_the_tissue_takes_work_and_gives_none(number):
    """Passive: where it is pushed, what it yields to a swinging force lags behind it, Im J(i omega) <= 0."""
    generator = np.random.default_rng(number)
    mass, damping, stiffness, memory = random_systems(generator)
    push = generator.normal(size=(4, 3, 1))
    waves = Oscillators.of(mass, damping, stiffness, push, np.swapaxes(push, 1, 2), memory)
    for omega in np.geomspace(1e-4, 1e6, 60):
        resolved = np.linalg.solve(1j * omega * np.eye(2) - waves.matrices, waves.inputs.astype(complex))
        yields = np.einsum("jksi,jsin->jkn", waves.outputs, resolved)[:, 0, 0]
        static = np.einsum("jksi,jsin->jkn", waves.outputs, waves.holds)[:, 0, 0]
        assert (yields.imag <= 1e-9 * static).all()


def layers(**fat):
    base = {"poisson_ratio": 0.48, "density": 1000.0, "loss_factor": 0.1}
    return Tissue(
        layers=(
            Layer(name="dermis", thickness=1e-3, young_modulus=2e5, prony=((0.8, 0.01), (0.3, 5.0)), **base),
            Layer(name="fat", thickness=8e-3, young_modulus=1e4, **(base | {"prony": ((1.5, 0.5),)} | fat)),
        )
    )


def load(force):
    return (Press(x=0.02, y=0.03, radius=0.004, force=force, tilt=0.3, azimuth=0.4),)


WHERE = np.array([[0.02, 0.03, 0.0], [0.03, 0.028, 0.0]])


def solid(massless):
    return WaveSolid(layers(), size=SIZE, modes=(20, 20), dynamic_modes=(8, 8), massless=massless)


def membrane(massless):
    return WaveMembrane.fitted(layers(), size=SIZE, modes=(12, 12), massless=massless)


@pytest.mark.parametrize("build", [solid, membrane])
@pytest.mark.parametrize("massless", [True, False])
def test_two_half_steps_of_a_tissue_equal_one(build, massless):
    model = build(massless)
    once = model.step(model.static(load(0.1)), load(0.1), load(0.4), 0.08)
    half = model.step(model.static(load(0.1)), load(0.1), load(0.25), 0.04)
    twice = model.step(half, load(0.25), load(0.4), 0.04)
    for layer in model.layer_names:
        one, other = (model.displacement(state, WHERE, layer) for state in (once, twice))
        assert np.abs(one - other).max() < 1e-12 * np.abs(one).max()


@pytest.mark.parametrize("build", [solid, membrane])
@pytest.mark.parametrize("massless", [True, False])
def test_after_long_the_tissue_stands_where_its_long_term_moduli_hold_it(build, massless):
    model = build(massless)
    state = model.step(model.init(), load(0.2), load(0.2), 1e4)
    held = model.displacement(model.static(load(0.2)), WHERE)
    assert model.displacement(state, WHERE) == pytest.approx(held, abs=1e-8 * np.abs(held).max())
    stays = model.step(model.static(load(0.2)), load(0.2), load(0.2), 0.3)
    assert model.displacement(stays, WHERE) == pytest.approx(held, abs=1e-8 * np.abs(held).max())


def test_at_once_the_solid_answers_with_its_instantaneous_moduli():
    stiff = Tissue(
        layers=tuple(
            Layer(
                name=layer.name,
                thickness=layer.thickness,
                young_modulus=layer.instantaneous_modulus,
                poisson_ratio=layer.poisson_ratio,
                density=layer.density,
            )
            for layer in layers().layers
        )
    )
    model, sudden = solid(True), WaveSolid(stiff, size=SIZE, modes=(20, 20))
    state = model.step(model.init(), load(0.2), load(0.2), 1e-12)
    expected = sudden.displacement(sudden.static(load(0.2)), WHERE)
    assert model.displacement(state, WHERE) == pytest.approx(expected, abs=1e-8 * np.abs(expected).max())


def test_a_series_without_weight_changes_nothing_but_rounding():
    plain = WaveSolid(layers(prony=()), size=SIZE, modes=(16, 16), dynamic_modes=(8, 8))
    idle = WaveSolid(layers(prony=((0.0, 3.0),)), size=SIZE, modes=(16, 16), dynamic_modes=(8, 8))
    one, other = (m.displacement(m.step(m.init(), load(0.0), load(0.1), 0.05), WHERE) for m in (plain, idle))
    assert (one == other).all()


def test_a_year_beside_microseconds_is_split_too():
    """Retardation of 1 year beside 10 MHz: half of fifteen digits are left, and no pole grows."""
    series = ((25.0, 0.18), (18.0, 380.0), (390.0, 9e4)), ((370.0, 0.18),)
    two = layers().layers
    tissue = Tissue(
        layers=tuple(replace(a, prony=b, loss_factor=0.0) for a, b in zip(two, series, strict=True))
    )
    model = WaveMembrane.derived(tissue, size=SIZE, modes=(16, 16))
    poles = np.linalg.eigvals(model.oscillators.matrices)
    assert (poles.real < 0).all()
    state = model.step(model.static(load(0.1)), load(0.1), load(0.1), 1.0)
    held = model.displacement(model.static(load(0.1)), WHERE)
    assert model.displacement(state, WHERE) == pytest.approx(held, abs=1e-7 * np.abs(held).max())


def test_clamped_sides_with_a_series_are_refused():
    with pytest.raises(InputError, match="clamped, which WaveSolid cannot yet take"):
        WaveSolid(layers(), size=SIZE, support="edges+base")


def test_one_sheet_on_a_bed_is_the_standard_linear_solid():
    prony = ((0.6, 0.02),)
    stack = Stack(
        sheets=(Sheet(name="skin", tension_x=2.0, tension_y=2.0, areal_density=1.0, prony=prony),),
        couplings=(Coupling(stiffness=1e5, prony=prony),),
    )
    model = WaveMembrane(stack, size=SIZE, modes=(4, 4))
    press = load(0.1)
    mass, stiffness = (matrix[:, 0, 0] for matrix in model.matrices_of_motion)
    forces = model.modal_forces(press) * 4 / (SIZE[0] * SIZE[1])
    for at in (1e-4, 3e-3, 0.05, 1.0):
        state = model.step(model.init(), press, press, at)
        expected = [
            f * sudden_response(m, 0.0, k, *prony[0], at)
            for f, m, k in zip(forces, mass, stiffness, strict=True)
        ]
        found = model.amplitudes(state)[1:, 1:].ravel()
        assert found == pytest.approx(np.array(expected), abs=1e-10 * np.abs(forces / stiffness).max())
