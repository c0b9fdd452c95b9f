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

Compliance = Callable[[FloatArray], FloatArray]

_ENDS = 6.5  # highest wavenumber times the pad's width: exp(-6.5^2/2) is 7e-10
_PER_DECAY = 40  # rows of the table to the narrower of the two widths: linear in between to 1e-4
_POINTS = 16  # Gauss points to a panel of the integral


@dataclass(frozen=True)
class NearField:
    """Static deflection around a pad, without what the window lets through.

    Attributes:
        spacing: between rows of the table [m].
        table: K at 0, spacing, 2 spacing ... [m/N], shape (rows, faces); zero beyond.
    """

    spacing: float
    table: FloatArray

    @property
    def reach(self) -> float:
        """Distance of the last row [m]."""
        return self.spacing * (len(self.table) - 1)

    def at(self, distances: FloatArray) -> FloatArray:
        """Return K [m/N] at distances [m], linear between rows; shape (...) to (..., faces)."""
        places = np.minimum(np.asarray(distances) / self.spacing, len(self.table) - 1)
        row = np.minimum(places.astype(np.int64), len(self.table) - 2)
        share = (places - row)[..., None]
        result: FloatArray = (1 - share) * self.table[row] + share * self.table[row + 1]
        return np.where((distances <= self.reach)[..., None], result, 0.0)


def near_field(compliance: Compliance, *, pad: float, window: float, reach: float) -> NearField:
    """Tabulate the near field of a tissue.

    Args:
        compliance: from wavenumbers k [1/m], shape (J,), to every face's static amplitude per unit amplitude of
            pressure on the top face [m/Pa], shape (J, faces).
        pad: width p of the pad's Gaussian, one standard deviation [m].
        window: width s of the window [m].
        reach: how far the table goes [m].

    Raises:
        InputError: the pad is not narrower than the window, or a length is not above 0.
    """
    if not 0 < pad < window:
        raise InputError("near field: pad", f"a width above 0 and below the window's, {window:g} m", pad)
    if not reach > 0:
        raise InputError("near field: reach", "a length above 0 [m]", reach)
    spacing = pad / _PER_DECAY
    radii = spacing * np.arange(int(np.ceil(reach / spacing)) + 1)
    k, weights = _quadrature(_ENDS / pad, radii[-1])
    left_out = np.exp(-0.5 * (pad * k) ** 2) - np.exp(-0.5 * (window * k) ** 2)
    spectrum = (weights * left_out * k / (2 * np.pi))[:, None] * compliance(k)
    return NearField(spacing=spacing, table=np.array([j0(k * radius) @ spectrum for radius in radii]))


def _quadrature(last: float, furthest: float) -> tuple[FloatArray, FloatArray]:
    """Return nodes and weights up to the last wavenumber: two waves of the furthest J0 to a panel, fine near zero."""
    panels = max(24, int(np.ceil(last * furthest / (4 * np.pi))))
    edges = np.unique(
        np.concatenate([np.linspace(0, last, panels + 1), last / panels * 0.5 ** np.arange(1, 8)])
    )
    nodes, gauss = np.polynomial.legendre.leggauss(_POINTS)
    half = 0.5 * np.diff(edges)
    k = (edges[:-1, None] + half[:, None] * (nodes + 1)).ravel()
    return k, (half[:, None] * gauss).ravel()
