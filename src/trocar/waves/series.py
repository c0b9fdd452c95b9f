"""Double Fourier series on the rectangle 0 <= x <= a, 0 <= y <= b.

A vertical displacement runs in sin(kx x) sin(ky y), one along x in cos(kx x) sin(ky y), one along y in
sin(kx x) cos(ky y), with kx = m pi/a and ky = n pi/b. All tables have rows m = 0..M and columns n = 0..N; a sine's
row or column 0 is empty. Coefficients: Kreyszig, Advanced Engineering Mathematics, section 12.9, eq. 15.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from trocar.errors import InputError
from trocar.model import FloatArray

Field = Callable[[FloatArray, FloatArray], FloatArray]
Shape = Callable[[FloatArray], FloatArray]
_GRID = 8  # a product grid with up to this many times the points is still cheaper than point by point
_GAUSS_POINTS = 8  # per panel of half a wavelength of the highest mode: exact to rounding for smooth fields


@dataclass(frozen=True)
class Series:
    """The wavenumbers and shapes of one rectangle.

    Args:
        size: sides a, b [m].
        modes: highest m and n.

    Raises:
        InputError: a side is not a positive finite number, or a mode count is not a positive integer.
    """

    size: tuple[float, float]
    modes: tuple[int, int]

    def __post_init__(self) -> None:
        if not all(np.isfinite(side) and side > 0 for side in self.size):
            raise InputError("size", "two lengths above 0 [m]", self.size)
        if not all(m > 0 for m in self.modes):
            raise InputError("modes", "two integers above 0", self.modes)

    @cached_property
    def kx(self) -> FloatArray:
        """Wavenumbers along x [1/m], shape (M + 1,)."""
        result: FloatArray = np.arange(self.modes[0] + 1, dtype=np.float64) * (np.pi / self.size[0])
        return result

    @cached_property
    def ky(self) -> FloatArray:
        """Wavenumbers along y [1/m], shape (N + 1,)."""
        result: FloatArray = np.arange(self.modes[1] + 1, dtype=np.float64) * (np.pi / self.size[1])
        return result

    @property
    def shape(self) -> tuple[int, int]:
        """Of a table: M + 1, N + 1."""
        return self.modes[0] + 1, self.modes[1] + 1

    def vertical(self, table: FloatArray, points: FloatArray) -> FloatArray:
        """Sum table[m, n] sin(kx x) sin(ky y) at points [m], shape (p, >= 2); returns shape (p,)."""
        return self._sum(np.sin, table, np.sin, points)

    def along_x(self, table: FloatArray, points: FloatArray) -> FloatArray:
        """Sum table[m, n] cos(kx x) sin(ky y) at points; shapes as in `vertical`."""
        return self._sum(np.cos, table, np.sin, points)

    def along_y(self, table: FloatArray, points: FloatArray) -> FloatArray:
        """Sum table[m, n] sin(kx x) cos(ky y) at points; shapes as in `vertical`."""
        return self._sum(np.sin, table, np.cos, points)

    def _sum(self, shape_x: Shape, table: FloatArray, shape_y: Shape, points: FloatArray) -> FloatArray:
        """Sum over the rows and columns that are not empty; points on a grid share their shapes."""
        rows, columns = np.flatnonzero(table.any(axis=1)), np.flatnonzero(table.any(axis=0))
        x, place_x = np.unique(points[:, 0], return_inverse=True)
        y, place_y = np.unique(points[:, 1], return_inverse=True)
        waves_x = shape_x(np.outer(x, self.kx[rows])) @ table[np.ix_(rows, columns)]
        waves_y = shape_y(np.outer(y, self.ky[columns]))
        result: FloatArray
        if len(x) * len(y) <= _GRID * len(points):
            result = (waves_x @ waves_y.T)[place_x, place_y]
        else:
            result = np.einsum("pn,pn->p", waves_x[place_x], waves_y[place_y])
        return result

    def coefficients(self, field: Field) -> FloatArray:
        """Return B[m, n] = 4/(ab) times the integral of field(x, y) sin(kx x) sin(ky y), by Gauss quadrature.

        Args:
            field: takes arrays x, y [m] that broadcast against each other; returns the field's values there.

        Returns:
            Shape (M + 1, N + 1).

        Raises:
            InputError: the field is not finite somewhere on the rectangle.
        """
        x, weight_x = _gauss_panels(self.size[0], self.modes[0])
        y, weight_y = _gauss_panels(self.size[1], self.modes[1])
        values = np.broadcast_to(np.asarray(field(x[:, None], y[None, :]), dtype=float), (len(x), len(y)))
        if not np.isfinite(values).all():
            raise InputError(
                "initial field", "finite values on the whole block", values[~np.isfinite(values)][0]
            )
        sin_x = np.sin(np.outer(self.kx, x)) * weight_x
        sin_y = np.sin(np.outer(y, self.ky)) * weight_y[:, None]
        a, b = self.size
        result: FloatArray = 4 / (a * b) * (sin_x @ values @ sin_y)
        return result


def _gauss_panels(length: float, modes: int) -> tuple[FloatArray, FloatArray]:
    nodes, weights = np.polynomial.legendre.leggauss(_GAUSS_POINTS)
    panels = max(modes, 8)
    edges = np.linspace(0, length, panels + 1)
    half = 0.5 * length / panels
    points = (edges[:-1, None] + half * (nodes + 1)).ravel()
    return points, np.tile(weights * half, panels)
