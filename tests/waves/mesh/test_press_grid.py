"""Sites where a live tool presses a mesh."""

import numpy as np
import pytest

from trocar.errors import InputError
from trocar.tissues import Layer
from trocar.waves.mesh.block import block_mesh
from trocar.waves.mesh.elements import Elements
from trocar.waves.mesh.organ import Liver
from trocar.waves.mesh.press_grid import press_grid
from waves.mesh.meshes import BLOCK, LAYERS, THROUGH

JELLY = Layer(name="liver", thickness=0.03, young_modulus=4.5e3, poisson_ratio=0.48, density=1060)


@pytest.fixture(scope="module")
def organ():
    return Elements(Liver().mesh(JELLY, spacing=0.03))


@pytest.fixture(scope="module")
def grid(organ):
    return press_grid(organ, "surface")


def test_a_site_pushes_one_newton_along_the_normal(organ, grid):
    total = (grid.forces.T @ np.repeat(np.eye(3), organ.nodes.shape[1], axis=0)).T
    assert total == pytest.approx(-grid.normals.T, abs=1e-12)  # shape functions add up to 1
    assert (grid.normals[:, 2] > 0).all()
    assert np.linalg.norm(grid.normals, axis=1) == pytest.approx(1, abs=1e-12)


def test_a_force_is_spread_as_a_gaussian_about_its_site():
    elements = Elements(BLOCK)
    grid = press_grid(elements, "cover", window=2.5e-3)
    middle = np.argmin(np.linalg.norm(grid.places[:, :2] - 0.01, axis=1))
    apart = elements.nodes[:2].T - grid.places[middle, :2]
    # Quadratic shape functions carry the second moment of a force exactly: s^2/2 along each axis.
    moments = np.asarray(grid.spread[[middle]] @ apart**2)[0]
    assert moments == pytest.approx(
        0.5 * grid.window**2, rel=1e-3
    )  # the rule, and what lies beyond four windows


def test_sites_lie_on_the_surface_and_beside_it_on_its_tangents(organ, grid):
    on = np.isfinite(organ.heights("surface", grid.places))
    assert grid.places[on, 2] == pytest.approx(organ.heights("surface", grid.places[on]), abs=1e-12)
    assert 0 < (~on).sum() < 0.4 * len(on)
    assert (grid.places[~on, 2] < 0).all()  # the dome falls towards its rim


def test_every_cell_has_all_sites_of_its_cubic_side_by_side(grid):
    columns, rows = np.nonzero(grid.cells)
    assert len(columns) > 50
    for right in range(-1, 3):
        four = np.stack([grid.number[columns + right, rows + back] for back in range(-1, 3)])
        assert (four >= 0).all()
        assert (np.diff(four, axis=0) == 1).all()  # compiled code counts on it


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"window": 0.0}, "window: expected a length above 0"),
        ({"window": float("nan")}, "window"),
        ({"window": 0.01, "spacing": 0.02}, "spacing: expected a length above 0 and up to the window"),
        ({"window": 1e-3, "spacing": 1e-4}, "at most 1024 MiB"),
    ],
)
def test_what_is_no_grid_is_refused(organ, options, said):
    with pytest.raises(InputError, match=said):
        press_grid(organ, "surface", **options)


def test_a_window_that_no_place_of_the_elements_is_near_is_refused():
    ends = np.array([0.0, 0.02])
    elements = Elements(block_mesh(LAYERS, (ends, ends, THROUGH), support="base"))
    with pytest.raises(
        InputError, match="press grid: window: expected a length that reaches from every site"
    ):
        press_grid(elements, "cover", window=3e-4)
