"""What a dent stores by stretching a sheet: the membrane energy of a plate under moderate rotations.

A deflection w stretches the sheet by e = (w_x^2 / 2, w_y^2 / 2, w_x w_y), and the sheet gives way sideways, by v, as
far as that helps (A. Foppl 1907; T. von Karman 1910; Timoshenko and Woinowsky-Krieger 1959, section 102). With the
moduli D of `moduli` and a bed that resists v with a stiffness B, the energy is

    V(w) = min over v of 1/2 integral of (e + b v) . D (e + b v) + v . B v,

b v being the strain of v. In waves cos(kx x) cos(ky y) of e_x and e_y and sin sin of the shear, which the products of
the series of w are, every wavenumber minimises by itself, so V = 1/2 sum over wavenumbers of e . Q e with

    Q = D - D b (b^T D b + B)^-1 b^T D,

a table made once. At wavenumber zero nothing can give way: Q = D, the sides being immovable, and the energy of that
wave alone is Kirchhoff and Carrier's stretch-dependent tension, along x and y by itself (G. Kirchhoff 1876; G. F.
Carrier 1945, Q. Appl. Math. 3:157), which for a plate is Berger's (H. M. Berger 1955, J. Appl. Mech. 22:465). The
others carry a local dent: it draws its sheet in from around it, and is stiffened by what Gaussian curvature cannot be
bent without. Nothing here is fitted.

V is evaluated at midpoints, one more than twice as many along each side as there are waves: exactly. It is a polynomial
of fourth degree in the amplitudes, and its discrete gradient between two shapes (O. Gonzalez 1996, J. Nonlinear Sci.
6:449) is exact too: G(w0, w1) . (w1 - w0) = V(w1) - V(w0) to rounding.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trocar.model import FloatArray
from trocar.tissues.tissue import Tissue
from trocar.waves.banded import surface_compliance
from trocar.waves.series import Series
from trocar.waves.stretch.moduli import MembraneModuli
from trocar.waves.thin_layer import Wavenumbers, horizontal_shear, vertical_and_along


@dataclass(frozen=True)
class Stretched:
    """A shape of the sheet.

    Attributes:
        slope_x, slope_y: of w at the midpoints [1], shape (I, J).
        strain: waves of e_x, e_y and of the shear angle [1], shape (3, I, J).
    """

    slope_x: FloatArray
    slope_y: FloatArray
    strain: FloatArray


class StretchEnergy:
    """V of a sheet on the rectangle of a series, and its gradients.

    Args:
        series: the waves of the deflection.
        moduli: of the sheet.
        bed: what it lies on, base held; None where it is free to be drawn sideways.
    """

    def __init__(self, series: Series, moduli: MembraneModuli, bed: Tissue | None = None) -> None:
        a, b = series.size
        points = 2 * series.modes[0] + 1, 2 * series.modes[1] + 1  # strain has waves to twice the highest
        self.series = series
        self._cell = a * b / (points[0] * points[1])
        self._sin_x, self._cos_x = _waves(series.kx[1:], a, points[0])
        self._sin_y, self._cos_y = _waves(series.ky[1:], b, points[1])
        (self._sines_x, self._cosines_x), (self._sines_y, self._cosines_y) = map(_transforms, points)
        self._relaxed = _relaxed_moduli(series.size, points, moduli, bed)

    def at(self, w: FloatArray) -> Stretched:
        """Return the stretched sheet under amplitudes w of the deflection [m], shape (M, N)."""
        kx, ky = self.series.kx[1:, None], self.series.ky[1:]
        slope_x = self._cos_x @ (kx * w) @ self._sin_y.T
        slope_y = self._sin_x @ (w * ky) @ self._cos_y.T
        strain = np.empty((3, *slope_x.shape))
        strain[0] = self._cosines_x @ (0.5 * slope_x**2) @ self._cosines_y.T
        strain[1] = self._cosines_x @ (0.5 * slope_y**2) @ self._cosines_y.T
        strain[2] = self._sines_x @ (slope_x * slope_y) @ self._sines_y.T
        return Stretched(slope_x, slope_y, strain)

    def energy(self, shape: Stretched) -> float:
        """Return V [J]."""
        return 0.5 * self._cell * float(np.sum(shape.strain * self._forces(shape.strain)))

    def gradient(self, shape: Stretched) -> FloatArray:
        """Return dV/dw, the sheet's resistance to each wave [N], shape (M, N)."""
        return self._pull(shape.strain, shape.slope_x, shape.slope_y)

    def between(self, start: Stretched, end: Stretched) -> FloatArray:
        """Return the discrete gradient from one shape to another [N], shape (M, N)."""
        return self._pull(
            0.5 * (start.strain + end.strain),
            0.5 * (start.slope_x + end.slope_x),
            0.5 * (start.slope_y + end.slope_y),
        )

    def mean_tension(self, shape: Stretched) -> tuple[float, float]:
        """Return the sheet's mean tension along x and along y [N/m]: Kirchhoff and Carrier's."""
        mean = self._forces(shape.strain)[:2, 0, 0] / np.sqrt(shape.slope_x.size)
        return float(mean[0]), float(mean[1])

    def _pull(self, strain: FloatArray, slope_x: FloatArray, slope_y: FloatArray) -> FloatArray:
        waves = self._forces(strain)
        along_x, along_y = (self._cosines_x.T @ wave @ self._cosines_y for wave in waves[:2])
        shear = self._sines_x.T @ waves[2] @ self._sines_y
        flow_x = along_x * slope_x + shear * slope_y
        flow_y = along_y * slope_y + shear * slope_x
        kx, ky = self.series.kx[1:, None], self.series.ky[1:]
        pull = kx * (self._cos_x.T @ flow_x @ self._sin_y) + (self._sin_x.T @ flow_y @ self._cos_y) * ky
        result: FloatArray = self._cell * pull
        return result

    def _forces(self, strain: FloatArray) -> FloatArray:
        """Return the waves of the membrane forces [N/m]; both of shape (3, I, J)."""
        result: FloatArray = np.einsum("cdij,dij->cij", self._relaxed, strain)
        return result


