"""Stiffness, prestress stiffness, damping and mass of bricks.

With R[k, l] = integral of dN_a/dxi_k dN_b/dxi_l over the reference brick and edges h, the integral over an
element is G_kl = R[k, l] V / (h_k h_l), V = h_x h_y h_z. In these

    K_ij = lambda G_ij + mu G_ji + delta_ij sum over k of (mu + sigma_k) G_kk

(Hughes 1987, The Finite Element Method, sec. 2.7; for the prestress sigma_k, Zienkiewicz and Taylor 2000,
vol. 2, the initial-stress matrix of small displacements upon a stressed state). Volume uses the reduced
2 x 2 x 2 rule, without which the element locks near incompressibility. With the rest reduced too, as is common,
some element modes have no energy, and under a flat tool they wrinkle a thin top layer by 0.3 % of its deflection in
the pattern of the mesh; with the rest exact (Malkus and Hughes 1978, Comput. Methods Appl. Mech. Eng. 15:63) a stiff
dermis on soft fat bends 1 % too little on the default mesh. A tenth of the exact part stops the wrinkles and costs a
tenth of the stiffening: stabilised reduced integration (Belytschko et al. 1984, ibid. 43:251).
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from trocar.model import FloatArray
from trocar.reference.mesh import EXACT_ORDER, REDUCED_ORDER, Bricks, shape_functions
from trocar.tissues import Layer

STABILISATION = 0.1
"""Share of exact integration in all but the volume [1]."""


def stiffness(bricks: Bricks, layers: tuple[Layer, ...]) -> sp.csr_array:
    """Return the stiffness [N/m] of the layers, prestress included, shape (3 nodes, 3 nodes)."""
    return _elastic(
        bricks,
        np.array([layer.lame_lambda for layer in layers]),
        np.array([layer.shear_modulus for layer in layers]),
        np.array([(layer.prestress_x, layer.prestress_y, 0.0) for layer in layers]),
    )


def damping(bricks: Bricks, layers: tuple[Layer, ...]) -> sp.csr_array:
    """Return the Kelvin-Voigt damping [N s/m]: each layer's elastic stiffness times its retardation time."""
    return _weighted(bricks, layers, np.array([layer.retardation_time for layer in layers]))


def branch(bricks: Bricks, layers: tuple[Layer, ...], time: float) -> sp.csr_array:
    """Return each layer's elastic stiffness [N/m] times its weight of a relaxation time [s]."""
    return _weighted(bricks, layers, np.array([layer.relaxing(time) for layer in layers]))


def _weighted(bricks: Bricks, layers: tuple[Layer, ...], weights: FloatArray) -> sp.csr_array:
    return _elastic(
        bricks,
        weights * np.array([layer.lame_lambda for layer in layers]),
        weights * np.array([layer.shear_modulus for layer in layers]),
        np.zeros((len(layers), 3)),
    )


def mass(bricks: Bricks, layers: tuple[Layer, ...]) -> sp.csr_array:
    """Return the consistent mass [kg] of the layers, shape (3 nodes, 3 nodes)."""
    points, weights = bricks.gauss_rule(EXACT_ORDER)
    values = shape_functions(points)[0]
    reference = np.einsum("aq,bq,q->ab", values, values, weights).ravel()
    density = np.array([layer.density for layer in layers])[bricks.element_layer]
    scalar = _scatter(bricks, np.outer(density * bricks.edges.prod(axis=0), reference))
    return sp.csr_array(sp.block_diag([scalar] * 3, format="csr"))


def _elastic(bricks: Bricks, lame: FloatArray, shear: FloatArray, tension: FloatArray) -> sp.csr_array:
    reduced, exact = (_reference_stiffness(bricks, order) for order in (REDUCED_ORDER, EXACT_ORDER))
    shearing = STABILISATION * exact + (1.0 - STABILISATION) * reduced
    volume = bricks.edges.prod(axis=0)
    lam, mu, sigma = (values[bricks.element_layer] for values in (lame, shear, tension))

    def block(i: int, j: int) -> sp.csr_array:
        scale = volume / (bricks.edges[i] * bricks.edges[j])
        entries = np.outer(lam * scale, reduced[i, j]) + np.outer(mu * scale, shearing[j, i])
        if i == j:
            for k in range(3):
                entries += np.outer((mu + sigma[:, k]) * volume / bricks.edges[k] ** 2, shearing[k, k])
        return _scatter(bricks, entries)

    upper = {(i, j): block(i, j) for i in range(3) for j in range(i, 3)}
    rows = [[upper[i, j] if i <= j else upper[j, i].T for j in range(3)] for i in range(3)]
    return sp.csr_array(sp.block_array(rows, format="csr"))


def _reference_stiffness(bricks: Bricks, order: int) -> FloatArray:
    points, weights = bricks.gauss_rule(order)
    gradients = shape_functions(points)[1]
    products: FloatArray = np.einsum("akq,blq,q->klab", gradients, gradients, weights)
    return products.reshape(3, 3, -1)


def _scatter(bricks: Bricks, entries: FloatArray) -> sp.csr_array:
    nodes, count = bricks.element_nodes.astype(np.int32), bricks.nodes.shape[1]
    row = np.repeat(nodes.T, 20, axis=1).ravel()
    column = np.tile(nodes.T, (1, 20)).ravel()
    return sp.coo_array((entries.ravel(), (row, column)), shape=(count, count)).tocsr()
