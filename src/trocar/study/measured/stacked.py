"""Static compliance of many stacks of layers on bone under a flat, slippery punch, all at once and in closed form.

Under a pressure cos(k x) the plane strain in a layer obeys y' = k A y for y = (u_x, u_z, tau/(mu k), sigma/(mu k)), and
(A^2 - 1)^2 = 0, so exp(A s) is a cubic in A (E. Kausel and J. M. Roesset 1981, Bull. Seismol. Soc. Am. 71:1743, in the
static limit). The compliance of what lies below is carried up through the layers from bone, where it is 0. A flat
rigid punch of radius a on a half-space presses with a pressure whose transform is sin(k a)/(k a); with that pressure

    indentation / force = 1/(2 pi) integral of C(k) (sin(k a)/(k a))^2 k dk,

exact on a half-space (I. N. Sneddon 1965, Int. J. Eng. Sci. 3:47); elsewhere off by the square of what the pressure is.
"""

from __future__ import annotations

import numpy as np

from trocar.model import FloatArray

_DEEPEST = 10.0  # k times the depth below which nothing is felt: exp(-20) of it comes back
_LAST = 40.0  # highest k a; beyond it the tail of a half-space of the top layer is added
_PANELS = np.array(
    [0.0, 0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0, 20.0, 24.0, 28.0, 32.0, 36.0, _LAST]
)
_POINTS = 4


def punch_compliance(
    thickness: FloatArray, shear_modulus: FloatArray, poisson_ratio: float, radius: FloatArray
) -> FloatArray:
    """Return indentation over force [m/N] of each stack, shape (n,).

    Args:
        thickness: of the layers, top first [m], shape (n, layers).
        shear_modulus: of the layers [Pa], shape (layers,).
        poisson_ratio: of all of them [1], at most 0.5.
        radius: of the punch [m], shape (n,).
    """
    nodes, gauss = np.polynomial.legendre.leggauss(_POINTS)
    half = 0.5 * np.diff(_PANELS)
    ka = (_PANELS[:-1, None] + half[:, None] * (nodes + 1)).ravel()
    weights = (half[:, None] * gauss).ravel()
    k = ka / radius[:, None]
    amplitude = pressure_compliance(thickness, shear_modulus, poisson_ratio, k)
    integral = (amplitude * k * weights * (np.sin(ka) / ka) ** 2).sum(axis=1)
    tail = (1 - poisson_ratio) / shear_modulus[0] / (2 * _LAST)  # sin^2 is a half on average
    return np.asarray((integral + tail) / (2 * np.pi * radius))


def pressure_compliance(
    thickness: FloatArray, shear_modulus: FloatArray, poisson_ratio: float, k: FloatArray
) -> FloatArray:
    """Return how deep the surface sinks per pressure, both as cos(k x), no shear on it [m/Pa], shape (n, q).

    Args:
        thickness: of the layers, top first [m], shape (n, layers).
        shear_modulus: of the layers [Pa], shape (layers,).
        poisson_ratio: of all of them [1], at most 0.5.
        k: wavenumbers [1/m], above 0, shape (n, q).
    """
    powers = _powers(poisson_ratio)
    below = np.zeros((*k.shape, 2, 2))  # k times displacement over traction [1/Pa]
    for layer in range(thickness.shape[1] - 1, -1, -1):
        s = np.minimum(k * thickness[:, layer, None], _DEEPEST)
        up, down = np.exp(s), np.exp(-s)
        cosh, sinh = 0.5 * (up + down), 0.5 * (up - down)
        cubic = np.stack(
            [cosh - 0.5 * s * sinh, 0.5 * (3 * sinh - s * cosh), 0.5 * s * sinh, 0.5 * (s * cosh - sinh)],
            axis=-1,
        )
        carried = (cubic @ powers.reshape(4, 16)).reshape(*k.shape, 4, 4)
        lower = below * shear_modulus[layer]
        displaced = carried[..., :2, :2] @ lower + carried[..., :2, 2:]
        traction = carried[..., 2:, :2] @ lower + carried[..., 2:, 2:]
        below = displaced @ np.linalg.inv(traction) / shear_modulus[layer]
    return np.asarray(below[..., 1, 1] / k)


def _powers(poisson_ratio: float) -> FloatArray:
    """Return 1, A, A^2, A^3, shape (4, 4, 4)."""
    nu = poisson_ratio
    beta, gamma = nu / (1 - nu), (1 - 2 * nu) / (2 * (1 - nu))
    a = np.array(
        [[0, 1, 1, 0], [-beta, 0, 0, gamma], [2 / (1 - nu), 0, 0, beta], [0, 0, -1, 0]], dtype=np.float64
    )
    return np.array([np.eye(4), a, a @ a, a @ a @ a])
