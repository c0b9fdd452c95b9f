"""WaveSolid: the static series, the moving oscillators, and that the two agree."""

import itertools
from dataclasses import replace

import numpy as np
import pytest

from trocar.errors import InputError
from trocar.model import Press
from trocar.waves.membrane import WaveMembrane
from trocar.waves.solid import WaveSolid

SIZE = (0.06, 0.06)
TILTED = Press(x=0.022, y=0.031, radius=0.003, force=0.1, tilt=0.5, azimuth=0.8)
CENTRAL = Press(x=0.03, y=0.03, radius=0.003, force=0.1)


def anywhere(count=25, seed=0):
    return np.random.default_rng(seed).uniform(0.0, 0.06, (count, 3))


def small(tissue, **more):
    return WaveSolid(tissue, size=SIZE, **({"modes": (40, 40), "dynamic_modes": (12, 12)} | more))


@pytest.mark.parametrize("support", ["base", "edges"])
@pytest.mark.parametrize("dermis", [{}, {"loss_factor": 0.6}, {"prestress_x": 2.4e4, "prestress_y": 9.3e3}])
def test_a_held_load_ends_in_the_static_answer(make_skin, support, dermis):
    model = small(make_skin(**dermis), support=support)
    held = model.step(model.init(), (TILTED.with_force(0.0),), (TILTED,), 0.5)
    held = model.step(held, (TILTED,), (TILTED,), 100.0)
    still = model.static((TILTED,))
    for layer in model.layer_names:
        expected = model.displacement(still, anywhere(), layer)
        # Ritz vectors come from dense inverses: condition 1e6 to 1e8 times rounding, squared by Galerkin.
        assert model.displacement(held, anywhere(), layer) == pytest.approx(
            expected, abs=1e-8 * np.abs(expected).max()
        )


def test_stepping_from_a_static_state_goes_on_from_there(skin):
    model = small(skin)
    still = model.static((TILTED,))
    moved = model.step(still, (TILTED,), (TILTED,), 0.01)
    expected = model.displacement(still, anywhere())
    assert model.displacement(moved, anywhere()) == pytest.approx(expected, abs=1e-8 * np.abs(expected).max())


def test_one_long_step_equals_many_short_ones(skin):
    model = small(skin)
    rest = (TILTED.with_force(0.0),)
    once, often = model.step(model.init(), rest, (TILTED,), 0.05), model.init()
    for step in range(50):
        loads = [(TILTED.with_force(0.1 * s / 50),) for s in (step, step + 1)]
        often = model.step(often, *loads, 1e-3)
    expected = model.displacement(once, anywhere(), "fat")
    assert model.displacement(often, anywhere(), "fat") == pytest.approx(
        expected, abs=1e-10 * np.abs(expected).max()
    )


def test_a_square_block_does_not_know_x_from_y(skin):
    model = small(skin)
    mirrored = replace(TILTED, x=TILTED.y, y=TILTED.x, azimuth=np.pi / 2 - TILTED.azimuth)
    where = anywhere()
    one = model.displacement(model.static((TILTED,)), where, "dermis")
    other = model.displacement(model.static((mirrored,)), where[:, [1, 0, 2]], "dermis")
    assert other[:, [1, 0, 2]] == pytest.approx(one, abs=1e-12 * np.abs(one).max())


def test_work_is_reciprocal(skin):
    """Betti: what one press does under another is what the other does under the one."""
    model = WaveSolid(skin, size=SIZE, modes=(40, 40))
    one = Press(x=0.02, y=0.03, radius=1e-3, force=1.0)
    other = Press(x=0.041, y=0.025, radius=1e-3, force=1.0, tilt=1.2, azimuth=0.7)
    nodes, weights = np.polynomial.legendre.leggauss(8)
    angles = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    rings = np.repeat(0.5 * (nodes + 1), 24)
    weight = np.repeat(weights * 0.5 * (nodes + 1), 24) / 24

    def work(state, press):
        along, across = press.semi_axes
        p, q = along * rings * np.cos(np.tile(angles, 8)), across * rings * np.sin(np.tile(angles, 8))
        c, s = np.cos(press.azimuth), np.sin(press.azimuth)
        where = np.stack([press.x + p * c - q * s, press.y + p * s + q * c, 0 * p], axis=1)
        return weight @ model.displacement(state, where) @ press.force_vector

    # Eight rings of 24 integrate 40 modes over 3 mm to better than this.
    assert work(model.static((one,)), other) == pytest.approx(work(model.static((other,)), one), rel=1e-6)


