"""How the top face goes along with a tip that drags on it: the layers' static in-plane answer, on a grid of nodes.

A force f along the face, spread over a Gaussian of two standard deviations R, has the modal amplitudes

    tx = 4/(ab) fx A cos(kx x) sin(ky y),   ty = 4/(ab) fy A sin(kx x) cos(ky y),   A = exp(-(R k)^2/8)

(half of that where m or n is 0). Along the wave vector the layers give C_V, beside it C_S per unit amplitude
(`thin_layer`), so with e = k/|k| the displacement's amplitudes are u = (C_V e e^T + C_S (1 - e e^T)) t.
"""

from __future__ import annotations

import numpy as np

from trocar.model import FloatArray
from trocar.tissues.tissue import Tissue
from trocar.waves.banded import surface_compliance
from trocar.waves.series import Series
from trocar.waves.thin_layer import Wavenumbers, horizontal_shear, vertical_and_along


class InPlane:
    """The in-plane answer of a block with its base held, sides simply supported.

    Args:
        tissue: the layers.
        size: sides a, b [m].
        modes: highest m and n.
        radius: R of the drag's Gaussian [m].
        x, y: nodes of the grid [m], shapes (nx,) and (ny,).
    """

    def __init__(
        self,
        tissue: Tissue,
        *,
        size: tuple[float, float],
        modes: tuple[int, int],
        radius: float,
        x: FloatArray,
        y: FloatArray,
    ) -> None:
        series = Series(size, modes)
        self._kx, self._ky = series.kx, series.ky
        kx, ky = (grid.ravel() for grid in np.meshgrid(series.kx, series.ky, indexing="ij"))
        k = np.hypot(kx, ky)
        at = Wavenumbers(k[1:], kx[1:] ** 2, ky[1:] ** 2)
        along, beside = np.zeros(len(k)), np.zeros(len(k))
        along[1:] = surface_compliance(vertical_and_along(tissue, base_held=True), at)[:, 0, 1, 1]
        beside[1:] = surface_compliance(horizontal_shear(tissue, base_held=True), at)[:, 0, 0, 0]
        norm = np.full(series.shape, 4 / (size[0] * size[1]))
        norm[0, :] *= 0.5
        norm[:, 0] *= 0.5
        spread = norm * np.exp(-((radius * k) ** 2) / 8).reshape(series.shape)
        k[0] = 1.0
        ex, ey = kx / k, ky / k
        self._xx = spread * (along * ex**2 + beside * ey**2).reshape(series.shape)
        self._xy = spread * ((along - beside) * ex * ey).reshape(series.shape)
        self._yy = spread * (along * ey**2 + beside * ex**2).reshape(series.shape)
        self._cos_x, self._sin_x = np.cos(np.outer(series.kx, x)), np.sin(np.outer(series.kx, x))
        self._cos_y, self._sin_y = np.cos(np.outer(series.ky, y)), np.sin(np.outer(series.ky, y))

    def under(self, x: float, y: float, force: tuple[float, float]) -> FloatArray:
        """Return u_x and u_y at the nodes under a force along the face [m], shape (2, ny, nx).

        Args:
            x: where it acts [m].
            y: where it acts [m].
            force: along x and y [N].
        """
        cos_x, sin_x = np.cos(self._kx * x), np.sin(self._kx * x)
        cos_y, sin_y = np.cos(self._ky * y), np.sin(self._ky * y)
        tx = force[0] * np.outer(cos_x, sin_y)
        ty = force[1] * np.outer(sin_x, cos_y)
        u_x, u_y = self._xx * tx + self._xy * ty, self._xy * tx + self._yy * ty
        return np.stack(
            [self._sin_y.T @ u_x.T @ self._cos_x, self._cos_y.T @ u_y.T @ self._sin_x],
        )
