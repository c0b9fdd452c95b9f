"""Stress and tangent of the hyperelastic laws at points, all at once.

With C = F^T F, J = det F, C_bar = J^(-2/3) C and W = W_iso(C_bar) + K/2 (J - 1)^2, the second Piola-Kirchhoff stress
and its tangent are

    S = 2 dW/dC = S_iso + J p C^-1,    S_iso = J^(-2/3) Dev(2 dW_iso/dC_bar),    p = K (J - 1)

(G. A. Holzapfel 2000, Nonlinear Solid Mechanics, sec. 6.4 to 6.6), the first Piola-Kirchhoff stress and its tangent

    P = dW/dF = F S,    A_iJkL = dP_iJ/dF_kL = delta_ik S_JL + F_iM CC_MJNL F_kN.

Symmetric tensors are rows of six, 11 22 33 23 13 12; a tangent of them works on strains whose shears count twice.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, sin

import numpy as np

from trocar.model import FloatArray
from trocar.tissues.law import Fibre, Law, Ogden

ROW, COLUMN = np.array([0, 1, 2, 1, 0, 0]), np.array([0, 1, 2, 2, 2, 1])
_TWICE = np.array([1.0, 1.0, 1.0, 2.0, 2.0, 2.0])
_UNIT = np.array([1.0, 1.0, 1.0, 0.0, 0.0, 0.0])


@dataclass(frozen=True, kw_only=True)
class Material:
    """A law with its moduli.

    Args:
        law: W_iso, but for the linear one.
        shear_modulus: mu [Pa].
        isochoric_share: what W_iso and the prestress are multiplied by [1], a number or one for each point.
        bulk_modulus: K [Pa], a number or one for each point.
        prestress: second Piola-Kirchhoff stress at rest along x and y [Pa].
    """

    law: Law
    shear_modulus: float
    isochoric_share: FloatArray | float
    bulk_modulus: FloatArray | float
    prestress: tuple[float, float] = (0.0, 0.0)

    def energy(self, gradient: FloatArray) -> FloatArray:
        """Return W [J/m3], prestress included, shape (n,), for deformation gradients of shape (n, 3, 3)."""
        volume = np.linalg.det(gradient)
        stretch = gradient.transpose(0, 2, 1) @ gradient
        isochoric = _energy(self.law, self.shear_modulus, volume[:, None, None] ** (-2 / 3) * stretch)
        energy = self.isochoric_share * isochoric + 0.5 * self.bulk_modulus * (volume - 1.0) ** 2
        for axis, tension in enumerate(self.prestress):
            energy += 0.5 * self.isochoric_share * tension * (stretch[:, axis, axis] - 1.0)
        return np.asarray(energy)

    def second_piola(self, gradient: FloatArray, *, tangent: bool) -> tuple[FloatArray, FloatArray | None]:
        """Return S [Pa], shape (n, 6), and 2 dS/dC [Pa], shape (n, 6, 6), prestress included.

        Args:
            gradient: F [1], shape (n, 3, 3), each of positive determinant.
            tangent: whether the tangent is wanted; else it is None.
        """
        volume = np.linalg.det(gradient)
        stretch = gradient.transpose(0, 2, 1) @ gradient
        scale = volume ** (-2 / 3)
        fictive, change = _fictive(
            self.law, self.shear_modulus, scale[:, None, None] * stretch, tangent=tangent
        )
        fictive *= scale[:, None]
        inverse = np.linalg.inv(stretch)
        flat, back = stretch[:, ROW, COLUMN] * _TWICE, inverse[:, ROW, COLUMN]
        mean = np.einsum("ni,ni->n", fictive, flat) / 3
        isochoric = fictive - mean[:, None] * back
        share = np.broadcast_to(np.asarray(self.isochoric_share), volume.shape)
        pressure = self.bulk_modulus * (volume - 1.0)
        stress = share[:, None] * isochoric + (volume * pressure)[:, None] * back
        stress[:, 0] += self.isochoric_share * self.prestress[0]
        stress[:, 1] += self.isochoric_share * self.prestress[1]
        if not tangent:
            return stress, None
        outer = back[:, :, None] * back[:, None, :]
        mixed = 0.5 * (
            inverse[:, ROW[:, None], ROW] * inverse[:, COLUMN[:, None], COLUMN]
            + inverse[:, ROW[:, None], COLUMN] * inverse[:, COLUMN[:, None], ROW]
        )
        crossed = (2 / 3) * isochoric  # times C^-1, on either side
        outward = -2 * mean / 3
        moduli = np.zeros_like(outer)
        if change is not None:
            change *= (scale**2)[:, None, None]
            row = np.einsum("nij,nj->ni", change, flat)
            crossed = crossed + row / 3
            outward = outward + np.einsum("ni,ni->n", row, flat) / 9
            moduli = share[:, None, None] * change
        cross = (share[:, None] * crossed)[:, :, None] * back[:, None, :]
        moduli -= cross + cross.transpose(0, 2, 1)
        moduli += (share * outward + volume * (pressure + self.bulk_modulus * volume))[:, None, None] * outer
        moduli += 2 * (share * mean - volume * pressure)[:, None, None] * mixed
        return stress, moduli


def first_piola(gradient: FloatArray, stress: FloatArray) -> FloatArray:
    """Return P = F S [Pa], shape (n, 3, 3), from S, shape (n, 6)."""
    return np.asarray(gradient @ as_matrix(stress))


def nominal_moduli(gradient: FloatArray, stress: FloatArray | None, moduli: FloatArray) -> FloatArray:
    """Return A [Pa], shape (n, 9, 9), its indices iJ and kL.

    Args:
        gradient: F, shape (n, 3, 3).
        stress: S [Pa], shape (n, 6); None leaves its part out.
        moduli: 2 dS/dC [Pa], shape (n, 6, 6).
    """
    count = len(gradient)
    strain = np.zeros((count, 6, 3, 3))  # of the six strains by F_kL
    for voigt, (row, column) in enumerate(zip(ROW, COLUMN, strict=True)):
        strain[:, voigt, :, row] += gradient[:, :, column]
        if row != column:
            strain[:, voigt, :, column] += gradient[:, :, row]
    flat = strain.reshape(count, 6, 9)
    result = flat.transpose(0, 2, 1) @ (moduli @ flat)
    if stress is not None:
        matrix = as_matrix(stress)
        for axis in range(3):
            result[:, 3 * axis : 3 * axis + 3, 3 * axis : 3 * axis + 3] += matrix
    return np.asarray(result)


def as_matrix(six: FloatArray) -> FloatArray:
    """Return symmetric tensors, shape (n, 3, 3), from rows of six."""
    matrices: FloatArray = six[:, np.array([[0, 5, 4], [5, 1, 3], [4, 3, 2]])]
    return matrices


def _energy(law: Law, mu: float, stretch: FloatArray) -> FloatArray:
    """Return W_iso [J/m3], shape (n,), at C_bar, shape (n, 3, 3)."""
    first = np.trace(stretch, axis1=1, axis2=2)
    if isinstance(law, Ogden):
        logs = 0.5 * np.log(np.linalg.eigvalsh(stretch))
        terms = (2 * share * mu / alpha**2 * np.expm1(alpha * logs).sum(axis=1) for share, alpha in law.terms)
        return np.asarray(sum(terms))
    energy = 0.5 * mu * (first - 3.0)
    if isinstance(law, Fibre):
        for structure in _structures(law):
            strain = _fibre_strain(structure, stretch)
            grown = np.expm1(law.k2 * strain**2) / law.k2 if law.k2 else strain**2
            energy = energy + 0.5 * law.k1 * grown
    return np.asarray(energy)


def _fictive(
    law: Law, mu: float, stretch: FloatArray, *, tangent: bool
) -> tuple[FloatArray, FloatArray | None]:
    """Return 2 dW_iso/dC_bar, shape (n, 6), and 4 d2W_iso/dC_bar2, shape (n, 6, 6), or None where that is zero."""
    if isinstance(law, Ogden):
        return _ogden(law, mu, stretch, tangent=tangent)
    stress = np.tile(mu * _UNIT, (len(stretch), 1))
    if not isinstance(law, Fibre):
        return stress, None
    change = np.zeros((len(stretch), 6, 6)) if tangent else None
    for structure in _structures(law):
        strain = _fibre_strain(structure, stretch)
        grown = law.k1 * np.exp(law.k2 * strain**2)
        stress += (2 * grown * strain)[:, None] * structure
        if change is not None:
            slope = np.where(strain > 0, 4 * grown * (1 + 2 * law.k2 * strain**2), 0.0)
            change += slope[:, None, None] * np.outer(structure, structure)
    return stress, change


def _structures(law: Fibre) -> tuple[FloatArray, ...]:
    """Return dispersion I + (1 - 3 dispersion) a x a of both families, rows of six."""
    found = []
    for sign in (1, -1):
        a = np.array([cos(law.angle), sign * sin(law.angle), 0.0])
        found.append(law.dispersion * _UNIT + (1 - 3 * law.dispersion) * np.outer(a, a)[ROW, COLUMN])
    return tuple(found)


def _fibre_strain(structure: FloatArray, stretch: FloatArray) -> FloatArray:
    return np.asarray(np.maximum(stretch[:, ROW, COLUMN] @ (structure * _TWICE) - 1.0, 0.0))


def _ogden(
    law: Ogden, mu: float, stretch: FloatArray, *, tangent: bool
) -> tuple[FloatArray, FloatArray | None]:
    """Return the same of an Ogden law, in the principal axes of C_bar.

    With s(c) = 2 dW/dc of the principal value c, the stress is sum s(c_a) n_a x n_a and its change in these axes
    [s(c_a) - s(c_b)] / (c_a - c_b) dC_ab (Daleckii and Krein), the derivative s' where both are equal.
    """
    values, axes = np.linalg.eigh(stretch)
    principal = np.zeros_like(values)
    for share, alpha in law.terms:
        principal += 2 * share * mu / alpha * values ** (alpha / 2 - 1)
    dyads = axes[:, ROW, :, None] * axes[:, COLUMN, None, :]
    dyads = 0.5 * (dyads + dyads.transpose(0, 1, 3, 2))  # (n, 6, a, b)
    stress = np.einsum("na,niaa->ni", principal, dyads)
    if not tangent:
        return stress, None
    change = np.zeros((len(stretch), 6, 6))
    for a in range(3):
        for b in range(a, 3):
            weight = np.zeros(len(stretch))
            for share, alpha in law.terms:
                slope = _divided(values[:, a], values[:, b], alpha / 2 - 1)
                weight += (2 if a == b else 4) * 2 * share * mu / alpha * slope
            dyad = dyads[:, :, a, b]
            change += (weight[:, None] * dyad)[:, :, None] * dyad[:, None, :]
    return stress, change


def _divided(low: FloatArray, high: FloatArray, power: float) -> FloatArray:
    """Return (high^power - low^power) / (high - low), accurate however close they are."""
    apart = np.log1p((high - low) / low)
    same = np.abs(apart) < 1e-12
    safe = np.where(same, 1.0, apart)
    ratio = np.where(same, power, np.expm1(power * safe) / np.expm1(safe))
    return np.asarray(low ** (power - 1) * ratio)
