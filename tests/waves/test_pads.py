"""Pads: independent of the series' length, the model's own answer where that can tell, and clamped like it."""

import numpy as np
import pytest

from trocar.errors import InputError
from trocar.model import Press, Profile
from trocar.waves.membrane import WaveMembrane
from trocar.waves.near_field import SMOOTH, layered_compliance, near_field
from trocar.waves.pads import Pads
from trocar.waves.solid import WaveSolid

SIZE = (0.06, 0.05)
PLACES = np.array([[0.03, 0.025], [0.031, 0.025], [0.024, 0.03], [0.012, 0.01]])
WIDTH = 0.6e-3


def as_presses(model, layer, width=WIDTH):
    """The same pads as presses of a long series."""
    where = np.column_stack([PLACES, np.zeros(len(PLACES))])
    presses = (
        Press(x=x, y=y, radius=2 * width, force=1.0, profile=Profile.GAUSSIAN) for x, y in PLACES.tolist()
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


def test_sheets_have_pads_too(skin):
    stack = WaveMembrane.fitted(skin, size=SIZE, modes=(2, 2)).stack
    short, long = (WaveMembrane(stack, size=SIZE, modes=(m, m)) for m in (48, 160))
    expected = as_presses(long, "epidermis")
    assert Pads(short, PLACES, WIDTH).compliance == pytest.approx(
        expected, rel=2e-3, abs=2e-4 * expected.max()
    )


def test_pads_on_fitted_sheets_make_the_layers_own_local_dent(skin):
    """Sheets answer the window of `SMOOTH`, the layers what is shorter: as the layered solid does."""
    model = WaveMembrane.fitted(skin, size=SIZE, support="base", modes=(64, 64))
    window = as_presses(model, "epidermis", width=SMOOTH)
    field = near_field(
        lambda k: layered_compliance(skin, k, base_held=True, finest=WIDTH),
        pad=WIDTH,
        window=SMOOTH,
        reach=7 * SMOOTH,
    )
    apart = np.linalg.norm(PLACES[:, None] - PLACES[None], axis=2)
    found = Pads(model, PLACES, WIDTH).compliance
    # The series ends at exp(-4.5^2/2) of the window or later; rows of the table are interpolated to 1e-4.
    assert found == pytest.approx(window + field.at(apart)[:, :, 0], rel=2e-3, abs=2e-4 * found.max())
    solid = Pads(WaveSolid(skin, size=SIZE, support="base", modes=(64, 64)), PLACES, WIDTH).compliance
    assert found.diagonal() == pytest.approx(solid.diagonal(), rel=0.03)  # what a fit misses of long waves
    sheets = Pads(WaveMembrane(model.stack, size=SIZE, modes=(64, 64)), PLACES, WIDTH).compliance
    assert np.abs(sheets / solid - 1).diagonal().max() > 0.05  # and sheets alone of a local dent


def test_pads_store_energy_whatever_their_width(skin):
    model = WaveSolid(skin, size=SIZE, modes=(64, 64))
    places = 0.02 + np.random.default_rng(0).uniform(0, 4e-3, (60, 2))
    for width in (0.05e-3, 0.3e-3):
        assert np.linalg.eigvalsh(Pads(model, places, width).compliance).min() > 0


@pytest.mark.parametrize("width", [0.0, -1e-3, 5e-3, np.nan])
def test_pads_that_the_series_could_serve_are_refused(skin, width):
    with pytest.raises(InputError, match="pads: width"):
        Pads(WaveSolid(skin, size=SIZE, modes=(32, 32)), PLACES, width)
