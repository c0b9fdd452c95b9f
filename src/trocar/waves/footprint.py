"""What a press looks like to the modes: closed-form integrals of its traction against their shapes.

A product of a sine and a cosine is a sum of two plane waves cos(kx x +- ky y + phase). A plane wave integrated over
a centrally symmetric footprint is its value at the centre times the force times A(rho), the footprint's transform,
with rho^2 = (p k.e1)^2 + (q k.e2)^2 for an ellipse of semi-axes p, q along e1, e2:

    flat      A = 2 J1(rho)/rho                        (uniform disc)
    sphere    A = 3 (sin rho - rho cos rho)/rho^3      (Hertz: sqrt(1 - r^2/R^2))
    gaussian  A = exp(-rho^2/8)                        (R is two standard deviations)

The first two are the Hankel transforms of the pressures: Johnson 1985, Contact Mechanics, sections 3.4 and 4.2.
A Gaussian reaches beyond its ellipse and is integrated over the whole plane.
"""

from __future__ import annotations

from math import cos, sin

import numpy as np
from scipy.special import j1

from trocar.model import FloatArray, Press, Profile
from trocar.waves.series import Series

_SMALL = 1e-2  # below it the series of A to rho^4 is exact to 1e-13


def transform(profile: Profile, rho: FloatArray) -> FloatArray:
    """Return A(rho): 1 at rho = 0.

    Args:
        profile: how the traction is spread.
        rho: wavenumber times semi-axis [1], any shape.
    """
    if profile is Profile.GAUSSIAN:
        gauss: FloatArray = np.exp(-(rho**2) / 8)
        return gauss
    safe = np.where(rho > _SMALL, rho, 1.0)
    if profile is Profile.FLAT:
        far = 2 * j1(safe) / safe
        near = 1 - rho**2 / 8 + rho**4 / 192
    else:
        far = 3 * (np.sin(safe) - safe * np.cos(safe)) / safe**3
        near = 1 - rho**2 / 10 + rho**4 / 280
    result: FloatArray = np.where(rho > _SMALL, far, near)
    return result


def modal_forces(press: Press, series: Series) -> FloatArray:
    """Integrate the press's traction against the shapes along x, along y and across the surface.

    Args:
        press: force and footprint.
        series: shapes.

    Returns:
        Shape (3, M + 1, N + 1) [N]: against cos sin, sin cos and sin sin.
    """
    kx, ky = series.kx[:, None], series.ky[None, :]
    along, across = press.semi_axes
    c, s = cos(press.azimuth), sin(press.azimuth)

    def wave(sign: float) -> FloatArray:
        rho = np.hypot(along * (c * kx + s * sign * ky), across * (c * sign * ky - s * kx))
        return transform(press.profile, rho)

    sum_wave, difference_wave = wave(1.0), wave(-1.0)
    phase_sum, phase_difference = kx * press.x + ky * press.y, kx * press.x - ky * press.y
    sin_sum, sin_difference = sum_wave * np.sin(phase_sum), difference_wave * np.sin(phase_difference)
    cos_sum, cos_difference = sum_wave * np.cos(phase_sum), difference_wave * np.cos(phase_difference)
    shapes = 0.5 * np.stack([sin_sum - sin_difference, sin_sum + sin_difference, cos_difference - cos_sum])
    result: FloatArray = shapes * np.asarray(press.force_vector)[:, None, None]
    return result
