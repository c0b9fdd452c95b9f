"""Stress of the hyperelastic laws under even stretch along the axes, in closed form.

With e_a = ln l_a, W a function of the isochoric e'_a = e_a - (e_1 + e_2 + e_3)/3 and J = l_1 l_2 l_3, the principal
Kirchhoff stresses are

    tau_a = dev(dW_iso/de')_a + K (J - 1) J,

and the nominal ones P_a = tau_a / l_a (R. W. Ogden 1984, Non-linear Elastic Deformations, sec. 4.3). An incompressible
material has J = 1 and any pressure; a face without load along z settles it. Axes: x along a strip and halfway between
the two families of a fibre law, y across, z through the thickness.
"""

from __future__ import annotations

from math import cos, sin

import numpy as np

from trocar.errors import SolverError
from trocar.model import FloatArray
from trocar.tissues.law import Fibre, Law, Linear, Ogden

_MOST_ITERATIONS = 60
_BALANCED = 1e-12  # of the stresses and moduli, what may be left across: their rounding
_LARGEST_CHANGE = 0.2  # of ln l in an iteration


def nominal_stress(law: Law, shear_modulus: float, stretches: FloatArray, bulk_modulus: float) -> FloatArray:
    """Return P [Pa] along the axes, shape (n, 3).

    Args:
        law: any but the linear one.
        shear_modulus: mu [Pa].
        stretches: along the axes [1], shape (n, 3).
        bulk_modulus: K [Pa].
    """
    tau, _ = _kirchhoff(law, shear_modulus, np.log(stretches), bulk_modulus)
    return np.asarray(tau / stretches)


def biaxial(law: Law, shear_modulus: float, stretches: FloatArray) -> FloatArray:
    """Return the nominal stress along x and y [Pa] of an incompressible sheet, shape (n, 2).

    Args:
        law: any but the linear one.
        shear_modulus: mu [Pa].
        stretches: along x and y [1], shape (n, 2).
    """
    logs = np.column_stack([np.log(stretches), -np.log(stretches).sum(axis=1)])
    tau, _ = _kirchhoff(law, shear_modulus, logs, 0.0)
    return np.asarray((tau[:, :2] - tau[:, 2:]) / stretches)


def equibiaxial(law: Law, shear_modulus: float, stretch: FloatArray) -> FloatArray:
    """Return the nominal stress along x [Pa] of an incompressible sheet stretched alike along x and y, shape (n,)."""
    return biaxial(law, shear_modulus, np.column_stack([stretch, stretch]))[:, 0]


def uniaxial(
    law: Law, shear_modulus: float, stretch: FloatArray, bulk_modulus: float | None = None
) -> FloatArray:
    """Return the nominal stress along x [Pa], y and z free, shape (n,).

    Args:
        law: any but the linear one.
        shear_modulus: mu [Pa].
        stretch: along x [1], shape (n,).
        bulk_modulus: K [Pa]; None where the material is incompressible.

    Raises:
        SolverError: no stretches across were found for which nothing pulls there.
    """
    logs = np.log(stretch)[:, None] * np.array([1.0, -0.5, -0.5])
    bulk = 0.0 if bulk_modulus is None else bulk_modulus
    # Without volume change one number is free, how much more y gives way than z; with it both are.
    ways = np.array([[0.0, 1.0, -1.0]]) if bulk_modulus is None else np.eye(3)[1:]
    left = np.zeros((len(logs), len(ways)))
    for _ in range(_MOST_ITERATIONS):
        tau, slope = _kirchhoff(law, shear_modulus, logs, bulk)
        left = tau @ ways.T
        size = np.abs(tau).max(axis=1) + shear_modulus + bulk
        if (np.abs(left) <= _BALANCED * size[:, None]).all():
            along = tau[:, 0] - (tau[:, 2] if bulk_modulus is None else 0.0)
            return np.asarray(along / stretch)
        change = -np.linalg.solve(ways @ slope @ ways.T, left[..., None])[..., 0]
        logs = logs + np.clip(change, -_LARGEST_CHANGE, _LARGEST_CHANGE) @ ways
    raise SolverError(
        f"uniaxial stretch {stretch[np.argmax(np.abs(left).max(axis=1))]:.4g}: no state found in which nothing pulls "
        "across; take smaller stretches or a law that stiffens less"
    )


def _kirchhoff(law: Law, mu: float, logs: FloatArray, bulk: float) -> tuple[FloatArray, FloatArray]:
    """Return tau [Pa], shape (n, 3), and its derivative by ln l, shape (n, 3, 3)."""
    total = logs.sum(axis=1)
    isochoric = logs - total[:, None] / 3
    free, slope = _free(law, mu, isochoric)
    project = np.eye(3) - 1 / 3
    volume = np.exp(total)
    tau = free @ project + (bulk * (volume - 1) * volume)[:, None]
    spread = bulk * (2 * volume - 1) * volume
    return np.asarray(tau), np.asarray(project @ slope @ project + spread[:, None, None])


def _free(law: Law, mu: float, logs: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return dW_iso/de' [Pa], shape (n, 3), and its derivative, shape (n, 3, 3)."""
    assert not isinstance(law, Linear), "a linear law has no such energy"
    if isinstance(law, Ogden):
        terms = [(2 * share * mu / alpha, alpha) for share, alpha in law.terms]
        free = sum(weight * np.exp(alpha * logs) for weight, alpha in terms)
        grown = sum(weight * alpha * np.exp(alpha * logs) for weight, alpha in terms)
        return np.asarray(free), np.asarray(grown)[:, :, None] * np.eye(3)
    squares = np.exp(2 * logs)
    free, slope = mu * squares, 2 * mu * squares[:, :, None] * np.eye(3)
    if isinstance(law, Fibre):  # mirror images about x share one strain under stretch along the axes
        along = np.array([cos(law.angle) ** 2, sin(law.angle) ** 2, 0.0])
        parts = (law.dispersion + (1 - 3 * law.dispersion) * along) * squares
        strain = np.maximum(parts.sum(axis=1) - 1.0, 0.0)
        pull = 4 * law.k1 * strain * np.exp(law.k2 * strain**2)
        steep = np.where(
            strain > 0, 8 * law.k1 * (1 + 2 * law.k2 * strain**2) * np.exp(law.k2 * strain**2), 0.0
        )
        free = free + pull[:, None] * parts
        slope = slope + 2 * (pull[:, None] * parts)[:, :, None] * np.eye(3)
        slope = slope + steep[:, None, None] * parts[:, :, None] * parts[:, None, :]
    return free, slope
