"""A nodule in a mesh: elements within an ellipsoid become another material."""

from __future__ import annotations

from dataclasses import replace
from math import isfinite

import numpy as np

from trocar.errors import InputError
from trocar.model import FloatArray
from trocar.tissues.layer import Layer
from trocar.waves.mesh.solid_mesh import SolidMesh, shown, volumes_of

_STEPS = 6  # samples along an edge of an element
_FEWEST = 8  # elements: of fewer, nothing of its shape is left


def with_inclusion(
    mesh: SolidMesh, centre: tuple[float, float, float], radii: tuple[float, float, float], layer: Layer
) -> SolidMesh:
    """Return a mesh some of whose elements have another material.

    Whole elements change: those most of which lies within the ellipsoid, as many as have its volume. What is left
    is the steps of its surface; `bench/shapes.py` says how much they matter.

    Args:
        mesh: of the tissue around it.
        centre: of the ellipsoid [m]; the mesh's highest point has z = 0.
        radii: along x, y and z [m].
        layer: its material.

    Raises:
        InputError: it is beside the mesh, or so small that fewer than eight elements have its volume.
    """
    if not all(isfinite(r) and r > 0 for r in radii):
        raise InputError("inclusion: radii", "three lengths above 0 [m]", radii)
    if not all(map(isfinite, centre)):
        raise InputError("inclusion: centre", "a place [m]", centre)
    volume = np.abs(volumes_of(mesh.corners, mesh.cells))
    share = _shares(mesh.corners[mesh.cells], np.asarray(centre), np.asarray(radii))
    total = float(share @ volume)
    low, high = mesh.corners.min(axis=0), mesh.corners.max(axis=0)
    if total == 0 and not ((low < centre) & (centre < high)).all():
        raise InputError(
            "inclusion: centre",
            f"one inside the mesh, which lies between {shown(low)} and {shown(high)}",
            shown(np.asarray(centre)),
        )
    order = np.argsort(-share, kind="stable")
    order = order[share[order] > 0]
    filled = np.cumsum(volume[order])
    count = int(np.argmin(np.abs(filled - total))) + 1 if len(order) else 0
    if count < _FEWEST:
        raise InputError(
            "inclusion: radii",
            f"an ellipsoid as large as {_FEWEST} elements at least",
            f"one as large as {count}",
            "make the elements there smaller",
        )
    region = mesh.region.copy()
    region[order[:count]] = len(mesh.materials)
    return replace(mesh, region=region, materials=(*mesh.materials, layer))


def _shares(places: FloatArray, centre: FloatArray, radii: FloatArray) -> FloatArray:
    """Return the share of each element within the ellipsoid, shape (m,), from samples of those that may touch it.

    Args:
        places: corners of the elements [m], shape (m, 4, 3) or (m, 8, 3).
        centre: shape (3,).
        radii: shape (3,).
    """
    low, high = places.min(axis=1), places.max(axis=1)
    near = np.flatnonzero(((high > centre - radii) & (low < centre + radii)).all(axis=1))
    weights = _samples(places.shape[1])
    share = np.zeros(len(places))
    scaled = (places[near] - centre) / radii
    points = np.einsum("sk,mkc->msc", weights, scaled)
    share[near] = (np.einsum("msc,msc->ms", points, points) < 1).mean(axis=1)
    return share


def _samples(corners: int) -> FloatArray:
    """Return shape functions of an element's corners at places spread evenly in it, shape (s, 4) or (s, 8)."""
    t = (np.arange(_STEPS) + 0.5) / _STEPS
    x, y, z = (grid.ravel() for grid in np.meshgrid(t, t, t, indexing="ij"))
    if corners == 4:
        inside = x + y + z < 1
        x, y, z = x[inside], y[inside], z[inside]
        return np.stack([1 - x - y - z, x, y, z], axis=1)
    ring = ((0, 0), (1, 0), (1, 1), (0, 1))
    each = [(x if i else 1 - x) * (y if j else 1 - y) * (z if k else 1 - z) for k in (0, 1) for i, j in ring]
    return np.stack(each, axis=1)
