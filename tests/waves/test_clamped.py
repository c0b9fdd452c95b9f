"""Clamped sides: that they hold, that what holds them is elastic, and that a few modes resolve it."""

from dataclasses import replace

import numpy as np
import pytest

from trocar.errors import InputError
from trocar.model import Press
from trocar.tissues import Layer, Tissue
from trocar.waves.clamped import ClampedSides
from trocar.waves.held_tool import hold
from trocar.waves.series import Series
from trocar.waves.solid import WaveSolid
from trocar.waves.thin_layer import horizontal_shear, vertical_and_along

SIZE = (0.06, 0.06)
OBLONG = (0.05, 0.07)
CENTRAL = Press(x=0.03, y=0.03, radius=0.003, force=0.1)
TILTED = Press(x=0.018, y=0.031, radius=0.003, force=0.1, tilt=0.5, azimuth=0.8)


def solid(tissue, support="edges", modes=48, side_modes=32, size=SIZE):
    return WaveSolid(
        tissue, size=size, support=support, modes=(modes, modes), side_modes=(side_modes, side_modes)
    )


def depths(model, press=CENTRAL):
    where, state = np.array([[press.x, press.y, 0.0]]), model.static((press,))
    return np.array([-model.displacement(state, where, layer)[0, 2] for layer in model.layer_names])


@pytest.mark.parametrize("support", ["edges", "edges+base"])
@pytest.mark.parametrize("press", [CENTRAL, TILTED])
@pytest.mark.parametrize("size", [SIZE, OBLONG])
def test_clamped_sides_hold_still(skin, support, press, size):
    a, b = size
    share = np.linspace(0.1, 0.9, 41)
    across_x = np.stack([np.tile([0.0, a], 41), np.repeat(b * share, 2), np.zeros(82)], axis=1)
    across_y = np.stack([np.repeat(a * share, 2), np.tile([0.0, b], 41), np.zeros(82)], axis=1)

    def slides(support):
        model = solid(skin, support, size=size, side_modes=48)
        state = model.static((press,))
        faces = [
            (
                model.displacement(state, across_x, layer)[:, 0],
                model.displacement(state, across_y, layer)[:, 1],
            )
            for layer in model.layer_names
        ]
        return np.array(faces)

    free, held = slides("base"), slides(support)
    # What is left the waves beyond m = 48 would take back; with a free base more would slide than on a held one.
    assert np.abs(held).max() < 0.1 * np.abs(free).max()
    assert np.sqrt(np.mean(held**2)) < 0.06 * np.sqrt(np.mean(free**2))


def test_a_clamped_plate_sinks_as_in_the_handbook():
    """Timoshenko and Woinowsky-Krieger 1959, table 37: 0.00560 P a^2/D under a force at a point."""
    thickness, radius, side = 0.5e-3, 2e-3, 0.06
    layer = Layer(name="plate", thickness=thickness, young_modulus=1e6, poisson_ratio=0.3, density=1e3)
    rigidity = layer.young_modulus * thickness**3 / (12 * (1 - layer.poisson_ratio**2))
    model = solid(Tissue(layers=(layer,)), modes=96)
    (depth,) = depths(model, replace(CENTRAL, radius=radius, force=1.0))
    # Spread over a disc it is less by c^2 (3/4 + ln R/c)/(16 pi), here of a round plate as wide.
    spread = (radius / side) ** 2 * (0.75 + np.log(0.5 * side / radius)) / (16 * np.pi)
    # The table has three digits; shear adds a thousandth.
    assert depth * rigidity / side**2 == pytest.approx(0.00560 - spread, rel=0.005)


@pytest.mark.parametrize("support", ["edges", "edges+base"])
def test_the_default_resolution_of_the_sides_is_enough(skin, support):
    for press in (CENTRAL, replace(CENTRAL, x=0.012, y=0.017)):
        coarse, fine = (depths(solid(skin, support, 96, side), press) for side in (48, 80))
        assert coarse == pytest.approx(fine, rel=0.003)


