"""Sites where a live tool presses a mesh: the part of its surface that looks up, on an even grid in x and y.

A site pushes along the surface's mean normal and spreads its force over the surface about it as exp(-d^2/s^2), d the
distance in space; it reads the surface with the same weights. Both ways together, of waves k a site passes
exp(-(s k)^2/2): the window of `near_field`, which counts what is shorter. With s not much shorter than an edge
of the elements, the mesh can follow what sites ask of it, and with two sites to a window whatever lies between sites
is a cubic of theirs (`mesh_patch`).

An even grid, not the mesh's nodes: the site below a tool is found by division, four sites along x and along y always
lie around it, and the cubic's slope has no jumps. Near the rim some of those would lie beside the surface. They push
on the place of the surface that is nearest to them, and their height goes on along its tangent plane.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.spatial import cKDTree

from trocar.errors import InputError
from trocar.model import FloatArray
from trocar.waves.mesh.elements import Elements
from trocar.waves.mesh.footprint import STEEPEST
from trocar.waves.mesh.solid_mesh import IntArray
from trocar.waves.mesh.surface_rule import surface_rule

LARGEST = 2**30  # [bytes] of a table from every site to every other
_PER_EDGE = 0.8  # windows to an edge of the mesh, unless another is asked for
PER_WINDOW = 2.0  # sites to a window, unless another spacing is asked for
_RING = 3  # columns and rows of the grid beyond the mesh on each side: a cubic's two, and one of no cell
_REACH = 4.0  # in windows: exp(-16) of a spread force is left out


@dataclass(frozen=True, eq=False)
class PressGrid:
    """Sites, numbered along y and then along x.

    Attributes:
        surface: its name.
        first: x, y of the grid's first column and row [m].
        spacing: of columns and rows [m].
        window: s [m].
        number: of the site at each column and row, -1 where there is none, shape (columns, rows).
        cells: whether a tool can press between a column and row and the next, shape (columns, rows).
        places: of the sites [m], shape (N, 3).
        normals: mean ones about them, of length 1, upward, shape (N, 3).
        spread: share of a site's force that each node of the mesh takes, shape (N, nodes).
    """

    surface: str
    first: tuple[float, float]
    spacing: float
    window: float
    number: IntArray
    cells: np.ndarray
    places: FloatArray
    normals: FloatArray
    spread: sp.csr_array

    @property
    def forces(self) -> sp.csc_array:
        """Nodal forces of 1 N into the surface at each site, shape (3 nodes, N)."""
        into = [(self.spread * -self.normals[:, [axis]]).T for axis in range(3)]
        return sp.csc_array(sp.vstack(into))


def press_grid(
    elements: Elements, surface: str, *, window: float | None = None, spacing: float | None = None
) -> PressGrid:
    """Lay a grid of sites over a surface.

    Args:
        elements: of the mesh.
        surface: its name.
        window: s [m]; None takes 0.8 of the mean length of the surface's edges.
        spacing: of the sites [m]; None takes half a window.

    Raises:
        InputError: a length is not possible, the table of the sites would be larger than 1 GiB, or nothing looks up.
    """
    window = usual_window(elements, surface) if window is None else window
    spacing = window / PER_WINDOW if spacing is None else spacing
    if not 0 < window < min(elements.mesh.size):
        raise InputError("press grid: window", "a length above 0 and below the mesh's sides [m]", window)
    if not 0 < spacing <= window:
        raise InputError("press grid: spacing", "a length above 0 and up to the window [m]", spacing)
    x, y = (spacing * np.arange(-_RING, np.ceil(side / spacing) + _RING + 1) for side in elements.mesh.size)
    if (
        8.0 * (len(x) * len(y)) ** 2 > 4 * LARGEST
    ):  # before any work: a mesh fills a half of its rectangle at least
        raise _too_many(len(x) * len(y), spacing)
    corners = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
    heights = elements.heights(surface, corners)
    rule = surface_rule(elements, surface)
    tree = cKDTree(rule.places)
    over = np.isfinite(heights)

    def weighted(places: FloatArray) -> sp.csr_array:
        """Return the share that every place of the rule has in a mean about other places."""
        near = cKDTree(places).sparse_distance_matrix(tree, _REACH * window, output_type="coo_matrix")
        shares = rule.areas[near.col] * np.exp(-((near.data / window) ** 2))
        table = sp.csr_array((shares, (near.row, near.col)), shape=near.shape)
        total: FloatArray = np.asarray(table.sum(axis=1))
        if not (total > 0).all():
            raise InputError(
                "press grid: window",
                "a length that reaches from every site to places where integrals over the surface are taken, "
                f"{_REACH:g} windows away at most",
                window,
                "take a wider window, or smaller elements",
            )
        return sp.csr_array(table.multiply(1.0 / total[:, None]))

    up = np.zeros(len(corners), dtype=bool)
    up[over] = _unit(weighted(np.column_stack([corners, heights])[over]) @ rule.normals)[:, 2] > STEEPEST
    cells, needed = _cells(up.reshape(len(x), len(y)))
    if not needed.any():
        raise InputError(
            "press grid: surface",
            "a part that looks up, at most 75 degrees from it",
            surface,
            "turn the mesh so that the side to press is above",
        )
    site = np.flatnonzero(needed)
    if 8 * len(site) ** 2 > LARGEST:
        raise _too_many(len(site), spacing)
    number = np.full(needed.shape, -1)
    number.ravel()[site] = np.arange(len(site))
    places = np.column_stack([corners[site], np.where(over[site], heights[site], 0.0)])
    beside = ~over[site]
    pressed = places.copy()
    # The nearest as seen from above: a site's own height is not known there.
    pressed[beside] = rule.places[cKDTree(rule.places[:, :2]).query(places[beside, :2])[1]]
    shares = weighted(pressed)
    normals = _unit(shares @ rule.normals)
    slopes = -normals[beside, :2] / np.maximum(normals[beside, 2:], STEEPEST)
    away = (places - pressed)[beside, :2]
    places[beside, 2] = pressed[beside, 2] + (slopes * away).sum(axis=1)
    return PressGrid(
        surface=surface,
        first=(float(x[0]), float(y[0])),
        spacing=spacing,
        window=window,
        number=number.astype(np.int64),
        cells=cells,
        places=places,
        normals=normals,
        spread=sp.csr_array(shares @ rule.shapes),
    )


def cubic_table(grid: PressGrid, places: FloatArray) -> sp.csr_array:
    """Return the weights of sites at places, shape (n, N): Keys's cubic convolution, as a live patch reads them.

    Args:
        grid: the sites.
        places: as seen from above [m], shape (n, 2); a row is empty where a tool cannot press.
    """
    at = (np.asarray(places) - grid.first) / grid.spacing
    cell = np.floor(at).astype(np.int64)
    inside = np.logical_and.reduce((cell >= 1) & (cell < np.array(grid.cells.shape) - 2), axis=1)
    inside[inside] = grid.cells[cell[inside, 0], cell[inside, 1]]
    t, cell = (at - cell)[inside], cell[inside]
    cubic = np.stack(
        [
            t * (t * (1.0 - 0.5 * t) - 0.5),
            1.0 + t * t * (1.5 * t - 2.5),
            t * (0.5 + t * (2.0 - 1.5 * t)),
            0.5 * t * t * (t - 1.0),
        ],
        axis=-1,
    )
    around = np.arange(-1, 3)
    columns = grid.number[cell[:, 0, None, None] + around[:, None], cell[:, 1, None, None] + around]
    weights = cubic[:, 0, :, None] * cubic[:, 1, None, :]
    rows = np.repeat(np.flatnonzero(inside), 16)
    return sp.csr_array((weights.ravel(), (rows, columns.ravel())), shape=(len(at), len(grid.places)))


def usual_window(elements: Elements, surface: str) -> float:
    """Return 0.8 of the mean length of a surface's edges [m]."""
    return _PER_EDGE * _edge(elements, surface)


def _edge(elements: Elements, surface: str) -> float:
    """Return the mean length of the edges of a surface [m]."""
    faces = elements.mesh.corners[elements.mesh.surfaces[surface]]
    return float(np.linalg.norm(faces - np.roll(faces, 1, axis=1), axis=2).mean())


def _cells(up: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the cells with a corner that looks up, and the columns and rows that their cubics need."""
    cells, needed = np.zeros_like(up), np.zeros_like(up)
    cells[:-1, :-1] = up[:-1, :-1] | up[1:, :-1] | up[:-1, 1:] | up[1:, 1:]
    columns, rows = np.nonzero(cells)
    for right in range(-1, 3):
        for back in range(-1, 3):
            needed[columns + right, rows + back] = True
    return cells, needed


def _unit(vectors: FloatArray) -> FloatArray:
    return np.asarray(vectors / np.linalg.norm(vectors, axis=1, keepdims=True))


def _too_many(sites: int, spacing: float) -> InputError:
    return InputError(
        "press grid: spacing",
        f"one whose table of sites takes at most {LARGEST >> 20} MiB",
        f"{sites} sites at {1e3 * spacing:.3g} mm",
        "take a wider window",
    )
