"""The near field: what waves too short for a tick add around a small pad that presses.

A live tissue moves the waves that a smooth window of width s lets through, w(k) = exp(-(s k)^2/2); a pad, a Gaussian
footprint of width p < s, presses on shorter ones too. These answer within a tick, and far from the sides they know
nothing but the distance: what is left of the static response is

    K(r) = 1/(2 pi) integral of C(k) (exp(-(p k)^2/2) - exp(-(s k)^2/2)) J0(k r) k dk

for each face, C(k) being its static amplitude per unit amplitude of pressure on top. Both brackets are Gaussians of
growing width, so the integrand is not negative: any set of pads feels a positive semidefinite compliance, and pressing
stores energy in it. Window and near field together are the static response of the whole spectrum, whatever s.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.special import j0

from trocar.errors import InputError
from trocar.model import FloatArray
from trocar.tissues.layer import Layer
from trocar.tissues.tissue import Tissue
from trocar.waves.banded import surface_compliance
from trocar.waves.thin_layer import Wavenumbers, vertical_and_along

Compliance = Callable[[FloatArray], FloatArray]

SMOOTH = 2e-3  # [m] window beyond which fitted sheets answer as layers do; shorter waves are the layers' own
_FINE = 0.4  # first element in widths of a pad: its waves of 3/width are then resolved to 1e-3
_ENDS = 6.5  # highest wavenumber times the pad's width: exp(-6.5^2/2) is 7e-10
_PER_DECAY = 40  # rows of the table to the pad's width, and later to the distance: linear in between to 1e-4
_EVEN = 3.0  # widths of a pad within which rows lie evenly
_POINTS = 16  # Gauss points to a panel of the integral


@dataclass(frozen=True)
class NearField:
    """Static deflection around a pad, without what the window lets through.

    Attributes:
        radii: of the table's rows [m], ascending from 0, shape (rows,).
        table: K there [m/N], shape (rows, faces); zero beyond.
    """

    radii: FloatArray
    table: FloatArray

    def at(self, distances: FloatArray) -> FloatArray:
        """Return K [m/N] at distances [m], linear between rows; shape (...) to (..., faces)."""
        faces = [np.interp(distances, self.radii, face, right=0.0) for face in self.table.T]
        result: FloatArray = np.stack(faces, axis=-1)
        return result


def near_field(
    compliance: Compliance, *, pad: float, window: float, reach: float, first: float = 0.0
) -> NearField:
    """Tabulate the near field of a tissue.

    Args:
        compliance: from wavenumbers k [1/m], shape (J,), to every face's static amplitude per unit amplitude of
            pressure on the top face [m/Pa], shape (J, faces).
        pad: width p of the pad's Gaussian, one standard deviation [m].
        window: width s of the window [m].
        reach: how far the table goes [m].
        first: wavenumber the integral begins at [1/m]: a block has no longer waves, and one with a free base would
            answer them without bound.

    Raises:
        InputError: the pad is not narrower than the window, or a length is not above 0.
    """
    if not 0 < pad < window:
        raise InputError("near field: pad", f"a width above 0 and below the window's, {window:g} m", pad)
    if not reach > 0:
        raise InputError("near field: reach", "a length above 0 [m]", reach)
    even = np.arange(0.0, _EVEN, 1 / _PER_DECAY)
    growing = np.geomspace(_EVEN, max(reach / pad, 2 * _EVEN), max(2, int(_PER_DECAY * np.log(reach / pad))))
    radii = pad * np.concatenate([even, growing])
    k, weights = _quadrature(first, _ENDS / pad, radii[-1])
    left_out = np.exp(-0.5 * (pad * k) ** 2) - np.exp(-0.5 * (window * k) ** 2)
    spectrum = (weights * left_out * k / (2 * np.pi))[:, None] * compliance(k)
    return NearField(radii=radii, table=np.array([j0(k * radius) @ spectrum for radius in radii]))


def layered_compliance(tissue: Tissue, k: FloatArray, *, base_held: bool, finest: float) -> FloatArray:
    """Return every face's static amplitude per unit amplitude of pressure on layers [m/Pa], far from the sides.

    Args:
        tissue: the layers.
        k: wavenumbers [1/m], in no direction, shape (J,).
        base_held: whether the lower face cannot move.
        finest: width of the smallest pad that presses [m].

    Returns:
        Shape (J, faces).
    """
    layers = vertical_and_along(tissue, base_held=base_held, finest=_FINE * finest)
    result: FloatArray = surface_compliance(layers, Wavenumbers(k, 0.5 * k**2, 0.5 * k**2))[:, :, 0, 0]
    return result


def half_space(layer: Layer) -> Compliance:
    """Return the compliance of a half-space, 2 (1 - nu^2)/(E k) (Johnson 1985, Contact Mechanics, ch. 13).

    Args:
        layer: its material.
    """
    soft = 2 * (1 - layer.poisson_ratio**2) / layer.young_modulus

    def compliance(k: FloatArray) -> FloatArray:
        return np.asarray(soft / k)[:, None]

    return compliance


def _quadrature(first: float, last: float, furthest: float) -> tuple[FloatArray, FloatArray]:
    """Return nodes and weights between two wavenumbers: two waves of the furthest J0 to a panel, fine near zero."""
    panels = max(24, int(np.ceil(last * furthest / (4 * np.pi))))
    even, fine = np.linspace(0, last, panels + 1), last / panels * 0.5 ** np.arange(1, 8)
    edges = np.unique(np.maximum(np.concatenate([even, fine]), first))
    nodes, gauss = np.polynomial.legendre.leggauss(_POINTS)
    half = 0.5 * np.diff(edges)
    k = (edges[:-1, None] + half[:, None] * (nodes + 1)).ravel()
    return k, (half[:, None] * gauss).ravel()
