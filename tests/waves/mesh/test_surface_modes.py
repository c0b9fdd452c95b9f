"""Modes that answer the sites of a surface: their static answer is the mesh's."""

from dataclasses import replace

import numpy as np
import pytest

from trocar.errors import InputError
from trocar.waves.mesh.basis_cache import BasisCache
from trocar.waves.mesh.press_grid import press_grid
from trocar.waves.mesh.surface_modes import surface_modes
from trocar.waves.mesh.wave_mesh import WaveMesh
from waves.mesh.meshes import COARSE


@pytest.fixture(scope="module")
def model():
    return WaveMesh(COARSE, modes=10)


@pytest.fixture(scope="module")
def grid(model):
    return press_grid(model.elements, "cover", window=3e-3)


@pytest.fixture(scope="module")
def modes(model, grid):
    return surface_modes(model, grid)


def test_the_static_answer_is_that_of_the_whole_mesh(model, grid, modes):
    chosen = np.random.default_rng(0).choice(len(grid.places), 5, replace=False)
    theirs = grid.forces.T @ model.matrices.answer(grid.forces[:, chosen].toarray())
    assert modes.static[:, chosen] == pytest.approx(theirs, abs=1e-7 * theirs.max())  # of the solver, 1e-8


def test_what_is_left_out_stores_energy_and_is_little(modes):
    values = np.linalg.eigvalsh(modes.rest)
    assert values[0] > -1e-7 * np.linalg.eigvalsh(modes.static)[-1]  # rounding of what was taken away
    assert np.trace(modes.rest) < 0.05 * np.trace(modes.static)


def test_the_lowest_modes_stay_and_all_others_are_faster(model, modes):
    assert modes.squares[:10] == pytest.approx(model.lowest[0])
    assert modes.squares[10:].min() > modes.squares[9]


def test_they_are_made_once(model, grid, tmp_path):
    kept, told = WaveMesh(COARSE, modes=10, cache=BasisCache(tmp_path)), []
    first = surface_modes(kept, grid, progress=lambda done, of: told.append((done, of)))
    assert told[-1][0] == told[-1][1] > len(grid.places)
    assert [done for done, _ in told] == sorted(done for done, _ in told)
    told.clear()
    again = surface_modes(kept, grid, progress=lambda done, of: told.append((done, of)))
    assert not told
    assert np.array_equal(again.shapes, first.shapes)


def test_materials_that_damp_differently_are_refused(grid):
    cover, *others = COARSE.materials
    lossy = replace(COARSE, materials=(replace(cover, loss_factor=0.2), *others))
    with pytest.raises(InputError, match=r"one loss for all.*give all layers the same loss_factor"):
        surface_modes(WaveMesh(lossy, modes=2), grid)


def test_materials_that_remember_are_refused(grid):
    remembers = replace(
        COARSE, materials=tuple(replace(one, prony=((0.5, 0.1),)) for one in COARSE.materials)
    )
    with pytest.raises(InputError, match=r"a Prony series of cover and.*take the \[layer.memory\] table out"):
        surface_modes(WaveMesh(remembers, modes=2), grid)


def test_loss_beside_prestress_is_refused(grid):
    taut = replace(
        COARSE,
        materials=tuple(replace(one, prestress_x=100.0, loss_factor=0.2) for one in COARSE.materials),
    )
    with pytest.raises(InputError, match=r"ms of retardation, prestress.*none beside prestress"):
        surface_modes(WaveMesh(taut, modes=2), grid)
