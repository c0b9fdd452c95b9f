"""The springs' constants: what a box stores under any small strain is what its layer stores."""

from itertools import product

import numpy as np
import pytest

from trocar.reference.springs.boxes import Boxes
from trocar.reference.springs.elements import layer_springs, masses
from trocar.reference.springs.lattice import DeformedLattice, Lattice
from trocar.tissues import Layer

SHAPES = (
    (1.0, 1.0, 1.0),
    (1.0, 1.0, 0.1),
    (3.0, 1.0, 0.03),
    (0.2, 0.5, 4.0),
)  # cubes, flat boxes and posts [mm]
RATIOS = (0.0, 0.25, 0.48, 0.499)


def layer(poisson_ratio=0.48, **given):
    base = {"name": "pad", "thickness": 1e-3, "young_modulus": 1e4, "density": 1000.0}
    return Layer(poisson_ratio=poisson_ratio, **(base | given))


def box(shape):
    a, b, c = (1e-3 * side for side in shape)
    return Boxes(x=np.array([0, a]), y=np.array([0, b]), z=np.array([-c, 0]), slab_layer=np.array([0]))


@pytest.mark.parametrize(("shape", "ratio"), tuple(product(SHAPES, RATIOS)))
def test_a_box_stores_what_its_layer_stores_under_any_homogeneous_strain(shape, ratio):
    pad, boxes = layer(ratio), box(shape)
    stiffness = Lattice().stiffness(boxes, (pad,))
    volume = boxes.edges.prod()
    for seed in range(6):
        slope = np.random.default_rng(seed).normal(size=(3, 3))
        strain = 0.5 * (slope + slope.T)
        expected = pad.shear_modulus * (strain**2).sum() + 0.5 * pad.lame_lambda * np.trace(strain) ** 2
        moved = (slope @ boxes.nodes).ravel()
        # Rounding: the shear of a flat box is the small difference of the diagonals' long ways.
        assert 0.5 * moved @ (stiffness @ moved) == pytest.approx(volume * expected, rel=1e-10)


@pytest.mark.parametrize(("shape", "ratio"), tuple(product(SHAPES, RATIOS)))
def test_no_constant_is_negative_and_only_six_motions_of_a_box_cost_nothing(shape, ratio):
    boxes = box(shape)
    found = layer_springs(boxes, (layer(ratio),))
    assert found.edges.stiffness.min() > 0
    assert found.scissors.stiffness.min() > 0
    assert found.volumes.energy.min() >= 0
    # Unknowns are scaled by the box's sides and the stiffness by its diagonal: a flat box is then like a cube.
    stiffness = Lattice().stiffness(boxes, (layer(ratio),)).toarray()
    scale = 1 / np.sqrt(np.diag(stiffness))
    values = np.linalg.eigvalsh(scale[:, None] * stiffness * scale)
    assert np.abs(values[:6]).max() < 1e-12
    assert values[6] > 1e-9


def test_a_prestress_pulls_on_the_sides_and_stiffens_as_the_finite_elements_say():
    boxes, tense = box((2.0, 1.0, 0.5)), layer(prestress_x=300.0, prestress_y=100.0)
    held = DeformedLattice(boxes, (tense,), np.arange(24)).forces(np.zeros((3, 8)))
    right, back = boxes.nodes[0] > 0, boxes.nodes[1] > 0
    assert held[:, right].sum(axis=1) == pytest.approx([300.0 * 0.5e-6, 0, 0], abs=1e-16)
    assert held[:, back].sum(axis=1) == pytest.approx([0, 100.0 * 1e-6, 0], abs=1e-16)
    slope = np.random.default_rng(0).normal(size=(3, 3))
    moved = (slope @ boxes.nodes).ravel()
    more = Lattice().stiffness(boxes, (tense,)) - Lattice().stiffness(boxes, (layer(),))
    expected = 300.0 * (slope[:, 0] ** 2).sum() + 100.0 * (slope[:, 1] ** 2).sum()
    assert moved @ (more @ moved) == pytest.approx(1e-9 * expected, rel=1e-9)  # of a volume of 1 mm3


def test_the_masses_add_up_to_the_block():
    boxes = Boxes(
        x=np.array([0, 1e-3, 4e-3]),
        y=np.array([0, 3e-3]),
        z=np.array([-3e-3, -1e-3, 0]),
        slab_layer=np.array([1, 0]),
    )
    found = masses(boxes, (layer(density=1000.0), layer(name="deep", density=500.0)))
    assert found.sum() == pytest.approx(12e-6 * 1.0 + 24e-6 * 0.5)
    assert found.min() > 0
