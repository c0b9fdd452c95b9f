"""The mesh-free model in time: explicit against implicit and finite elements, stability, damping."""

from dataclasses import replace

import numpy as np
import pytest

from trocar.errors import InputError
from trocar.model import Press
from trocar.reference import FEASolid
from trocar.reference.block import MeshSize
from trocar.reference.mesh_free import MeshFree, MeshFreeState
from trocar.reference.mesh_free.explicit import advance
from trocar.tissues import Layer, NeoHookean, Tissue

SIZE = (0.03, 0.03)
PRESS = Press(x=0.015, y=0.015, radius=4e-3, force=0.02)
UNDER = np.array([[0.015, 0.015, 0.0]])


def pad(loss_factor=0.0, law=None):
    layer = Layer(
        name="pad",
        thickness=0.01,
        young_modulus=1e4,
        poisson_ratio=0.45,
        density=1000.0,
        loss_factor=loss_factor,
        loss_frequency=50.0,
    )
    return Tissue(layers=(replace(layer, law=law) if law else layer,))


def model(tissue, **options):
    return MeshFree(tissue, size=SIZE, support="base", around=(PRESS,), **({"mirrored": True} | options))


def tapped(solid, dt=1e-3, count=20):
    """Deflection under a force that rises in 2 ms and is then held [m]."""
    state, found = solid.init(), []
    for number in range(count):
        load0, load1 = (
            (PRESS.with_force(PRESS.force * min(t / 2e-3, 1.0)),) for t in (number * dt, (number + 1) * dt)
        )
        state = solid.step(state, load0, load1, dt)
        found.append(solid.displacement(state, UNDER)[0, 2])
    return np.array(found)


def energy(solid, state):
    body = solid._body
    u, v = state.displacement.ravel(), state.velocity
    return 0.5 * float(u @ (body.stiffness @ u) + (body.mass[:, None] * v**2).sum())


def test_explicit_and_implicit_time_agree():
    explicit = tapped(model(pad(0.2)))
    implicit = tapped(model(pad(0.2), stepping="implicit"), dt=1e-4, count=200)[9::10]
    np.testing.assert_allclose(
        explicit, implicit, atol=0.01 * np.abs(implicit).max()
    )  # implicit: dt^2 of fast modes


def test_a_tap_is_that_of_finite_elements():
    fea = FEASolid(
        pad(0.2),
        size=SIZE,
        support="base",
        around=(PRESS,),
        mesh=MeshSize(per_radius=2.0, growth=0.6, top=0.4, deepening=0.7),
    )
    expected = tapped(fea, dt=2.5e-4, count=80)[3::4]
    found = tapped(model(pad(0.2), resolution=1.5))
    np.testing.assert_allclose(found, expected, atol=0.03 * np.abs(expected).max())  # its statics miss by 1 %


def test_no_step_within_the_critical_one_gains_energy_and_beyond_it_the_stiffest_mode_runs_away():
    solid = model(pad())
    body, critical = solid._body, solid.critical_step
    rest = np.zeros_like(solid.nodes)
    kicked = (rest, body.spread(np.random.default_rng(0).standard_normal(len(body.free))))
    begun = energy(solid, MeshFreeState(time=0.0, displacement=kicked[0], velocity=kicked[1]))
    ended = {}
    for longest in (critical, 1.1 * critical):
        displacement, velocity = advance(body, longest, kicked, (rest, rest), 300 * 0.98 * longest)
        ended[longest] = energy(solid, MeshFreeState(time=0.0, displacement=displacement, velocity=velocity))
    assert ended[critical] < 3 * begun  # central differences keep another energy, which bounds it
    assert ended[1.1 * critical] > 1e6 * begun


def test_damping_shortens_the_critical_step_by_the_stiffest_mode_s_share():
    """h omega/2 = sqrt(1 + zeta^2) - zeta with zeta = tau omega/2, of one material the exact limit."""
    undamped = model(pad()).critical_step
    omega = 2 / undamped
    zeta = 0.2 / (2 * np.pi * 50.0) * omega / 2
    damped = model(pad(0.2)).critical_step
    assert damped == pytest.approx(
        undamped * (np.sqrt(1 + zeta**2) - zeta), rel=1e-2
    )  # two Lanczos estimates


def test_halving_the_step_quarters_the_error():
    """Let go from a smooth field: what a force as even as the equilibrium under the tool would hold."""
    solid = model(pad())
    body, critical, rest = solid._body, solid.critical_step, np.zeros_like(solid.nodes)
    weight = (body.mass[:, None] * solid.static((PRESS,)).displacement).ravel()
    start = body.spread(body.factors.solve(weight[body.free]))

    def reached(share):
        return advance(body, share * critical, (start, rest), (rest, rest), 5e-3)[0]

    finest = reached(1 / 16)
    coarse, fine = (np.abs(reached(share) - finest).max() for share in (1 / 2, 1 / 4))
    assert coarse / fine == pytest.approx(4.2, rel=0.1)  # (1/4 - 1/256) / (1/16 - 1/256) = 4.2


def test_neo_hookean_layers_at_small_strain_move_as_linear_ones():
    linear, large = (model(pad(0.2, law)) for law in (None, NeoHookean()))
    rest, force = np.zeros_like(linear.nodes), 1e-3 * linear._forces((PRESS,))
    step = linear.critical_step * np.array([0.6, 0.98])  # what each multiplies by the other's safety
    ends = [
        advance(solid._body, longest, (rest, rest), (rest, force), 5e-3)[0]
        for solid, longest in zip((linear, large), step, strict=True)
    ]
    np.testing.assert_allclose(
        ends[1], ends[0], atol=1e-3 * np.abs(ends[0]).max()
    )  # strains of the order of 1e-4


def test_massless_steps_are_equilibria():
    solid = model(pad(), massless=True)
    state = solid.step(solid.init(), (PRESS,), (PRESS,), 1e-3)
    assert (state.displacement == solid.static((PRESS,)).displacement).all()
    assert solid.longest_step == np.inf


@pytest.mark.parametrize(
    ("options", "word"),
    [
        ({"stepping": "leaps"}, "explicit, implicit"),
        ({"resolution": 0.1}, "resolution"),
        ({"resolution": float("nan")}, "resolution"),
        ({"tissue": pad(law=NeoHookean()), "stepping": "implicit"}, "explicit time"),
        ({"size": (0.03,)}, "two finite sides"),
        ({"support": "air"}, "support"),
    ],
)
def test_an_impossible_model_is_refused(options, word):
    with pytest.raises(InputError, match=word):
        MeshFree(**({"tissue": pad(), "size": SIZE, "support": "base"} | options))
