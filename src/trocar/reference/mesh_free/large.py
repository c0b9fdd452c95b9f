"""Equilibria of neo-Hookean layers: the discrete equations of `stress`, by Newton's method in steps of the load."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from trocar.errors import SolverError
from trocar.model import FloatArray
from trocar.reference.hyperelastic import Material, nominal_moduli
from trocar.reference.mesh_free.body import Body
from trocar.reference.mesh_free.stress import slopes_of
from trocar.reference.newton import TOLERANCE, Directions, NewtonError, balance

_FIRST_STEP = 0.1  # of the block's thickness, the linear deflection under the first step of the load
_GROWTH = 1.6  # of a step after one that was taken
_ON_THE_WAY = 1e-4  # of the load, the imbalance left in the steps that lead to it
_SMALLEST_STEP = 1e-3  # of the load: where smaller ones would be needed, no equilibrium is near


class Balance:
    """Internal against external forces: a system of `Equations`.

    Args:
        body: what is loaded.
        force: of the free unknowns [N], shape (n,).
    """

    def __init__(self, body: Body, force: FloatArray) -> None:
        self._body, self._force = body, force

    def imbalance(self, unknowns: FloatArray) -> FloatArray:
        """Return internal less external forces [N].

        Raises:
            InversionError: tissue turned inside out.
        """
        field = self._body.spread(unknowns)
        internal = self._body.internal(field, np.zeros_like(field))
        return np.asarray(internal.ravel()[self._body.free] - self._force)

    def tangent(self, unknowns: FloatArray) -> sp.csr_array:
        """Return the tangent stiffness [N/m]."""
        body, patches = self._body, self._body.patches
        gradient = slopes_of(patches, body.spread(unknowns)) + np.eye(3)
        jacobian = np.linalg.det(gradient)
        inverse = np.linalg.inv(gradient)
        counts = np.diff(patches.part_start)
        weight = np.add.reduceat(patches.volume, patches.part_start[:-1])
        grown = np.add.reduceat(patches.volume * (jacobian - 1.0), patches.part_start[:-1]) / weight
        moduli = np.empty((len(gradient), 9, 9))
        for number, layer in enumerate(body.tissue.layers):
            here = np.repeat(patches.layer == number, counts)
            material = Material(
                law=layer.law,
                shear_modulus=layer.shear_modulus,
                isochoric_share=1.0,
                bulk_modulus=2 / 3 * layer.shear_modulus,
                prestress=(layer.prestress_x, layer.prestress_y),
            )
            stress, rates = material.second_piola(gradient[here], tangent=True)
            assert rates is not None
            moduli[here] = nominal_moduli(gradient[here], stress, rates)
        pressure = np.repeat(body.laws.lame[patches.layer] * grown, counts) * jacobian
        back = inverse.transpose(0, 2, 1)  # F^-T_iJ
        turned = np.einsum("nij,nkl->nijkl", back, back) - np.einsum("nil,nkj->nijkl", back, back)
        moduli += (pressure[:, None, None, None, None] * turned).reshape(-1, 9, 9)
        matrix = body.pattern.matrix(moduli, jacobian[:, None, None] * back, body.laws.lame)
        return body.freed(matrix)


def equilibrium(body: Body, force: FloatArray) -> FloatArray:
    """Return the displacement [m], shape (nodes, 3), under nodal forces [N], shape (nodes, 3).

    Raises:
        SolverError: the load was not reached; it says how far.
    """
    whole = force.ravel()[body.free]
    norm = float(np.linalg.norm(whole))
    if norm == 0.0:
        return np.zeros_like(force)
    directions = Directions(body.solver, body.factors)
    linear = float(np.abs(body.factors.solve(whole)).max())
    reached, unknowns = 0.0, np.zeros_like(whole)
    step = min(1.0, _FIRST_STEP * body.tissue.thickness / linear)
    smallest = _SMALLEST_STEP * step
    while reached < 1.0:
        aim = 1.0 if reached + 1.001 * step >= 1.0 else reached + step
        tolerance = TOLERANCE if aim == 1.0 else _ON_THE_WAY
        try:
            found = balance(
                Balance(body, aim * whole),
                unknowns,
                scale=aim * norm,
                tolerance=tolerance,
                directions=directions,
            )
        except NewtonError as error:
            step = 0.5 * (aim - reached)
            if step < smallest:
                raise SolverError(
                    f"mesh-free: reached {100 * reached:.3g} % of the load and no more: {error.reason}; "
                    "take less force or a wider tool"
                ) from error
            continue
        step, reached, unknowns = _GROWTH * (aim - reached), aim, found.unknowns
    return body.spread(unknowns)
