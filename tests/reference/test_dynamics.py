"""FEASolid in time: energy, period, damping, the way to the static answer."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest
import scipy.sparse.linalg as sla

from trocar.model import Press
from trocar.reference import FEASolid, FEAState, MeshSize
from trocar.reference.parity import Parity
from trocar.tissues import Layer, Tissue

SIZE = (0.03, 0.024)
COARSE = MeshSize(per_radius=1.0, growth=1.2, top=0.6, deepening=1.2, side=0.8)
PRESS = Press(x=0.015, y=0.012, radius=3e-3, force=0.05)
EVEN = Parity(1, 1)


def solid(loss_factor: float = 0.0) -> FEASolid:
    loss = {"loss_factor": loss_factor, "loss_frequency": 50.0}
    tissue = Tissue(
        layers=(
            Layer(name="wall", thickness=1e-3, young_modulus=2e5, poisson_ratio=0.45, density=1050.0, **loss),
            Layer(name="fat", thickness=6e-3, young_modulus=1e4, poisson_ratio=0.48, density=950.0, **loss),
        )
    )
    return FEASolid(tissue, size=SIZE, support="base", around=(PRESS,), mesh=COARSE)


def energy(model: FEASolid, state: FEAState) -> float:
    """Kinetic and elastic, of the quarter [J]."""
    u, v = state.displacement[EVEN].ravel(), state.velocity[EVEN].ravel()
    return 0.5 * float(v @ (model._system.mass @ v) + u @ (model._system.stiffness @ u))


def lowest_mode(model: FEASolid) -> tuple[float, np.ndarray]:
    """Angular frequency [rad/s] and shape, by Lanczos on the same matrices."""
    system = model._system
    free = system.free(EVEN)
    matrices = (matrix[free][:, free].tocsc() for matrix in (system.stiffness, system.mass))
    stiffness, mass = matrices
    square, shapes = sla.eigsh(stiffness, k=1, M=mass, sigma=0.0)
    shape = np.zeros(system.held.size)
    shape[free] = shapes[:, 0]
    return float(np.sqrt(square[0])), shape.reshape(system.held.shape)


def test_undamped_energy_stays() -> None:
    model = solid()
    state = FEAState(time=0.0, displacement=model.static((PRESS,)).displacement, velocity={})
    state = model.step(state, (), (), 1e-3)
    first = energy(model, state)
    for _ in range(200):
        state = model.step(state, (), (), 1e-3)
    assert energy(model, state) == pytest.approx(
        first, rel=1e-9
    )  # 200 solves, each with a residual near 1e-12
    assert state.time == pytest.approx(0.201)


def test_lowest_mode_swings_with_its_period() -> None:
    """Average acceleration gives a mode the frequency (2/dt) atan(omega dt / 2), exactly."""
    model = solid()
    omega, shape = lowest_mode(model)
    dt = 2 * pi / omega / 40
    state = FEAState(time=0.0, displacement={EVEN: shape}, velocity={})
    angle = 2 * np.arctan(omega * dt / 2)
    for number in range(1, 61):
        state = model.step(state, (), (), dt)
        expected = np.cos(number * angle) * shape
        np.testing.assert_allclose(state.displacement[EVEN], expected, atol=1e-7 * np.abs(shape).max())


def test_damped_mode_decays() -> None:
    """C = tau K damps a mode by zeta = tau omega / 2; half the step, a quarter of the error."""
    model = solid(loss_factor=0.2)
    omega, shape = lowest_mode(model)
    zeta = 0.2 / (2 * pi * 50.0) * omega / 2
    swing = omega * np.sqrt(1 - zeta**2)
    period = 2 * pi / omega
    exact = np.exp(-zeta * omega * period) * (
        np.cos(swing * period) + zeta * omega / swing * np.sin(swing * period)
    )
    errors = []
    for count in (40, 80):
        state = FEAState(time=0.0, displacement={EVEN: shape}, velocity={})
        for _ in range(count):
            state = model.step(state, (), (), period / count)
        amplitude = (state.displacement[EVEN] * shape).sum() / (shape**2).sum()
        errors.append(abs(amplitude - exact))
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.1)  # the next term of the error is dt^2 smaller


def test_a_slow_ramp_ends_at_equilibrium() -> None:
    model = solid(loss_factor=0.3)
    state, steps, dt = model.init(), 20, 0.05  # 1 s: some 100 periods of the lowest mode
    for step in range(steps):
        load0, load1 = ((PRESS.with_force(PRESS.force * n / steps),) for n in (step, step + 1))
        state = model.step(state, load0, load1, dt)
    points = np.array([[0.015, 0.012, 0.0], [0.012, 0.01, 0.0]])
    expected = model.displacement(model.static((PRESS,)), points)
    # it lags by the retardation time over the ramp's length, 1e-3; wiggles of unresolved modes stay below 1 %
    np.testing.assert_allclose(
        model.displacement(state, points), expected, atol=0.01 * np.abs(expected).max()
    )


def test_a_held_load_rings_about_equilibrium() -> None:
    """The mean over many periods of an undamped response to a sudden load is the static one."""
    model = solid(loss_factor=0.1)
    state = model.init()
    for _ in range(400):
        state = model.step(state, (PRESS,), (PRESS,), 1e-3)
    points = np.array([[0.015, 0.012, 0.0]])
    expected = model.displacement(model.static((PRESS,)), points)
    # the lowest mode has lost exp(-zeta omega t) of its swing by now: below 1e-4
    np.testing.assert_allclose(
        model.displacement(state, points), expected, rtol=1e-3, atol=1e-3 * abs(expected[0, 2])
    )
    assert model.reaction(state, (PRESS,))[2] == pytest.approx(PRESS.force, rel=1e-3)


def test_steps_read_their_arguments_and_leave_them() -> None:
    model = solid()
    start = model.step(model.init(), (PRESS,), (PRESS,), 1e-3)
    before = start.displacement[EVEN].copy()
    first, second = (model.step(start, (PRESS,), (PRESS,), 1e-3) for _ in range(2))
    np.testing.assert_array_equal(first.displacement[EVEN], second.displacement[EVEN])
    np.testing.assert_array_equal(start.displacement[EVEN], before)


def test_a_steady_ramp_is_borne_by_elastic_and_viscous_reactions_together() -> None:
    """Under a force growing evenly K u + C v = f, so held nodes push back with all of it, however damped."""
    layer = Layer(
        name="pad",
        thickness=0.01,
        young_modulus=2e4,
        poisson_ratio=0.45,
        density=1000.0,
        loss_factor=0.5,
        loss_frequency=20.0,
    )
    press = Press(x=0.02, y=0.02, radius=0.006, force=1.0)
    coarse = MeshSize(per_radius=1.0, growth=1.0, top=0.6, deepening=1.0)
    model = FEASolid(Tissue(layers=(layer,)), size=(0.04, 0.04), support="base", around=(press,), mesh=coarse)
    state = model.init()
    for step in range(100):
        before, after = (press.with_force(share / 100) for share in (step, step + 1))
        state = model.step(state, (before,), (after,), 1e-3)
    # The viscous part is 4 ms of 100 ms, 4 %; what inertia is left rings below a thousandth.
    assert model.reaction(state)[2] == pytest.approx(1.0, rel=5e-3)
