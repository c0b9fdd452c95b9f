"""Matrices of patches: what moduli at their parts and a bulk modulus over them make of the smoothed gradients.

With V a part's volume, A its moduli but for lambda and C = dJ/dF, at rest the unit tensor, a patch of volume W adds

    K_ab = sum over parts of V B_a A B_b  +  lambda / W q_a q_b,    q_a = sum over parts of V C B_a

between its nodes a and b. At rest A = mu (delta_ik delta_JL + delta_iL delta_Jk) + delta_ik sigma_JL with sigma the
prestress. That lambda is averaged and not all of the bulk modulus lambda + 2 mu / 3 is as in the finite elements
(`reference.assembly`): where one cell makes up a layer and bends, the strain across it that Poisson's ratio asks for is
missing, and 2 mu in place of E / (1 - nu^2) is 4 % too stiff where the other would be 30 % too soft.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import scipy.sparse as sp
from numba import njit

from trocar.model import FloatArray
from trocar.reference.grid import IntArray
from trocar.reference.mesh_free.patches import Patches
from trocar.tissues import Layer


class Pattern:
    """Which nodes meet in a patch; matrices are blocks of 3 x 3 on it.

    Args:
        patches: the quadrature.
        nodes: how many there are.
    """

    def __init__(self, patches: Patches, nodes: int) -> None:
        self._patches = patches
        count = len(patches.layer)
        ones = np.ones(len(patches.nodes), dtype=np.int32)
        meets = sp.csr_array((ones, patches.nodes, patches.node_start), shape=(count, nodes))
        self.graph = sp.csr_array(meets.T @ meets)
        self.graph.sort_indices()

    def matrix(self, moduli: FloatArray, volume_change: FloatArray, lame: FloatArray) -> sp.csr_array:
        """Return the matrix, shape (3 nodes, 3 nodes), component i of node n in row 3 n + i.

        Args:
            moduli: A, shape (parts, 9, 9) or (layers, 9, 9), its indices iJ and kL.
            volume_change: C, shape (parts, 3, 3) or (1, 3, 3).
            lame: lambda of each layer, shape (layers,).
        """
        graph = self.graph
        data = np.zeros((len(graph.indices), 3, 3))
        indices, starts = graph.indices.astype(np.int64), graph.indptr.astype(np.int64)
        _assemble(self._patches, moduli, volume_change, lame, indices, starts, data)
        size = 3 * graph.shape[0]
        blocks = sp.bsr_array((data, graph.indices, graph.indptr), shape=(size, size))
        return sp.csr_array(blocks.tocsr())


def moduli_at_rest(layers: Sequence[Layer], weights: FloatArray, *, prestress: bool) -> FloatArray:
    """Return A at rest of each layer times its weight, shape (layers, 9, 9); prestress is not weighted."""
    unit = np.eye(3)
    shearing = np.einsum("ik,jl->ijkl", unit, unit) + np.einsum("il,jk->ijkl", unit, unit)
    result = []
    for layer, weight in zip(layers, weights, strict=True):
        moduli = weight * layer.shear_modulus * shearing
        if prestress:
            tension = np.diag([layer.prestress_x, layer.prestress_y, 0.0])
            moduli = moduli + np.einsum("ik,jl->ijkl", unit, tension)
        result.append(moduli.reshape(9, 9))
    return np.array(result)


def lumped_mass(patches: Patches, layers: Sequence[Layer], nodes: int) -> FloatArray:
    """Return the mass of each node [kg], shape (nodes,): of the parts of cells that are nearest to it.

    Total and linear momentum are exact, and no mass is negative, as the sums of rows of a consistent matrix may be.
    """
    density = np.array([layer.density for layer in layers])
    parts = density[np.repeat(patches.layer, np.diff(patches.part_start))] * patches.volume
    return np.asarray(np.bincount(patches.keeper, parts, minlength=nodes), dtype=np.float64)


@njit(cache=True, nogil=True)
def _assemble(
    patches: Patches,
    moduli: FloatArray,
    volume_change: FloatArray,
    lame: FloatArray,
    indices: IntArray,
    starts: IntArray,
    data: FloatArray,
) -> None:  # pragma: no cover - compiled
    each_part, changing = len(moduli) == len(patches.volume), len(volume_change) > 1
    for patch in range(len(patches.layer)):
        first, last = patches.node_start[patch], patches.node_start[patch + 1]
        nodes = patches.nodes[first:last]
        count, layer = last - first, patches.layer[patch]
        block, squeezed = np.zeros((count, count, 3, 3)), np.zeros((count, 3))
        stressed = np.empty((9, 3))
        parts = patches.part_start[patch + 1] - patches.part_start[patch]
        place, total = patches.gradient_start[patch], 0.0
        gradients = patches.gradients[place : patches.gradient_start[patch + 1]].reshape(count, parts, 3)
        for part in range(patches.part_start[patch], patches.part_start[patch + 1]):
            slopes = gradients[:, part - patches.part_start[patch]]
            volume = patches.volume[part]
            total += volume
            here = moduli[part] if each_part else moduli[layer]
            change = volume_change[part] if changing else volume_change[0]
            for b in range(count):
                if slopes[b, 0] == 0.0 and slopes[b, 1] == 0.0 and slopes[b, 2] == 0.0:
                    continue
                for i in range(3):
                    for m in range(3):
                        squeezed[b, i] += volume * change[i, m] * slopes[b, m]
                for row in range(9):
                    for k in range(3):
                        stressed[row, k] = volume * (
                            here[row, 3 * k] * slopes[b, 0]
                            + here[row, 3 * k + 1] * slopes[b, 1]
                            + here[row, 3 * k + 2] * slopes[b, 2]
                        )
                for a in range(count):
                    for i in range(3):
                        for k in range(3):
                            block[a, b, i, k] += (
                                slopes[a, 0] * stressed[3 * i, k]
                                + slopes[a, 1] * stressed[3 * i + 1, k]
                                + slopes[a, 2] * stressed[3 * i + 2, k]
                            )
        for a in range(count):
            row = nodes[a]
            columns = indices[starts[row] : starts[row + 1]]
            for b in range(count):
                entry = starts[row] + np.searchsorted(columns, nodes[b])
                for i in range(3):
                    for k in range(3):
                        data[entry, i, k] += block[a, b, i, k] + (
                            lame[layer] / total * squeezed[a, i] * squeezed[b, k]
                        )
