"""Integrals over a surface of a mesh: points with areas and normals, and the elements' shape functions there."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from trocar.model import FloatArray
from trocar.waves.mesh.elements import Elements

_ORDER = 10  # of polynomials integrated exactly: 25 points on a triangle


@dataclass(frozen=True, eq=False)
class SurfaceRule:
    """Say where to take values on a surface, and what each counts for.

    Attributes:
        places: [m], shape (q, 3).
        normals: outward, of length 1, shape (q, 3).
        areas: [m^2], shape (q,).
        shapes: of every node at each place [1], shape (q, nodes).
    """

    places: FloatArray
    normals: FloatArray
    areas: FloatArray
    shapes: sp.csr_array


def surface_rule(elements: Elements, surface: str) -> SurfaceRule:
    """Return a rule for integrals over a surface of a mesh.

    Args:
        elements: of the mesh.
        surface: its name.
    """
    basis = elements.facets(surface, _ORDER)
    areas = np.asarray(basis.dx, dtype=np.float64)
    count = areas.size
    values = np.stack(
        [np.broadcast_to(np.asarray(one[0]), areas.shape).ravel() for one in basis.basis], axis=1
    )
    nodes = np.repeat(basis.element_dofs.T, areas.shape[1], axis=0)
    begins = np.arange(0, values.size + 1, values.shape[1])
    return SurfaceRule(
        places=np.asarray(basis.global_coordinates()).reshape(3, count).T,
        normals=np.asarray(basis.normals).reshape(3, count).T,
        areas=areas.ravel(),
        shapes=sp.csr_array((values.ravel(), nodes.ravel(), begins), shape=(count, elements.nodes.shape[1])),
    )