def test_the_waves_beyond_the_last_are_counted(skin):
    """Without the integral the same number of modes is further off."""
    fine = depths(solid(skin, side_modes=48, modes=64))
    coarse = depths(solid(skin, side_modes=12, modes=64))
    assert coarse == pytest.approx(fine, rel=0.02)
    assert np.abs(coarse / fine - 1).max() > 1e-4  # they are not one and the same


def test_clamps_only_stiffen_and_most_where_the_sides_bear_all(skin):
    held, bonded = (depths(solid(skin, support)) for support in ("edges", "edges+base"))
    loose = depths(solid(skin, "base"))
    assert (bonded < loose).all()
    assert (bonded > 0.9 * loose).all()
    assert (held > loose).all()


def test_work_is_reciprocal_between_clamped_sides(skin):
    model = solid(skin, side_modes=24, size=OBLONG)
    one, other = (Press(x=x, y=y, radius=1e-9, force=1.0) for x, y in ((0.011, 0.03), (0.027, 0.052)))
    places = np.array([[one.x, one.y, 0.0], [other.x, other.y, 0.0]])
    under_one, under_other = (
        model.displacement(model.static((press,)), places)[:, 2] for press in (one, other)
    )
    # A tool of no width feels what its own point does: Betti's theorem holds to rounding, clamps included.
    assert under_one[1] == pytest.approx(under_other[0], rel=1e-9)


def test_a_clamped_block_does_not_know_x_from_y(skin):
    where = np.random.default_rng(0).uniform(0.0, 0.05, (25, 3))
    mirrored = replace(TILTED, x=TILTED.y, y=TILTED.x, azimuth=np.pi / 2 - TILTED.azimuth)
    one, other = solid(skin, size=OBLONG), solid(skin, size=OBLONG[::-1])
    found = one.displacement(one.static((TILTED,)), where, "dermis")
    turned = other.displacement(other.static((mirrored,)), where[:, [1, 0, 2]], "dermis")
    assert turned[:, [1, 0, 2]] == pytest.approx(found, abs=1e-9 * np.abs(found).max())


@pytest.mark.parametrize("size", [SIZE, OBLONG])
def test_what_clamps_add_is_linear_and_needs_no_higher_waves(skin, size):
    layers = vertical_and_along(skin, base_held=True), horizontal_shear(skin, base_held=True)
    series = Series(size, (13, 12))
    sides = ClampedSides(*layers, series)
    rng = np.random.default_rng(1)
    v, s = rng.normal(size=(2, *series.shape, layers[1].size))
    v[0], v[:, 0], s[0, 0] = 0.0, 0.0, 0.0
    once, thrice = sides.under_slide(v, s), sides.under_slide(3 * v, 3 * s)
    assert np.abs(once).max() > 0
    assert thrice == pytest.approx(3 * once, abs=1e-12 * np.abs(once).max())
    narrow = sides.under_slide(v[:5, :6], s[:5, :6])
    v[5:], v[:, 6:], s[5:], s[:, 6:] = 0.0, 0.0, 0.0, 0.0
    assert sides.under_slide(v, s) == pytest.approx(narrow, abs=1e-12 * np.abs(once).max())


def test_tractions_on_the_sides_count_as_unknowns(skin):
    model = solid(skin, "edges+base", modes=16, side_modes=12)
    loose = solid(skin, "base", modes=16)
    depths(model), depths(loose)
    nodes = horizontal_shear(skin, base_held=True).size
    assert model.dofs == loose.dofs + 2 * 6 * nodes  # m = 1, 3 ... 11 on either pair of sides


def test_a_held_tool_needs_sides_without_clamps(skin):
    with pytest.raises(InputError, match="support"):
        hold(solid(skin, modes=8, side_modes=8), CENTRAL, 1e-3)
