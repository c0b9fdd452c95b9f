"""Elimination, solution and modes against dense algebra."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.linalg import eigh

from trocar.errors import SolverError
from trocar.waves.mesh.assembled import Assembled
from trocar.waves.mesh.block import block_mesh
from trocar.waves.mesh.dissection import dissected
from trocar.waves.mesh.elements import Elements
from trocar.waves.mesh.lowest_modes import lowest_modes
from trocar.waves.mesh.sparse import Factored
from waves.mesh.meshes import ACROSS, LAYERS, THROUGH

SMALL = block_mesh(LAYERS, (ACROSS[::3], ACROSS[::3], THROUGH))


def grid(n):
    """A stiffness of springs between neighbours on a cube of n^3 nodes, held to the ground, and its places."""
    line = sp.diags_array([-np.ones(n - 1), 2 * np.ones(n), -np.ones(n - 1)], offsets=[-1, 0, 1])
    one = sp.eye_array(n)
    total = sum(
        sp.kron(sp.kron(*pair[:2]), pair[2])
        for pair in ((line, one, one), (one, line, one), (one, one, line))
    )
    places = np.stack(np.meshgrid(*(np.arange(float(n)),) * 3, indexing="ij")).reshape(3, -1)
    return sp.csr_array(total), places


def test_parts_are_all_nodes_and_halves_do_not_touch():
    matrix, places = grid(9)
    parts = dissected(places, matrix)
    assert sorted(np.concatenate([part.nodes for part in parts]).tolist()) == list(range(9**3))
    under = []
    for part in parts:
        under.append(np.concatenate([part.nodes, *(under[one] for one in part.below)]))
        if len(part.below) == 2:
            one, other = (under[half] for half in part.below)
            assert matrix[one][:, other].nnz == 0
    assert len(parts[-1].nodes) <= 81  # a plane of the cube


def test_the_factor_solves_what_dense_algebra_solves():
    matrix, places = grid(9)
    parts = dissected(places, matrix)
    order = np.concatenate([part.nodes for part in parts])
    factor = Factored(
        sp.csr_array(matrix[order][:, order]), [len(p.nodes) for p in parts], [p.below for p in parts]
    )
    right = np.random.default_rng(1).normal(size=(len(order), 3))
    expected = np.linalg.solve(matrix.toarray(), right)
    assert factor.solve(right[order]) == pytest.approx(expected[order], rel=1e-9, abs=1e-12)
    assert factor.solve(right[order, 0]) == pytest.approx(expected[order, 0], rel=1e-9, abs=1e-12)
    assert factor.stored < 8 * len(order) ** 2


def test_what_floats_cannot_be_factored():
    with pytest.raises(SolverError, match="is every part of it held"):
        Factored(sp.csr_array(np.array([[1.0, -1.0], [-1.0, 1.0 - 1e-15]])), [2], [()])


def test_modes_are_those_of_dense_algebra():
    matrices = Assembled(Elements(SMALL))
    free = matrices.free
    stiffness, mass = (one[free][:, free].toarray() for one in (matrices.stiffness, matrices.mass))
    squares, modes = matrices.modes(12)
    expected = eigh(stiffness, mass, subset_by_index=(0, 11), eigvals_only=True)
    assert squares == pytest.approx(expected, rel=1e-9)
    assert modes.T @ (matrices.mass @ modes) == pytest.approx(np.eye(12), abs=1e-8)


def test_equal_frequencies_are_all_found():
    matrix, _ = grid(6)
    dense = np.linalg.inv(matrix.toarray())
    squares, _ = lowest_modes(lambda right: dense @ right, sp.csr_array(sp.eye_array(216)), 30)
    one = 2 - 2 * np.cos(np.pi * np.arange(1, 7) / 7)
    exact = np.sort((one[:, None, None] + one[:, None] + one).ravel())[:30]
    assert squares == pytest.approx(exact, rel=1e-10)


def test_damping_of_one_time_is_that_of_its_elements():
    lossy = replace(SMALL, materials=tuple(replace(layer, loss_factor=0.3) for layer in SMALL.materials))
    matrices = Assembled(Elements(lossy))
    apart = (matrices.damping - matrices.elements.damping()).toarray()
    assert np.abs(apart).max() < 1e-12 * np.abs(matrices.damping.toarray()).max()
