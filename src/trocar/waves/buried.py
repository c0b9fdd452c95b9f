"""How places deep in the layers are strained by a load on top, wave by wave of the surface.

A wave u_z = W(z) sin sin with u_x = kx/k V(z) cos sin, u_y = ky/k V(z) sin cos (`thin_layer`) strains the layers by

    e_xx = -kx^2/k V ss,   e_yy = -ky^2/k V ss,   e_zz = W' ss,
    2 e_yz = ky/k (V' + k W) sc,   2 e_xz = kx/k (V' + k W) cs,   2 e_xy = 2 kx ky/k V cc.
"""

from __future__ import annotations

import numpy as np

from trocar.model import FloatArray
from trocar.tissues.tissue import Tissue
from trocar.waves.banded import surface_compliance
from trocar.waves.thin_layer import Wavenumbers, element_lengths, profile_of, vertical_and_along

_REFINEMENT = 3  # of the thin layers: strains in the middle of a thick layer to 1e-3


def strains(
    tissue: Tissue, places: FloatArray, size: tuple[float, float], kx: FloatArray, ky: FloatArray
) -> FloatArray:
    """Return the strains at places per newton of modal force on the upper face [1/N].

    Args:
        tissue: the layers, base held, sides simply supported.
        places: x, y, z [m], shape (n, 3), z below 0.
        size: sides of the block [m].
        kx: of the waves [1/m], shape (J,).
        ky: likewise.

    Returns:
        Shape (J, n, 6), in Mandel's order: xx, yy, zz, and sqrt(2) times yz, xz, xy.
    """
    k = np.hypot(kx, ky)
    lengths = [np.repeat(own / _REFINEMENT, _REFINEMENT) for own in element_lengths(tissue)]
    layers = vertical_and_along(tissue, base_held=True, lengths=lengths)
    every = range(layers.size // layers.components)
    moved = surface_compliance(layers, Wavenumbers(k, kx**2, ky**2), every)[..., 0]
    moved *= 4 / (size[0] * size[1])  # pressure of a wave per modal force
    heights, which = np.unique(places[:, 2], return_inverse=True)
    value, slope = profile_of(lengths, layers, heights)
    up, along = moved[..., 0], moved[..., 1]
    rise, way = (up @ slope.T)[:, which], (along @ value.T)[:, which]
    shear = (along @ slope.T + k[:, None] * (up @ value.T))[:, which]
    ex, ey = (kx / k)[:, None], (ky / k)[:, None]
    way *= k[:, None]
    phase_x, phase_y = np.outer(kx, places[:, 0]), np.outer(ky, places[:, 1])
    sx, cx, sy, cy = np.sin(phase_x), np.cos(phase_x), np.sin(phase_y), np.cos(phase_y)
    found = [
        -(ex**2) * way * sx * sy,
        -(ey**2) * way * sx * sy,
        rise * sx * sy,
        2**-0.5 * ey * shear * sx * cy,
        2**-0.5 * ex * shear * cx * sy,
        2**0.5 * ex * ey * way * cx * cy,
    ]
    return np.stack(found, axis=-1)