def test_sides_hold_what_simple_support_holds(skin):
    model = small(skin)
    state = model.static((TILTED,))
    side = np.array([[0.0, 0.02, 0.0], [0.06, 0.05, 0.0]])
    x, y, z = model.displacement(state, side).T
    assert np.abs([y, z]).max() < 1e-18
    assert np.abs(x).min() > 0


def test_the_default_series_is_converged_under_a_5_mm_tool(skin):
    press = replace(CENTRAL, radius=0.0025)
    centre = np.array([[0.03, 0.03, 0.0]])
    coarse, fine = (WaveSolid(skin, size=SIZE, modes=(m, m)) for m in (128, 320))
    for layer in skin.layer_names:
        expected = fine.displacement(fine.static((press,)), centre, layer)[0, 2]
        # The disc's spectrum falls as k^-1.5 and the compliance as 1/k: 1e-4 is left at 128 modes.
        assert coarse.displacement(coarse.static((press,)), centre, layer)[0, 2] == pytest.approx(
            expected, rel=3e-4
        )


def test_more_ritz_vectors_and_modes_change_little(skin):
    press = replace(CENTRAL, x=0.025)

    def swing(**choice):
        model = WaveSolid(skin, size=SIZE, modes=(48, 48), **choice)
        state, depths = model.init(), []
        force = [0.1 * np.sin(np.pi * t / 20) if t < 20 else 0.0 for t in range(41)]
        for f0, f1 in itertools.pairwise(force):
            state = model.step(state, (press.with_force(f0),), (press.with_force(f1),), 1e-3)
            depths.append(model.displacement(state, np.array([[0.025, 0.03, 0.0]]))[0, 2])
        return np.array(depths)

    usual, rich = swing(), swing(dynamic_modes=(48, 48), order=6)
    # Two thirds of a per cent would already be seen in the comparison with finite elements; a tenth is not.
    assert np.sqrt(np.mean((usual - rich) ** 2)) / np.ptp(rich) < 1e-3


@pytest.mark.parametrize("support", ["base", "edges+base"])
def test_fitted_membranes_answer_tools_as_the_solid_does(skin, support):
    solid = WaveSolid(skin, size=SIZE, support=support, modes=(96, 96))
    sheets = WaveMembrane.fitted(skin, size=SIZE, support=support, modes=(96, 96))
    for diameter in (5e-3, 6e-3, 8e-3, 12e-3):
        for x, y in ((0.03, 0.03), (0.015, 0.02)):
            load = (Press(x=x, y=y, radius=diameter / 2, force=0.1),)
            where = np.array([[x, y, 0.0]])
            for layer in skin.layer_names:
                expected = solid.displacement(solid.static(load), where, layer)[0, 2]
                actual = sheets.displacement(sheets.static(load), where, layer)[0, 2]
                assert actual == pytest.approx(expected, rel=0.05)  # what the study asks of the fit


def test_fitted_membranes_keep_the_anisotropy_of_the_prestress(make_skin):
    tissue = make_skin(prestress_x=2.4e4, prestress_y=9.3e3)
    sheet = WaveMembrane.fitted(tissue, size=SIZE).stack.sheets[1]
    assert sheet.tension_x - sheet.tension_y == pytest.approx((2.4e4 - 9.3e3) * 1e-3)


def test_mistakes_are_refused(skin):
    with pytest.raises(InputError, match="modes"):
        WaveSolid(skin, size=SIZE, modes=(0, 4))
    with pytest.raises(ValueError, match="corners"):
        WaveSolid(skin, size=SIZE, support="corners")
    with pytest.raises(InputError, match="epidermis, dermis, fat"):
        small(skin).displacement(small(skin).static((CENTRAL,)), anywhere(), "muscle")
