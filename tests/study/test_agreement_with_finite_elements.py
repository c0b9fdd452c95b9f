"""The claim of the project, on a few presses; `bench/agreement.py` runs the whole sweep."""

from dataclasses import replace

import numpy as np
import pytest

from trocar.model import Press, Support
from trocar.reference.fea import FEASolid
from trocar.study.half_sine import half_sine
from trocar.study.statistics.agreement import nrmse
from trocar.study.sweep_of_agreement import PLACES, SIZE, agreements, largest, skin_like
from trocar.tissues.catalogue import tissue
from trocar.waves.membrane import WaveMembrane
from trocar.waves.solid import WaveSolid

MIDDLE, SIDE, CORNER = PLACES


@pytest.mark.parametrize(
    ("moduli", "fat", "place", "diameter"),
    [
        ((1e6, 2e5, 1e4), 10e-3, MIDDLE, 6e-3),
        ((5e5, 35e3, 2e3), 20e-3, SIDE, 5e-3),
        ((4e6, 1e6, 2e4), 5e-3, CORNER, 8e-3),
    ],
)
def test_on_a_held_base_the_waves_match_finite_elements(moduli, fat, place, diameter):
    layers = skin_like(*moduli, fat)
    press = Press(x=place[0] * SIZE[0], y=place[1] * SIZE[1], radius=diameter / 2, force=0.1)
    reference = largest(FEASolid(layers, size=SIZE, support="base", around=(press,)), press)
    assert largest(WaveSolid(layers, size=SIZE), press) == pytest.approx(reference, rel=0.005)
    membrane = WaveMembrane.fitted(layers, size=SIZE, modes=(96, 96))
    assert largest(membrane, press) == pytest.approx(reference, rel=0.05)


@pytest.mark.parametrize("support", ["edges", "edges+base"])
@pytest.mark.parametrize(
    ("moduli", "fat", "place"),
    [
        ((1e6, 2e5, 1e4), 10e-3, MIDDLE),
        ((4e6, 5e5, 2e3), 14e-3, MIDDLE),  # a stiff skin on soft fat feels the sides from afar
        ((5e5, 35e3, 2e3), 5e-3, CORNER),
    ],
)
def test_clamped_sides_hold_the_waves_as_they_hold_finite_elements(support, moduli, fat, place):
    layers = skin_like(*moduli, fat)
    press = Press(x=place[0] * SIZE[0], y=place[1] * SIZE[1], radius=3e-3, force=0.1)
    reference = largest(FEASolid(layers, size=SIZE, support=support, around=(press,)), press)
    model = WaveSolid(layers, size=SIZE, support=support)
    assert largest(model, press) == pytest.approx(reference, rel=0.01)
    loose = largest(WaveSolid(layers, size=SIZE, support=support, side_modes=(1, 1)), press)
    assert np.abs(loose / reference - 1).max() > np.abs(largest(model, press) / reference - 1).max()


@pytest.mark.parametrize("support", ["base", "edges"])
def test_a_tilted_tool_drags_both_models_alike(support):
    layers = skin_like(1e6, 2e5, 1e4, 10e-3)
    press = Press(x=0.03, y=0.03, radius=0.003, force=0.1, tilt=0.6, azimuth=0.0)
    where = np.array([[0.03, 0.03, 0.0], [0.034, 0.03, 0.0], [0.025, 0.03, 0.0], [0.03, 0.035, 0.0]])
    reference = FEASolid(layers, size=SIZE, support=support, around=(press,))
    model = WaveSolid(layers, size=SIZE, support=support)
    for layer in layers.layer_names:
        expected = reference.displacement(reference.static((press,)), where, layer)
        actual = model.displacement(model.static((press,)), where, layer)
        # Points inside and outside the footprint, all three components, relative to the largest.
        assert actual == pytest.approx(expected, abs=0.005 * np.abs(expected).max())


def test_prestress_stiffens_both_models_alike_along_and_across():
    layers = skin_like(1e6, 2e5, 1e4, 10e-3)
    taut = replace(layers.layers[1], prestress_x=60e3, prestress_y=5e3)
    layers = replace(layers, layers=(layers.layers[0], taut, layers.layers[2]))
    press = Press(x=0.03, y=0.03, radius=0.003, force=0.1)
    reference = FEASolid(layers, size=SIZE, support="base", around=(press,))
    model = WaveSolid(layers, size=SIZE)
    where = np.array([[0.03, 0.03, 0.0], [0.038, 0.03, 0.0], [0.03, 0.038, 0.0]])
    expected = reference.displacement(reference.static((press,)), where)[:, 2]
    actual = model.displacement(model.static((press,)), where)[:, 2]
    deepest = np.abs(expected).max()
    # Along and across differ by more than the tolerance, so that exchanging them would show.
    assert abs(expected[1] - expected[2]) > 0.02 * deepest
    assert actual == pytest.approx(expected, abs=0.005 * deepest)


def test_a_footprint_as_wide_as_the_block_is_resolved_at_its_rim():
    layers = replace(skin_like(1e6, 1e5, 1e4, 12e-3))
    press = Press(x=0.03, y=0.03, radius=0.03, force=1.0)
    reference = largest(FEASolid(layers, size=SIZE, support="base", around=(press,)), press)
    assert largest(WaveSolid(layers, size=SIZE), press) == pytest.approx(
        reference, rel=0.01
    )  # 4 % when it was not


def test_half_a_sine_of_20_ms_is_followed():
    skin = tissue("skin")
    press = Press(x=0.03, y=0.03, radius=0.003, force=0.05)
    models = {
        "fea": FEASolid(skin, size=SIZE, support=Support.BASE, around=(press,)),
        "wave-solid": WaveSolid(skin, size=SIZE),
    }
    curves = half_sine(models, press)
    assert curves["fea"].max() > 1e-4
    assert nrmse(curves["fea"], curves["wave-solid"]) < 0.02


def test_the_sweep_yields_what_it_says():
    row = next(agreements(Support.BASE, places=(MIDDLE,), diameters=(6e-3,), fats=(5e-3,)))
    assert row.reference.shape == row.solid.shape == row.membrane.shape == (3,)
    assert np.abs(row.solid).max() < 0.005
