"""Meshes that cannot be a tissue are refused, each in a sentence."""

from dataclasses import replace

import numpy as np
import pytest

from trocar.errors import InputError
from trocar.waves.mesh.faces import outer_faces
from trocar.waves.mesh.solid_mesh import Held, placed, volumes_of
from waves.mesh.meshes import BLOCK, tetrahedra


def test_volumes_add_up_and_faces_are_the_outside():
    assert volumes_of(BLOCK.corners, BLOCK.cells).sum() == pytest.approx(0.02 * 0.02 * 0.0062)
    many = tetrahedra(BLOCK)
    assert volumes_of(many.corners, many.cells).sum() == pytest.approx(0.02 * 0.02 * 0.0062)
    x, y, z = (len(np.unique(column)) - 1 for column in BLOCK.corners.T)
    assert len(outer_faces(BLOCK.cells)[0]) == 2 * (x * y + y * z + z * x)
    assert len(outer_faces(many.cells)[0]) == 2 * len(outer_faces(BLOCK.cells)[0])


def test_a_mesh_is_placed_like_a_block():
    moved = placed(replace(BLOCK, corners=BLOCK.corners + np.array([0.1, -0.2, 0.3])))
    assert moved.corners == pytest.approx(BLOCK.corners, abs=1e-12)


def inverted(mesh):
    cells = mesh.cells.copy()
    cells[7] = cells[7][[1, 0, 2, 3, 5, 4, 6, 7]]
    return {"cells": cells}


def twice(mesh):
    beside = mesh.corners + np.array([0.05, 0.0, 0.0])
    return {
        "corners": np.concatenate([mesh.corners, beside]),
        "cells": np.concatenate([mesh.cells, mesh.cells + len(beside)]),
        "region": np.tile(mesh.region, 2),
    }


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (inverted, "1 flat or inverted, the first 7, at"),
        (lambda mesh: {"corners": 1e3 * mesh.corners}, "is the unit right"),
        (lambda mesh: {"corners": 1e-3 * mesh.corners}, "is the unit right"),
        (lambda mesh: {"corners": np.append(mesh.corners, [[0.0, 0.0, 0.0]], axis=0)}, "1 in none"),
        (lambda mesh: {"corners": np.full_like(mesh.corners, np.nan)}, "finite places"),
        (twice, "one piece, whose elements share nodes, got '2 pieces, the second of"),
        (lambda mesh: {"held": ()}, "floats away"),
        (lambda mesh: {"held": (Held(faces=np.zeros((0, 4), dtype=int)),)}, "floats away"),
        (lambda mesh: {"surfaces": {}}, "a name with faces"),
        (lambda mesh: {"region": mesh.region + 1}, "a number from 0 to 2"),
        (lambda mesh: {"cells": mesh.cells[:, :5]}, "tetrahedra or hexahedra"),
        (lambda mesh: {"cells": mesh.cells + 1}, "nodes from 0 to"),
        (lambda mesh: {"cells": mesh.cells - 1}, "got -1"),
        (lambda mesh: {"surfaces": {"top": mesh.surfaces["fat"][:, :3]}}, "4 corners each"),
        (lambda mesh: {"corners": np.zeros((1_000_000, 3))}, "at most 200000"),
    ],
)
def test_what_cannot_be_a_tissue_is_refused(change, said):
    with pytest.raises(InputError, match=said):
        replace(BLOCK, **change(BLOCK))
