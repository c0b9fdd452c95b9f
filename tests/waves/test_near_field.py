"""The near field against the half space, against the whole series, and as an energy."""

import numpy as np
import pytest
from scipy.special import i0e

from trocar.errors import InputError
from trocar.model import Press, Profile
from trocar.tissues import Layer
from trocar.waves.banded import surface_compliance
from trocar.waves.membrane import WaveMembrane
from trocar.waves.near_field import half_space, near_field
from trocar.waves.solid import WaveSolid
from trocar.waves.thin_layer import Wavenumbers, vertical_and_along

SIZE = (0.06, 0.06)
PAD, WINDOW = 0.4e-3, 2e-3
MODULUS = 1e5  # plane strain, E/(1 - nu^2) [Pa]
JELLY = Layer(
    name="jelly", thickness=1.0, young_modulus=MODULUS * (1 - 0.3**2), poisson_ratio=0.3, density=1000
)


def of_layers(tissue):
    layers = vertical_and_along(tissue, base_held=True)
    return lambda k: surface_compliance(layers, Wavenumbers(k, k**2, 0 * k))[:, :, 0, 0]


def test_on_a_half_space_it_is_the_difference_of_two_gaussians_of_load():
    """Under a pressure exp(-r^2/(2 s^2))/(2 pi s^2) a half space sinks by I0e(q)/(E* s) sqrt(2/pi)/2, q = r^2/4s^2."""
    found = near_field(half_space(JELLY), pad=PAD, window=WINDOW, reach=6e-3)
    radii = np.linspace(0, 6e-3, 50)

    def sinks(width):
        return i0e(radii**2 / (4 * width**2)) / (MODULUS * width * np.sqrt(2 * np.pi))

    expected = sinks(PAD) - sinks(WINDOW)
    # Linear interpolation between rows a fortieth of the pad apart.
    assert found.at(radii)[:, 0] == pytest.approx(expected, abs=2e-4 * expected[0])


@pytest.mark.parametrize("layer", [0, 1, 2])
def test_with_the_window_it_is_the_whole_static_response(skin, layer):
    """A pad far from the sides: window's waves by the series, the rest by the near field, both by one long series."""
    model = WaveSolid(skin, size=SIZE, modes=(320, 320))
    radius = 2 * PAD  # a Gaussian press reaches two standard deviations
    pad, smooth = (
        Press(x=0.03, y=0.03, radius=r, force=1.0, profile=Profile.GAUSSIAN) for r in (radius, 2 * WINDOW)
    )
    where = np.array([[0.03 + r, 0.03, 0.0] for r in (0.0, 0.5e-3, 1e-3, 2e-3, 4e-3)])
    name = skin.layer_names[layer]
    sharp, blurred = (
        -model.displacement(model.static((press,)), where, name)[:, 2] for press in (pad, smooth)
    )
    found = near_field(of_layers(skin), pad=PAD, window=WINDOW, reach=5e-3).at(where[:, 0] - 0.03)[:, layer]
    assert found + blurred == pytest.approx(sharp, rel=1e-3)


def test_it_serves_membranes_as_well(skin):
    model = WaveMembrane.fitted(skin, size=SIZE, modes=(200, 200))
    press = Press(x=0.03, y=0.03, radius=2 * PAD, force=1.0, profile=Profile.GAUSSIAN)
    smooth = Press(x=0.03, y=0.03, radius=2 * WINDOW, force=1.0, profile=Profile.GAUSSIAN)
    where = np.array([[0.03, 0.03, 0.0], [0.0315, 0.03, 0.0]])
    sharp, blurred = (-model.displacement(model.static((p,)), where)[:, 2] for p in (press, smooth))
    found = near_field(model.stack.compliance, pad=PAD, window=WINDOW, reach=3e-3).at(where[:, 0] - 0.03)
    assert found[:, 0] + blurred == pytest.approx(sharp, rel=1e-3)


def test_any_set_of_pads_stores_energy(skin):
    field = near_field(of_layers(skin), pad=PAD, window=WINDOW, reach=20e-3)
    places = np.random.default_rng(0).uniform(0, 6e-3, (60, 2))
    apart = np.linalg.norm(places[:, None] - places[None], axis=2)
    matrix = field.at(apart)[:, :, 0]
    # Interpolation between rows may spoil the sign by its own error.
    assert np.linalg.eigvalsh(matrix).min() > -1e-4 * matrix.max()


def test_beyond_the_table_there_is_nothing(skin):
    field = near_field(half_space(JELLY), pad=PAD, window=WINDOW, reach=3e-3)
    assert field.radii[-1] == pytest.approx(3e-3)
    assert field.at(np.array([3.1e-3])) == 0.0
    assert field.at(np.array([2.9e-3]))[0, 0] != 0.0


@pytest.mark.parametrize(
    ("pad", "window", "reach"), [(2e-3, 1e-3, 1e-3), (0.0, 1e-3, 1e-3), (1e-3, 2e-3, 0.0)]
)
def test_impossible_widths_are_refused(pad, window, reach):
    with pytest.raises(InputError, match="near field"):
        near_field(half_space(JELLY), pad=pad, window=window, reach=reach)
