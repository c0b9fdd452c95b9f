"""The nodal forces of patches, compiled: what a step in explicit time asks for.

With H = du/dX smoothed over a part, F = I + H, J = det F, and a bar over what is averaged over the parts of a patch by
volume, the first Piola-Kirchhoff stress is, for the linear law,

    P = mu (H + H^T) + lambda tr(H_bar) I + H sigma,

H with tau dH/dt added but in the last term, and for the neo-Hookean law

    P = mu J^(-2/3) (F - F:F/3 F^-T) + [2 mu/3 (J - 1) + lambda (J_bar - 1)] cof F + H sigma + F S_v,
    S_v = tau (lambda tr(E'_bar) I + 2 mu E'),   E' = sym(F^T dH/dt),

the laws of `reference.hyperelastic` and `reference.deformed` with lambda/2 (J - 1)^2 counted once a patch. sigma is the
prestress, whose forces at rest are left out: supports and sides bear them. Total Lagrangian: the gradients are those of
the rest state throughout (K. Miller et al. 2007, Commun. Numer. Methods Eng. 23:121; A. Horton et al. 2010, Int. J.
Numer. Methods Biomed. Eng. 26:977).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from trocar.model import FloatArray
from trocar.reference.mesh_free.patches import Patches
from trocar.tissues import Tissue


class Laws(NamedTuple):
    """The layers' laws; a tuple, so that compiled functions take it.

    Args:
        shear: mu [Pa], shape (layers,).
        lame: lambda [Pa], shape (layers,).
        retardation: tau [s], shape (layers,).
        prestress: sigma along x and y [Pa], shape (layers, 2).
        large: whether they are neo-Hookean.
    """

    shear: FloatArray
    lame: FloatArray
    retardation: FloatArray
    prestress: FloatArray
    large: bool


def laws_of(tissue: Tissue) -> Laws:
    """Return the laws of a tissue's layers."""
    layers = tissue.layers
    return Laws(
        shear=np.array([layer.shear_modulus for layer in layers]),
        lame=np.array([layer.lame_lambda for layer in layers]),
        retardation=np.array([layer.retardation_time for layer in layers]),
        prestress=np.array([(layer.prestress_x, layer.prestress_y) for layer in layers]),
        large=tissue.large_deformation,
    )


@njit(cache=True, nogil=True)
def slopes_of(patches: Patches, field: FloatArray) -> FloatArray:  # pragma: no cover - compiled
    """Return H of every part, shape (parts, 3, 3), of a field, shape (nodes, 3)."""
    result = np.empty((len(patches.volume), 3, 3))
    for patch in range(len(patches.layer)):
        first = patches.part_start[patch]
        parts = patches.part_start[patch + 1] - first
        slopes = np.empty((3, 3 * parts))
        _gather(patches, patch, parts, field, slopes)
        for part in range(parts):
            for i in range(3):
                for k in range(3):
                    result[first + part, i, k] = slopes[i, 3 * part + k]
    return result


@njit(cache=True, nogil=True)
def internal_forces(
    patches: Patches, laws: Laws, displacement: FloatArray, velocity: FloatArray, forces: FloatArray
) -> int:  # pragma: no cover - compiled
    """Write the nodal forces that hold a displacement at a velocity [N]; return a patch turned inside out, or -1.

    Args:
        patches: the quadrature.
        laws: of the layers.
        displacement: [m], shape (nodes, 3).
        velocity: [m/s], shape (nodes, 3); looked at where layers are damped.
        forces: written, shape (nodes, 3).
    """
    forces[:] = 0.0
    here, rate = np.empty((3, 24)), np.empty((3, 24))
    stress = np.empty((3, 24))
    for patch in range(len(patches.layer)):
        parts = patches.part_start[patch + 1] - patches.part_start[patch]
        damped = laws.retardation[patches.layer[patch]] > 0.0
        _gather(patches, patch, parts, displacement, here)
        if damped:
            _gather(patches, patch, parts, velocity, rate)
        if laws.large:
            if not _neo_hookean(patches, laws, patch, parts, here, rate, damped, stress):
                return patch
        else:
            _linear(patches, laws, patch, parts, here, rate, damped, stress)
        _pour(patches, patch, parts, stress, forces)
    return -1


@njit(cache=True, nogil=True)
def _gather(
    patches: Patches, patch: int, parts: int, field: FloatArray, slopes: FloatArray
) -> None:  # pragma: no cover - compiled
    """Write H_ik of a patch's parts into slopes[i, 3 part + k]."""
    width, place = 3 * parts, patches.gradient_start[patch]
    slopes[:, :width] = 0.0
    for number in range(patches.node_start[patch], patches.node_start[patch + 1]):
        node = patches.nodes[number]
        x, y, z = field[node, 0], field[node, 1], field[node, 2]
        for column in range(width):
            gradient = patches.gradients[place + column]
            slopes[0, column] += x * gradient
            slopes[1, column] += y * gradient
            slopes[2, column] += z * gradient
        place += width


