"""The quadrature: smoothed gradients of shape functions over parts of the cells between the nodes.

Every cell is split into 2 x 2 x 2 parts. The gradient of a shape function over a part is its flux out of the part's six
faces over the part's volume,

    B_I = 1/V sum over faces of n A N_I(middle of the face),

the stabilised conforming nodal integration of J.-S. Chen, C.-T. Wu, S. Yoon and Y. You 2001, Int. J. Numer. Methods
Eng. 50:435, here on the parts of cells and not on nodal cells: no derivative of a shape function is needed, linear
fields have their exact gradient, and what leaves one part enters the next, so that linear patches are exact. Means
over halves of a cell miss a quarter of the square of what varies linearly over it, and tissue would bend too easily:
what the parts of a whole cell differ by is stretched from their middles to the Gauss points. What squeezing costs is
counted once a cell, from the mean of its parts (the pressure projection of J.-S. Chen, S. Yoon, H.-P. Wang, W. K. Liu
2000, Comput. Methods Appl. Mech. Eng. 181:117): about one constraint a node, without which nearly incompressible tissue
locks.

Where a cut runs through a cell its parts are sorted by whether they see each other, each group a patch of its own, and
a part sees to its faces from its own middle: a cut runs along faces of parts, within a quarter of a cell of its place.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

import numpy as np
from numba import njit

from trocar.errors import InputError
from trocar.model import FloatArray
from trocar.reference.grid import IntArray
from trocar.reference.mesh_free.cloud import Cloud
from trocar.reference.mesh_free.cut import hidden
from trocar.reference.mesh_free.shape import felt_in_cell, shape_functions

PARTS = 8
"""Parts of a cell [1]."""

TO_GAUSS = 2 / sqrt(3)
"""Distance of a cell's Gauss points from its middle over that of its parts' middles [1]."""

_BEYOND = 1.001  # a cut that meets a face of a part is met this much behind it


class Patches(NamedTuple):
    """Cells, or what a cut leaves of them in one piece; a tuple of arrays, so that compiled functions take it.

    Args:
        node_start: where each patch's nodes begin in `nodes`, shape (patches + 1,).
        nodes: of every patch, one patch after the other.
        part_start: where each patch's parts begin in `volume`, shape (patches + 1,).
        volume: of the parts [m3].
        gradient_start: where each patch's gradients begin in `gradients`, shape (patches + 1,).
        gradients: B [1/m], for each patch an array of shape (nodes, parts, 3), flattened.
        layer: of each patch, shape (patches,).
        keeper: the node that carries the mass of each part, shape (parts,).
    """

    node_start: IntArray
    nodes: IntArray
    part_start: IntArray
    volume: FloatArray
    gradient_start: IntArray
    gradients: FloatArray
    layer: IntArray
    keeper: IntArray


def divide(cloud: Cloud) -> Patches:
    """Divide a block into patches.

    Raises:
        InputError: cuts leave a piece without a node.
    """
    cells = (len(cloud.x) - 1, len(cloud.y) - 1, len(cloud.z) - 1)
    result = _divide(cloud, *cells)
    if (result[-1] < 0).any():
        raise InputError(
            "cuts",
            "nodes left between cuts, sides and base",
            "a piece without any",
            "take a finer resolution, or keep the cuts further apart and away from held sides",
        )
    return Patches(*result)


@njit(cache=True, nogil=True)
def _divide(
    cloud: Cloud, nx: int, ny: int, nz: int
) -> tuple[
    IntArray, IntArray, IntArray, FloatArray, IntArray, FloatArray, IntArray, IntArray
]:  # pragma: no cover - compiled
    many = 8 * 64 + len(cloud.places) - len(cloud.x) * len(cloud.y) * len(cloud.z)
    felt, cells = np.empty(many, np.int64), nx * ny * nz
    most = PARTS * cells if len(cloud.cuts) else cells
    node_start, part_start = np.zeros(most + 1, np.int64), np.zeros(most + 1, np.int64)
    gradient_start, layer = np.zeros(most + 1, np.int64), np.zeros(most, np.int64)
    nodes, gradients = np.empty(64 * cells, np.int64), np.empty(64 * 24 * cells)
    volume, keeper = np.empty(PARTS * cells), np.empty(PARTS * cells, np.int64)
    here, fluxes = np.empty(many), np.empty((PARTS, many, 3))
    middles, group = np.empty((PARTS, 3)), np.empty(PARTS, np.int64)
    patches = 0
    for cell in range(cells):
        i, j, k = cell // (ny * nz), cell // nz % ny, cell % nz
        low = np.array([cloud.x[i], cloud.y[j], cloud.z[k]])
        edge = np.array([cloud.x[i + 1], cloud.y[j + 1], cloud.z[k + 1]]) - low
        count = felt_in_cell(cloud, i, j, k, felt)
        for part in range(PARTS):
            for axis in range(3):
                middles[part, axis] = low[axis] + (0.25 + 0.5 * (part >> axis & 1)) * edge[axis]
            _fluxes(cloud, middles[part], edge, felt[:count], here, fluxes[part])
        _sort(cloud.cuts, middles, group)
        if group.max() == 0:
            _spread(fluxes[:, :count])
        for leader in range(PARTS):
            if group[leader] != leader:
                continue
            begin = node_start[patches]
            if begin + count > len(nodes):
                nodes = np.concatenate((nodes, np.empty(len(nodes) + many, np.int64)))
            end, parts = begin, part_start[patches]
            columns = np.empty(count, np.int64)
            for number in range(count):
                used = False
                for part in range(PARTS):
                    for axis in range(3):
                        used = used or (group[part] == leader and fluxes[part, number, axis] != 0.0)
                if used:
                    columns[end - begin], nodes[end] = number, felt[number]
                    end += 1
            place = gradient_start[patches]
            if place + PARTS * 3 * (end - begin) > len(gradients):
                gradients = np.concatenate((gradients, np.empty(len(gradients) + PARTS * 3 * many)))
            for part in range(PARTS):
                if group[part] == leader:
                    volume[parts] = edge[0] * edge[1] * edge[2] / PARTS
                    keeper[parts] = _nearest(cloud, middles[part], felt[:count], edge)
                    parts += 1
            for number in range(end - begin):
                for part in range(PARTS):
                    if group[part] == leader:
                        for axis in range(3):
                            gradients[place] = fluxes[part, columns[number], axis]
                            place += 1
            layer[patches] = cloud.slab_layer[k]
            patches += 1
            node_start[patches], part_start[patches], gradient_start[patches] = end, parts, place
    return (
        node_start[: patches + 1].copy(),
        nodes[: node_start[patches]].copy(),
        part_start[: patches + 1].copy(),
        volume,
        gradient_start[: patches + 1].copy(),
        gradients[: gradient_start[patches]].copy(),
        layer[:patches].copy(),
        keeper,
    )


@njit(cache=True, nogil=True)
def _fluxes(
    cloud: Cloud, middle: FloatArray, edge: FloatArray, felt: IntArray, here: FloatArray, fluxes: FloatArray
) -> None:  # pragma: no cover - compiled
    """Write B of a part, shape (nodes, 3): the difference of N across it over its edge."""
    for axis in range(3):
        for number in range(len(felt)):
            fluxes[number, axis] = 0.0
        for side in (-1.0, 1.0):
            face, behind = middle.copy(), middle.copy()
            face[axis] += 0.25 * side * edge[axis]
            behind[axis] += 0.25 * side * _BEYOND * edge[axis]
            seen_from = face
            if len(cloud.cuts) > 0 and hidden(cloud.cuts, middle, behind):
                seen_from = middle
            shape_functions(cloud, face, seen_from, felt, edge, here)
            for number in range(len(felt)):
                fluxes[number, axis] += side * here[number] / (0.5 * edge[axis])


@njit(cache=True, nogil=True)
def _spread(fluxes: FloatArray) -> None:  # pragma: no cover - compiled
    """Take what varies over a cell from the middles of its parts to the Gauss points."""
    for axis in range(3):
        for part in range(PARTS):
            if part >> axis & 1:
                continue
            other = part | 1 << axis
            for number in range(fluxes.shape[1]):
                for k in range(3):
                    low, high = fluxes[part, number, k], fluxes[other, number, k]
                    fluxes[part, number, k] = 0.5 * (low + high) - 0.5 * TO_GAUSS * (high - low)
                    fluxes[other, number, k] = 0.5 * (low + high) + 0.5 * TO_GAUSS * (high - low)


@njit(cache=True, nogil=True)
def _sort(cuts: FloatArray, middles: FloatArray, group: IntArray) -> None:  # pragma: no cover - compiled
    """Write for each part the first of those that it sees, through others if need be."""
    for part in range(PARTS):
        group[part] = part if len(cuts) else 0
    if len(cuts) == 0:
        return
    for _ in range(3):  # a way along the edges of a cube takes three steps at most
        for part in range(PARTS):
            for axis in range(3):
                other = part ^ (1 << axis)
                if group[other] < group[part] and not hidden(cuts, middles[part], middles[other]):
                    group[part] = group[other]


@njit(cache=True, nogil=True)
def _nearest(
    cloud: Cloud, middle: FloatArray, felt: IntArray, edge: FloatArray
) -> int:  # pragma: no cover - compiled
    """Return the nearest node that a part sees, measured in edges; -1 where it sees none."""
    nearest, least = -1, np.inf
    for node in felt:
        square = 0.0
        for k in range(3):
            square += ((cloud.places[node, k] - middle[k]) / edge[k]) ** 2
        if square < least and not hidden(cloud.cuts, middle, cloud.seen_at[node]):
            nearest, least = node, square
    return nearest
