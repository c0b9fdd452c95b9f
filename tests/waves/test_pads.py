"""Pads: independent of the series' length, the model's own answer where that can tell, and clamped like it."""

import numpy as np
import pytest

from trocar.errors import InputError
from trocar.model import Press, Profile
from trocar.waves.membrane import WaveMembrane
from trocar.waves.pads import Pads
from trocar.waves.solid import WaveSolid

SIZE = (0.06, 0.05)
PLACES = np.array([[0.03, 0.025], [0.031, 0.025], [0.024, 0.03], [0.012, 0.01]])
WIDTH = 0.6e-3


def as_presses(model, layer):
    """The same pads as presses of a long series."""
    where = np.column_stack([PLACES, np.zeros(len(PLACES))])
    presses = (
        Press(x=x, y=y, radius=2 * WIDTH, force=1.0, profile=Profile.GAUSSIAN) for x, y in PLACES.tolist()
    )
    return np.array([-model.displacement(model.static((press,)), where, layer)[:, 2] for press in presses])


@pytest.mark.parametrize("support", ["base", "edges", "edges+base"])
def test_short_series_and_near_field_are_the_long_series(skin, support):
    short = WaveSolid(skin, size=SIZE, support=support, modes=(64, 64))
    long = WaveSolid(skin, size=SIZE, support=support, modes=(200, 200))
    pads = Pads(short, PLACES, WIDTH)
    expected = as_presses(long, "epidermis")
    # The window keeps all but (s k)^2/2 of the block's longest wave, 6e-4 here, and the near field gives that back
    # without the sides; its rows are interpolated to 1e-4.
    assert pads.compliance == pytest.approx(expected, rel=2e-3, abs=2e-3 * expected.max())
    forces = np.array([0.3, 0.1, 0.2, 0.4])
    for face, layer in enumerate(skin.layer_names):
        sunk = pads.deflection(forces, PLACES)[face]
        wanted = forces @ as_presses(long, layer)
        assert sunk == pytest.approx(wanted, rel=3e-3)


def test_membranes_have_pads_too(skin):
    short, long = (WaveMembrane.fitted(skin, size=SIZE, modes=(m, m)) for m in (48, 160))
    expected = as_presses(long, "epidermis")
    assert Pads(short, PLACES, WIDTH).compliance == pytest.approx(
        expected, rel=2e-3, abs=2e-4 * expected.max()
    )


def test_pads_store_energy_whatever_their_width(skin):
    model = WaveSolid(skin, size=SIZE, modes=(64, 64))
    places = 0.02 + np.random.default_rng(0).uniform(0, 4e-3, (60, 2))
    for width in (0.05e-3, 0.3e-3):
        assert np.linalg.eigvalsh(Pads(model, places, width).compliance).min() > 0


@pytest.mark.parametrize("width", [0.0, -1e-3, 5e-3, np.nan])
def test_pads_that_the_series_could_serve_are_refused(skin, width):
    with pytest.raises(InputError, match="pads: width"):
        Pads(WaveSolid(skin, size=SIZE, modes=(32, 32)), PLACES, width)
