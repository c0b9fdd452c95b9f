"""Which layers stretch, and how stiff they are."""

from dataclasses import replace

import numpy as np
import pytest

from sample_tissues import three_layers
from trocar.errors import InputError
from trocar.model import Support
from trocar.reference.hyperelastic import Material
from trocar.tissues import Fibre, Layer
from trocar.waves.stretch.moduli import (
    MembraneModuli,
    bed_below,
    bonded,
    contrast,
    moduli_of,
    stretching_layers,
)

LAYER = Layer(name="dermis", thickness=1.5e-3, young_modulus=1e5, poisson_ratio=0.4, density=1100.0)


def test_an_isotropic_layer_is_a_plate_in_plane_stress():
    moduli = moduli_of(LAYER)
    assert moduli.along_x == moduli.along_y == pytest.approx(150 / 0.84)
    assert moduli.across == pytest.approx(0.4 * 150 / 0.84)
    assert moduli.shear == pytest.approx(150 / 2.8)


def test_a_held_base_makes_the_lowest_layer_the_bed():
    tissue = three_layers()
    for support in (Support.BASE, Support.EDGES_AND_BASE):
        assert [layer.name for layer in stretching_layers(tissue, support)] == ["epidermis", "dermis"]
        assert bed_below(tissue, support).layer_names == ("fat",)
    assert stretching_layers(tissue, Support.EDGES) == tissue.layers
    assert bed_below(tissue, Support.EDGES) is None
    assert contrast(tissue, Support.EDGES) == np.inf


def test_bonded_layers_add_up():
    one, two = moduli_of(LAYER), bonded((LAYER, LAYER))
    assert two.across == pytest.approx(2 * one.across)
    assert bonded((LAYER, LAYER), share=0.25).shear == pytest.approx(0.5 * one.shear)


@pytest.mark.parametrize("dispersion", [0.0, 0.1])
def test_fibres_add_what_their_law_stores_at_small_stretch(dispersion):
    """Against the energy that finite elements take, of a thin sheet that keeps its volume."""
    law = Fibre(k1=3e4, k2=4.0, dispersion=dispersion, angle=0.6)
    with_fibres, bare = moduli_of(replace(LAYER, law=law)), moduli_of(LAYER)

    def stored(x, y, shear):
        gradient = np.array([[[1 + x, shear, 0.0], [0.0, 1 + y, 0.0], [0.0, 0.0, 1 / ((1 + x) * (1 + y))]]])
        taut, slack = (
            Material(
                law=own, shear_modulus=LAYER.shear_modulus, isochoric_share=1.0, bulk_modulus=0.0
            ).energy(gradient)[0]
            for own in (law, replace(law, k1=0.0))
        )
        return LAYER.thickness * (taut - slack)

    size = 1e-4
    x, y = (2 * stored(*at) / size**2 for at in ((size, 0, 0), (0, size, 0)))
    both = 2 * stored(size, size, 0) / size**2
    shear = 2 * stored(size, size, size) / size**2 - both
    assert x == pytest.approx(with_fibres.along_x - bare.along_x, rel=2e-3)
    assert y == pytest.approx(with_fibres.along_y - bare.along_y, rel=2e-3)
    assert (both - x - y) / 2 == pytest.approx(with_fibres.across - bare.across, rel=2e-3)
    assert shear == pytest.approx(with_fibres.shear - bare.shear, rel=2e-3)


@pytest.mark.parametrize(
    ("key", "value"), [("along_x", 0.0), ("along_y", float("nan")), ("shear", -1.0), ("across", 20.0)]
)
def test_impossible_moduli_are_refused(key, value):
    usual = {"along_x": 10.0, "along_y": 10.0, "across": 3.0, "shear": 4.0}
    with pytest.raises(InputError, match=key):
        MembraneModuli(**{**usual, key: value})
