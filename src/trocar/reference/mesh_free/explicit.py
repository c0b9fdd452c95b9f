"""Explicit time: central differences with lumped mass, in steps as long as the stiffest mode lets them be.

With a = M^-1 (f - internal forces at u and the last half step's velocity),

    v(n + 1/2) = v(n - 1/2) + h a(n),   u(n + 1) = u(n) + h v(n + 1/2)

(T. Belytschko, W. K. Liu and B. Moran 2000, Nonlinear Finite Elements, box 6.1): second order, first where layers are
damped, whose velocity is half a step old. Each step of the caller begins and ends with half a kick. It is stable while

    h^2/4 omega^2 + h/2 delta <= 1

with omega^2 and delta the largest eigenvalues of M^-1 K and M^-1 C (sufficient for any damping, and for C = tau K the
exact limit, their eq. 6.6.15), which Lanczos' method estimates from the matrices at rest. Damping that grows with
frequency shortens the step: the stiffest mode of a thin layer is far beyond critically damped.
"""

from __future__ import annotations

from math import ceil, sqrt

import numpy as np
import scipy.sparse as sp
from numba import njit
from scipy.sparse.linalg import LinearOperator, eigsh

from trocar.errors import SolverError
from trocar.model import FloatArray
from trocar.reference.mesh_free.body import Body
from trocar.reference.mesh_free.cloud import BoolArray
from trocar.reference.mesh_free.patches import Patches
from trocar.reference.mesh_free.stress import Laws, internal_forces

_LANCZOS = 1e-3  # relative accuracy of an eigenvalue, which is found from below
_SAFETY = 0.98  # of the critical step at rest: Lanczos' error and rounding
_LARGE_SAFETY = 0.6  # of it, under large deformation: squeezed to two thirds, tissue is as much stiffer
_MOST_RETRIES = 3  # of a step of the caller, each with half the step


def critical_step(body: Body) -> float:
    """Return the longest stable step of a body near rest [s]."""
    stiffest = _largest(body, body.stiffness)
    damped = bool(body.laws.retardation.any())
    delta = _largest(body, body.damping) if damped else 0.0
    return (sqrt(delta**2 + 4 * stiffest) - delta) / stiffest


def _largest(body: Body, matrix: sp.csr_array) -> float:
    """Return the largest eigenvalue of M^-1 times a matrix."""
    root = 1.0 / np.sqrt(np.repeat(body.mass, 3)[body.free])
    free = body.freed(matrix)
    scaled = LinearOperator(free.shape, matvec=lambda x: root * (free @ (root * x.ravel())), dtype=np.float64)
    start = np.random.default_rng(0).standard_normal(len(root))
    return float(eigsh(scaled, k=1, which="LA", v0=start, tol=_LANCZOS, return_eigenvectors=False)[0])


def advance(
    body: Body,
    critical: float,
    start: tuple[FloatArray, FloatArray],
    forces: tuple[FloatArray, FloatArray],
    dt: float,
) -> tuple[FloatArray, FloatArray]:
    """Step by dt [s].

    Args:
        body: what moves.
        critical: its critical step [s].
        start: displacement [m] and velocity [m/s], shape (nodes, 3) each.
        forces: nodal forces [N] at start and end, likewise.
        dt: [s], cut into as many steps as stability asks for.

    Returns:
        Displacement and velocity at the end.

    Raises:
        SolverError: tissue turned inside out, however short the steps.
    """
    longest = critical * (_LARGE_SAFETY if body.laws.large else _SAFETY)
    mass, held = body.mass, body.held
    for halving in range(_MOST_RETRIES + 1):
        count = ceil(dt / longest) * 2**halving
        displacement, velocity = start[0].copy(), start[1].copy()
        failed = _advance(
            body.patches, body.laws, mass, held, displacement, velocity, *forces, count, dt / count
        )
        if not failed and np.isfinite(displacement).all():
            return displacement, velocity
    raise SolverError(
        f"mesh-free: tissue turned inside out within a step of {dt:.3g} s, however short its parts; "
        "take less force or a slower load"
    )


@njit(cache=True, nogil=True)
def _advance(
    patches: Patches,
    laws: Laws,
    mass: FloatArray,
    held: BoolArray,
    displacement: FloatArray,
    velocity: FloatArray,
    before: FloatArray,
    after: FloatArray,
    count: int,
    dt: float,
) -> bool:  # pragma: no cover - compiled
    """Advance displacement and velocity in place; return whether tissue turned inside out."""
    nodes, forces = len(mass), np.empty(displacement.shape)
    if internal_forces(patches, laws, displacement, velocity, forces) >= 0:
        return True
    for number in range(count + 1):
        kick = dt if 0 < number < count else 0.5 * dt
        share = number / count
        for node in range(nodes):
            for k in range(3):
                if not held[node, k]:
                    pushed = (1.0 - share) * before[node, k] + share * after[node, k] - forces[node, k]
                    velocity[node, k] += kick * pushed / mass[node]
                    if number < count:
                        displacement[node, k] += dt * velocity[node, k]
        if number < count and internal_forces(patches, laws, displacement, velocity, forces) >= 0:
            return True
    return False