def _waves(k: FloatArray, side: float, points: int) -> tuple[FloatArray, FloatArray]:
    """Return sin(k x) and cos(k x) at the midpoints of as many cells, shape (points, len(k))."""
    phase = np.outer((np.arange(points) + 0.5) * (side / points), k)
    return np.sin(phase), np.cos(phase)


def _transforms(points: int) -> tuple[FloatArray, FloatArray]:
    """Return orthonormal sines and cosines of waves 0, 1, ... at as many midpoints; the sine of wave 0 is empty."""
    phase = np.outer(np.arange(points), (np.arange(points) + 0.5) * (np.pi / points))
    scale = np.sqrt(np.where(np.arange(points) == 0, 1.0, 2.0) / points)[:, None]
    return scale * np.sin(phase), scale * np.cos(phase)


def _relaxed_moduli(
    size: tuple[float, float], points: tuple[int, int], moduli: MembraneModuli, bed: Tissue | None
) -> FloatArray:
    """Return Q of every wavenumber [N/m], shape (3, 3, I, J)."""
    kx, ky = np.meshgrid(
        *(np.arange(count) * (np.pi / side) for side, count in zip(size, points, strict=True)), indexing="ij"
    )
    stiffness = np.array(
        [
            [moduli.along_x, moduli.across, 0.0],
            [moduli.across, moduli.along_y, 0.0],
            [0.0, 0.0, moduli.shear],
        ]
    )
    # v = (sin cos, cos sin): strains kx v_x in cos cos, ky v_y in cos cos, -(ky v_x + kx v_y) in sin sin.
    b = np.zeros((*points, 3, 2))
    b[..., 0, 0], b[..., 1, 1] = kx, ky
    b[..., 2, 0], b[..., 2, 1] = -ky, -kx
    drawn = stiffness @ b
    resists = np.swapaxes(b, -1, -2) @ drawn + _bed_stiffness(kx, ky, bed)
    for axis, k in ((0, kx), (1, ky)):  # a sideways wave that does not exist gives way to nothing
        resists[..., axis, axis] += np.where(k == 0, 1.0, 0.0) * moduli.along_x / min(size) ** 2
    relaxed = stiffness - drawn @ np.linalg.solve(resists, np.swapaxes(drawn, -1, -2))
    flat = (kx == 0) | (ky == 0)
    relaxed[flat, 2, :] = relaxed[flat, :, 2] = 0.0
    return np.ascontiguousarray(np.moveaxis(relaxed, (2, 3), (0, 1)))


def _bed_stiffness(kx: FloatArray, ky: FloatArray, bed: Tissue | None) -> FloatArray:
    """Return how a bed resists being drawn sideways on top [N/m3], shape (I, J, 2, 2)."""
    result = np.zeros((*kx.shape, 2, 2))
    if bed is None:
        return result
    k = np.hypot(kx, ky).ravel()
    moving = np.flatnonzero(k)
    distinct, places = np.unique(np.round(k[moving] * bed.thickness, 12), return_inverse=True)
    at = Wavenumbers(distinct / bed.thickness, 0 * distinct, 0 * distinct)
    along = 1 / surface_compliance(vertical_and_along(bed, base_held=True), at)[:, 0, 1, 1]
    beside = 1 / surface_compliance(horizontal_shear(bed, base_held=True), at)[:, 0, 0, 0]
    toward = np.stack([kx.ravel()[moving], ky.ravel()[moving]], axis=1) / k[moving, None]
    outer = toward[:, :, None] * toward[:, None, :]
    flat = result.reshape(-1, 2, 2)
    flat[moving] = along[places, None, None] * outer + beside[places, None, None] * (np.eye(2) - outer)
    return flat.reshape(*kx.shape, 2, 2)
