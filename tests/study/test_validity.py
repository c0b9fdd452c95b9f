"""The map of validity, and the curves it is made of."""

import numpy as np
import pytest

from trocar.model import Support
from trocar.reference.block import MeshSize
from trocar.study.models import COARSE_MESH
from trocar.study.stiffening import Dent, DentCurve, error, leaves, linear_waves, neo_hookean, reference_curve
from trocar.study.validity import LINEAR, STIFFENING, as_plain, validity_map
from trocar.tissues import Layer, NeoHookean, Ogden, Tissue

COARSE = MeshSize(per_radius=1.0, growth=1.5, top=0.7, deepening=1.5)
SKIN = Tissue(
    layers=(
        Layer(name="skin", thickness=1e-3, young_modulus=4e5, poisson_ratio=0.48, density=1100.0),
        Layer(
            name="fat",
            thickness=8e-3,
            young_modulus=1e4,
            poisson_ratio=0.48,
            density=900.0,
            prony=((0.5, 0.1),),
        ),
    )
)
SKIN_WITHOUT_MEMORY = Tissue(
    layers=(
        SKIN.layers[0],
        Layer(name="fat", thickness=8e-3, young_modulus=1e4, poisson_ratio=0.48, density=900.0),
    )
)


def curve(*deflection):
    return DentCurve(force=np.arange(1.0, len(deflection) + 1), deflection=np.array(deflection))


def test_the_error_is_that_of_the_worst_layer_with_its_sign():
    truth, waves = curve((1.0, 2.0), (2.0, 4.0)), curve((1.01, 1.9), (2.2, 4.1))
    assert error(truth, waves) == pytest.approx((-0.05, 0.1))


@pytest.mark.parametrize(
    ("bound", "expected"), [(0.02, 0.5), (0.04, 1.0), (0.07, 1.5), (0.1, 2.0), (0.11, np.inf)]
)
def test_where_an_error_leaves_a_bound_lies_on_a_straight_line(bound, expected):
    found = leaves(np.array([1.0, 2.0]), np.array([0.0400001, -0.1000001]), bound)
    assert found == pytest.approx(expected, rel=1e-4)


def test_a_linear_law_is_taken_as_neo_hookean_and_others_are_kept():
    ogden = Ogden(terms=((1.0, 8.0),))
    assert all(layer.law == NeoHookean() for layer in neo_hookean(SKIN).layers)
    own = Tissue(
        layers=(
            Layer(name="a", thickness=1e-3, young_modulus=1e5, poisson_ratio=0.4, density=1e3, law=ogden),
        )
    )
    assert neo_hookean(own).layers[0].law == ogden


def test_a_reference_ends_at_the_depth_asked_for_or_says_why_not():
    deep = reference_curve(Dent(name="deep", tissue=SKIN_WITHOUT_MEMORY), depth=0.2, mesh=COARSE, steps=2)
    assert deep.deflection[-1].max() >= 0.2 * SKIN.thickness > deep.deflection[-2].max()
    assert (np.diff(deep.force) > 0).all()
    bed = Tissue(layers=SKIN_WITHOUT_MEMORY.layers[-1:])
    early = reference_curve(Dent(name="soft", tissue=bed, diameter=5e-3), depth=0.9, mesh=COARSE, steps=2)
    assert "take less force" in early.stopped


def test_the_map_shows_that_stiffening_waves_go_further():
    found = validity_map(SKIN, diameters=(8e-3,), mesh=COARSE_MESH)
    (row,) = found.rows
    assert row.share[-1] >= 1 / 3
    for model in ("wave-membrane", "wave-solid"):
        linear, stiffening = row.curves[model, LINEAR], row.curves[model, STIFFENING]
        assert abs(stiffening.error[-1]) < 0.1
        assert linear.error[-1] > 0.3
        assert linear.leaves[0] < linear.leaves[1] < row.force[-1]
    assert row.curves["wave-solid", STIFFENING].leaves[1] == np.inf
    (plain,) = as_plain(found)
    assert [model["leaves_n"]["0.1"] is None for model in plain["models"]][2:] == [False, True]
    assert plain["deflection_share"] == row.share.tolist()


def test_clamped_sides_leave_the_solid_out():
    dent = Dent(name="clamped", tissue=SKIN_WITHOUT_MEMORY, support=Support.EDGES)
    assert list(linear_waves(dent)) == ["wave-membrane"]
