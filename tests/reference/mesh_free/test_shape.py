"""Shape functions of the mesh-free model: what they reproduce, where they end, what they see."""

import numpy as np
import pytest

from sample_tissues import three_layers
from trocar.model import Press, Support
from trocar.reference.block import MeshSize
from trocar.reference.mesh_free import Cut
from trocar.reference.mesh_free.body import Body
from trocar.reference.mesh_free.cloud import Cloud, held_nodes, scatter
from trocar.reference.mesh_free.patches import divide
from trocar.reference.mesh_free.shape import felt_in_cell, shape_functions

SIZE = (0.03, 0.024)
AROUND = (Press(x=0.013, y=0.012, radius=4e-3, force=1.0),)
SPACING = MeshSize(per_radius=1.5, growth=0.8, top=0.6, deepening=0.8)
LEANING = Cut(start=(0.008, 0.004), end=(0.021, 0.017), depth=0.004, lean=0.3)


def cloud(*cuts: Cut) -> Cloud:
    return scatter(three_layers(), SIZE, Support.BASE, AROUND, SPACING, cuts)


def weights(nodes: Cloud, point: np.ndarray, inside: np.ndarray) -> np.ndarray:
    """Shape functions of all nodes at a point, asked in the cell that holds `inside`."""
    cell = [int(np.searchsorted(lines, x)) - 1 for lines, x in zip(nodes[:3], inside, strict=True)]
    felt = np.empty(len(nodes.places), dtype=np.int64)
    felt = felt[: felt_in_cell(nodes, *cell, felt)]
    edge = np.array([np.diff(lines)[i] for lines, i in zip(nodes[:3], cell, strict=True)])
    values = np.zeros(len(felt))
    assert shape_functions(nodes, point, point, felt, edge, values)
    everywhere = np.zeros(len(nodes.places))
    everywhere[felt] = values
    return everywhere


def inner_points(count: int) -> np.ndarray:
    low, high = np.array([0.0, 0.0, -0.0111]), np.array([*SIZE, 0.0])
    return low + (high - low) * np.random.default_rng(2).random((count, 3))


@pytest.mark.parametrize("cuts", [(), (LEANING,)])
def test_constant_and_linear_fields_are_reproduced_cut_or_not(cuts):
    nodes = cloud(*cuts)
    for point in inner_points(60):
        values = weights(nodes, point, point)
        assert values.sum() == pytest.approx(1.0, abs=1e-12)
        np.testing.assert_allclose(values @ nodes.places, point, atol=1e-9)


def test_on_an_interface_its_own_nodes_alone_count_and_the_same_from_both_sides():
    nodes = cloud()
    face = nodes.z[np.flatnonzero(np.diff(nodes.slab_layer))[0] + 1]
    point = np.array([0.0117, 0.0093, face])
    above, below = (weights(nodes, point, point + np.array([0, 0, way])) for way in (1e-5, -1e-5))
    np.testing.assert_allclose(above, below, atol=1e-14)
    assert (nodes.places[above != 0, 2] == face).all()


def test_a_held_face_is_held_everywhere_and_not_at_its_nodes_alone():
    nodes = cloud()
    held = held_nodes(nodes, Support.EDGES_AND_BASE, mirrored=False).all(axis=1)
    for point, inwards in (
        ([0.0, 0.0111, -0.003], [1e-5, 0.0, 0.0]),
        ([0.0123, 0.024, -0.0008], [0.0, -1e-5, 0.0]),
        ([0.0077, 0.0131, -0.0111], [0.0, 0.0, 1e-5]),
    ):
        values = weights(nodes, np.array(point), np.add(point, inwards))
        assert not values[~held].any()
        assert values.sum() == pytest.approx(1.0, abs=1e-12)


def test_nothing_is_seen_through_a_cut():
    middle = 0.0131
    nodes = cloud(Cut(start=(middle, 0.0), end=(middle, 0.024), depth=1.0))
    for point in inner_points(60):
        seen = weights(nodes, point, point) != 0
        assert ((nodes.places[seen, 0] < middle) == (point[0] < middle)).all()


def test_nodes_on_a_cut_are_doubled_and_each_copy_is_seen_from_its_side():
    line = cloud().x[3]
    nodes = cloud(Cut(start=(line, 0.0), end=(line, 0.024), depth=1.0))
    extra = len(nodes.places) - len(cloud().places)
    assert extra == len(nodes.y) * len(nodes.z)
    left, right = (
        weights(nodes, np.array([x, 0.01, -0.004]), np.array([x, 0.01, -0.004]))
        for x in (line - 1e-4, line + 1e-4)
    )
    assert not ((left != 0) & (right != 0)).any()


def test_below_a_cut_the_block_is_whole():
    whole, cut = cloud(), cloud(Cut(start=(0.010, 0.0119), end=(0.014, 0.0119), depth=0.001))
    deep = whole.z[whole.z < -0.0012][-1]  # supports of nodes above this plane reach the cut
    below = [p for p in inner_points(150) if p[2] < deep]
    beside = [np.array([0.012, y, -0.0005]) for y in (0.0115, 0.0125)]
    assert below
    assert all(np.array_equal(weights(whole, p, p), weights(cut, p, p)) for p in below)
    assert not any(np.array_equal(weights(whole, p, p), weights(cut, p, p)) for p in beside)


def test_no_node_carries_negative_mass_and_the_total_is_the_block_s():
    tissue = three_layers()
    for cuts in ((), (LEANING,)):
        body = Body(cloud(*cuts), tissue, Support.BASE, "superlu")
        expected = sum(layer.thickness * layer.density for layer in tissue.layers) * SIZE[0] * SIZE[1]
        assert body.mass.sum() == pytest.approx(expected, rel=1e-12)
        assert body.mass.min() > 0


def test_gradients_of_linear_fields_are_exact_over_every_part():
    nodes = cloud(LEANING)
    patches = divide(nodes)
    for patch in range(len(patches.layer)):
        mine = patches.nodes[patches.node_start[patch] : patches.node_start[patch + 1]]
        slopes = patches.gradients[patches.gradient_start[patch] : patches.gradient_start[patch + 1]]
        found = np.einsum("npk,ni->pik", slopes.reshape(len(mine), -1, 3), nodes.places[mine])
        np.testing.assert_allclose(found, np.broadcast_to(np.eye(3), found.shape), atol=1e-9)
