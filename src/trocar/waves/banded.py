"""Static response of thin layers to forces on the top face, compiled: one banded factorisation per wavenumber.

The matrices couple three neighbouring nodes, so a lower Cholesky factor has at most 3 c - 1 entries beside the
diagonal. Forces act on the last c unknowns (the top face), which leaves the forward substitution trivial.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numba import njit

from trocar.errors import SolverError
from trocar.model import FloatArray
from trocar.waves.thin_layer import ThinLayers, Wavenumbers


def surface_compliance(layers: ThinLayers, at: Wavenumbers, nodes: Sequence[int] | None = None) -> FloatArray:
    """Return the amplitude of every face per unit amplitude of traction on the top face [m/Pa].

    Args:
        layers: matrices through the thickness, c components a node.
        at: J wavenumbers.
        nodes: numbers, from the base up, of those to be told instead of the layers' upper faces.

    Returns:
        Shape (J, faces, c, c): face, component of displacement, component of traction.

    Raises:
        SolverError: a stiffness matrix is not positive definite.
    """
    constant, linear, quadratic, taut_x, taut_y = (
        _banded(part, layers.components) for part in _parts(layers)
    )
    faces = np.array(layers.faces if nodes is None else nodes)
    result = np.empty((len(at.k), len(faces), layers.components, layers.components))
    if not _solve(constant, linear, quadratic, taut_x, taut_y, at.k, at.kx2, at.ky2, faces, result):
        raise SolverError(
            "layered tissue: expected a positive definite stiffness; check moduli, thicknesses and support"
        )
    return result


def _parts(layers: ThinLayers) -> tuple[FloatArray, ...]:
    return (
        layers.constant.sum(0),
        layers.linear.sum(0),
        layers.quadratic.sum(0),
        layers.prestress_x,
        layers.prestress_y,
    )


def _banded(matrix: FloatArray, components: int) -> FloatArray:
    """Return the lower band: row i holds matrix[i, i - w .. i] with w = 3 c - 1."""
    width = 3 * components - 1
    band = np.zeros((len(matrix), width + 1))
    for offset in range(width + 1):
        band[offset:, width - offset] = np.diagonal(matrix, -offset)
    return band


@njit(cache=True)
def _solve(
    constant: FloatArray,
    linear: FloatArray,
    quadratic: FloatArray,
    prestress_x: FloatArray,
    prestress_y: FloatArray,
    k: FloatArray,
    kx2: FloatArray,
    ky2: FloatArray,
    faces: FloatArray,
    result: FloatArray,
) -> bool:  # pragma: no cover - compiled
    size, columns = constant.shape
    width = columns - 1
    components = result.shape[2]
    lower = np.empty((size, columns))
    answer = np.empty(size)
    for j in range(len(k)):
        for i in range(size):
            for p in range(max(0, width - i), columns):
                column = i - width + p
                total = (
                    constant[i, p]
                    + k[j] * (linear[i, p] + k[j] * quadratic[i, p])
                    + kx2[j] * prestress_x[i, p]
                    + ky2[j] * prestress_y[i, p]
                )
                for q in range(max(0, i - width, column - width), column):
                    total -= lower[i, q - i + width] * lower[column, q - column + width]
                if p < width:
                    lower[i, p] = total / lower[column, width]
                elif total > 0:
                    lower[i, p] = np.sqrt(total)
                else:
                    return False
        for source in range(components):
            first = size - components + source
            for i in range(size):
                answer[i] = 0.0
            for i in range(first, size):  # forward: only the top face is loaded
                total = 1.0 if i == first else 0.0
                for q in range(first, i):
                    total -= lower[i, q - i + width] * answer[q]
                answer[i] = total / lower[i, width]
            for i in range(size - 1, -1, -1):
                total = answer[i]
                for q in range(i + 1, min(size, i + columns)):
                    total -= lower[q, i - q + width] * answer[q]
                answer[i] = total / lower[i, width]
            for f in range(len(faces)):
                for component in range(components):
                    result[j, f, component, source] = answer[faces[f] * components + component]
    return True