@njit(cache=True, nogil=True, fastmath={"reassoc", "contract"})
def _pour(
    patches: Patches, patch: int, parts: int, stress: FloatArray, forces: FloatArray
) -> None:  # pragma: no cover - compiled
    """Add the forces of V P to a patch's nodes."""
    width, place = 3 * parts, patches.gradient_start[patch]
    for number in range(patches.node_start[patch], patches.node_start[patch + 1]):
        node, x, y, z = patches.nodes[number], 0.0, 0.0, 0.0
        for column in range(width):
            gradient = patches.gradients[place + column]
            x += gradient * stress[0, column]
            y += gradient * stress[1, column]
            z += gradient * stress[2, column]
        forces[node, 0] += x
        forces[node, 1] += y
        forces[node, 2] += z
        place += width


@njit(cache=True, nogil=True)
def _linear(
    patches: Patches,
    laws: Laws,
    patch: int,
    parts: int,
    here: FloatArray,
    rate: FloatArray,
    damped: bool,
    stress: FloatArray,
) -> None:  # pragma: no cover - compiled
    """Write V P of a patch's parts."""
    layer, first = patches.layer[patch], patches.part_start[patch]
    shear, tau = laws.shear[layer], laws.retardation[layer]
    total, growth = 0.0, 0.0
    for part in range(parts):
        volume = patches.volume[first + part]
        total += volume
        for k in range(3):
            growth += volume * here[k, 3 * part + k]
            if damped:
                growth += tau * volume * rate[k, 3 * part + k]
    pressure = laws.lame[layer] * growth / total
    for part in range(parts):
        volume, at = patches.volume[first + part], 3 * part
        for i in range(3):
            for k in range(3):
                strain = here[i, at + k] + here[k, at + i]
                if damped:
                    strain += tau * (rate[i, at + k] + rate[k, at + i])
                value = shear * strain
                if i == k:
                    value += pressure
                if k < 2:
                    value += here[i, at + k] * laws.prestress[layer, k]
                stress[i, at + k] = volume * value


@njit(cache=True, nogil=True)
def _neo_hookean(
    patches: Patches,
    laws: Laws,
    patch: int,
    parts: int,
    here: FloatArray,
    rate: FloatArray,
    damped: bool,
    stress: FloatArray,
) -> bool:  # pragma: no cover - compiled
    """Write V P of a patch's parts; return whether none is inside out."""
    layer, first = patches.layer[patch], patches.part_start[patch]
    shear, lame, tau = laws.shear[layer], laws.lame[layer], laws.retardation[layer]
    total, growth, growing = 0.0, 0.0, 0.0
    deformed, cofactor, strain = np.empty((8, 3, 3)), np.empty((8, 3, 3)), np.empty((8, 3, 3))
    change = np.empty(8)
    for part in range(parts):
        f, c, volume = deformed[part], cofactor[part], patches.volume[first + part]
        for i in range(3):
            for k in range(3):
                f[i, k] = here[i, 3 * part + k]
            f[i, i] += 1.0
        for i in range(3):
            p, q = (i + 1) % 3, (i + 2) % 3
            for k in range(3):
                r, s = (k + 1) % 3, (k + 2) % 3
                c[i, k] = f[p, r] * f[q, s] - f[p, s] * f[q, r]
        j = f[0, 0] * c[0, 0] + f[0, 1] * c[0, 1] + f[0, 2] * c[0, 2]
        if not j > 0.0:
            return False
        change[part] = j
        total += volume
        growth += volume * (j - 1.0)
        if damped:
            for i in range(3):
                for k in range(3):
                    value = 0.0
                    for m in range(3):
                        value += f[m, i] * rate[m, 3 * part + k] + f[m, k] * rate[m, 3 * part + i]
                    strain[part, i, k] = 0.5 * value
                growing += volume * strain[part, i, i]
    pressure, viscous = lame * growth / total, tau * lame * growing / total
    for part in range(parts):
        f, c, at = deformed[part], cofactor[part], 3 * part
        j, square = change[part], 0.0
        for i in range(3):
            for k in range(3):
                square += f[i, k] * f[i, k]
        isochoric = shear * j ** (-2.0 / 3.0)
        across = pressure + 2.0 / 3.0 * shear * (j - 1.0) - isochoric * square / (3.0 * j)
        for i in range(3):
            for k in range(3):
                value = isochoric * f[i, k] + across * c[i, k]
                if k < 2:
                    value += here[i, at + k] * laws.prestress[layer, k]
                if damped:
                    value += viscous * f[i, k]
                    for m in range(3):
                        value += 2.0 * tau * shear * f[i, m] * strain[part, m, k]
                stress[i, at + k] = patches.volume[first + part] * value
    return True
