"""The one exact step: real 2 x 2 blocks under a force that is linear in time.

Every linear tissue, whatever its modes, becomes a set of blocks x' = A x + g(t) with x in R^2: an oscillator is
one block, an overdamped pair of real poles is one, a critically damped double pole is one. Over a step of length
dt in which g goes linearly from g0 to g1,

    x(dt) = exp(A dt) x(0) + W0 g0 + W1 g1,   W1 = dt phi2(A dt),   W0 = dt (phi1(A dt) - phi2(A dt)),
    phi1(z) = (e^z - 1)/z,   phi2(z) = (e^z - 1 - z)/z^2,

with no error but rounding, for any dt (Hochbruck and Ostermann 2010, Acta Numerica 19:209, eqs. 2.10-2.11).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trocar.model import FloatArray

_TAYLOR_TERMS = 20  # phi2 of a 2 x 2 matrix of norm <= 1: the first term left out is below 1/22! = 9e-22
_IDENTITY = np.eye(2)


def exponential(blocks: FloatArray, dt: float) -> FloatArray:
    """Return exp(blocks dt) in closed form.

    With m = trace/2 and d = ((a00 - a11)/2)^2 + a01 a10, exp(A dt) = e^(m dt) [C I + S (A - m I)], where C and S are
    cos(w dt) and sin(w dt)/w for d = -w^2 < 0, and cosh(r dt) and sinh(r dt)/r for d = r^2 >= 0. Nothing cancels
    where the poles meet, so critical damping needs no case of its own.

    Args:
        blocks: the matrices A [1/s], shape (..., 2, 2).
        dt: length of the step [s].

    Returns:
        Shape (..., 2, 2).
    """
    half_gap = 0.5 * (blocks[..., 0, 0] - blocks[..., 1, 1])
    mean = 0.5 * (blocks[..., 0, 0] + blocks[..., 1, 1])
    discriminant = half_gap**2 + blocks[..., 0, 1] * blocks[..., 1, 0]
    oscillates = discriminant < 0
    omega = np.sqrt(np.where(oscillates, -discriminant, 0.0))
    rate = np.sqrt(np.where(oscillates, 0.0, discriminant))

    decay = np.exp(mean * dt)
    swing_even = decay * np.cos(omega * dt)
    swing_odd = decay * np.sin(omega * dt) / np.where(oscillates, omega, 1.0)

    slow = np.exp((mean + rate) * dt)
    creep_even = 0.5 * (slow + np.exp((mean - rate) * dt))
    apart = rate > 0
    creep_odd = slow * np.where(apart, -np.expm1(-2 * rate * dt) / np.where(apart, 2 * rate, 1.0), dt)

    even = np.where(oscillates, swing_even, creep_even)
    odd = np.where(oscillates, swing_odd, creep_odd)
    deviator = blocks - mean[..., None, None] * _IDENTITY
    result: FloatArray = even[..., None, None] * _IDENTITY + odd[..., None, None] * deviator
    return result


def ramp_weights(blocks: FloatArray, dt: float) -> tuple[FloatArray, FloatArray]:
    """Return W0 and W1: what the force at the start and at the end of the step add to the state.

    The phi functions are summed as Taylor series of A dt / 2^s with norm at most 1 and doubled s times:
    phi2(2z) = (phi1(z)^2 + 2 phi2(z))/4, phi1(2z) = (e^z + 1) phi1(z)/2.

    Args:
        blocks: the matrices A [1/s], shape (..., 2, 2).
        dt: length of the step [s].

    Returns:
        W0 and W1 [s], each of shape (..., 2, 2).
    """
    scaled = blocks * dt
    norms = np.abs(scaled).sum(axis=-1).max(axis=-1, initial=0.0)
    doublings = np.ceil(np.log2(np.maximum(norms, 1.0))).astype(int)
    z = scaled / 2.0 ** doublings[..., None, None]

    phi1 = np.broadcast_to(_IDENTITY, z.shape).copy()
    phi2 = 0.5 * phi1
    power = phi1.copy()
    factorial = 1.0
    for k in range(1, _TAYLOR_TERMS):
        power = power @ z
        factorial *= k + 1
        phi1 += power / factorial
        phi2 += power / (factorial * (k + 2))
    grown = _IDENTITY + z @ phi1
    for round_ in range(int(doublings.max(initial=0))):
        active = (doublings > round_)[..., None, None]
        phi2 = np.where(active, 0.25 * (phi1 @ phi1 + 2 * phi2), phi2)
        phi1 = np.where(active, 0.5 * (grown @ phi1 + phi1), phi1)
        grown = np.where(active, grown @ grown, grown)
    return dt * (phi1 - phi2), dt * phi2


@dataclass(frozen=True)
class Propagator:
    """Coefficients of one exact step of length dt for J groups of r blocks with n inputs each.

    Attributes:
        transition: exp(A dt), shape (J, r, 2, 2).
        start_gain: W0 B, what an input at the start of the step adds, shape (J, r, 2, n).
        end_gain: W1 B, the same for its end, shape (J, r, 2, n).
    """

    transition: FloatArray
    start_gain: FloatArray
    end_gain: FloatArray

    @classmethod
    def over(cls, blocks: FloatArray, inputs: FloatArray, dt: float) -> Propagator:
        """Build the step of length dt [s] of x' = A x + B f.

        Args:
            blocks: A [1/s], shape (J, r, 2, 2).
            inputs: B, shape (J, r, 2, n).
            dt: length of the step [s].
        """
        start, end = ramp_weights(blocks, dt)
        return cls(
            transition=np.ascontiguousarray(exponential(blocks, dt)),
            start_gain=np.ascontiguousarray(start @ inputs),
            end_gain=np.ascontiguousarray(end @ inputs),
        )
