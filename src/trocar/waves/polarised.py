"""Loads and displacements of the layered solid in waves: across the face, along each wave vector and beside it."""

from __future__ import annotations

import numpy as np

from trocar.model import FloatArray, Press
from trocar.tissues.tissue import Tissue
from trocar.waves.footprint import modal_forces
from trocar.waves.series import Series
from trocar.waves.thin_layer import Wavenumbers

_SILENT = 1e-13  # modal force relative to the largest: below it is rounding (a central tool's even modes)


def turned_to_axes(w: FloatArray, v: FloatArray, s: FloatArray, series: Series) -> FloatArray:
    """Turn W, V and S, shape (M + 1, N + 1, faces), into u_x, u_y, u_z, shape (faces, 3, M + 1, N + 1)."""
    kx, ky = _directions(series)
    return np.ascontiguousarray(np.moveaxis(np.stack([kx * v - ky * s, ky * v + kx * s, w]), 3, 0))


def _directions(series: Series) -> tuple[FloatArray, FloatArray]:
    """Return kx/k and ky/k, each of shape (M + 1, N + 1, 1)."""
    kx, ky = series.kx[:, None, None], series.ky[None, :, None]
    k = np.hypot(kx, ky)
    k[0, 0] = 1.0
    return kx / k, ky / k


def polarised(press: Press, series: Series) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the traction's amplitudes [Pa] across the face, along each wave vector and beside it."""
    forces = modal_forces(press, series)
    a, b = series.size
    norm = np.full(forces.shape[1:], 4 / (a * b))
    norm[0, :] *= 0.5
    norm[:, 0] *= 0.5
    fx, fy, fz = forces * norm
    kx, ky = _directions(series)
    along = kx[..., 0] * fx + ky[..., 0] * fy
    along[0, :] = along[:, 0] = 0.0  # without a sine of its own such a wave has no in-plane part along it
    side = kx[..., 0] * fy - ky[..., 0] * fx
    return fz, along, side


def audible(amplitudes: FloatArray) -> np.ndarray:
    """Return which amplitudes are not rounding."""
    size = np.abs(amplitudes)
    result: np.ndarray = size > _SILENT * max(size.max(), 1e-300)
    return result


def distinct(series: Series, wanted: np.ndarray, tissue: Tissue) -> tuple[Wavenumbers, np.ndarray]:
    """Return the distinct wavenumbers among those wanted, and the place of each wanted one among them."""
    m, n = np.nonzero(wanted)
    kx2, ky2 = series.kx[m] ** 2, series.ky[n] ** 2
    k2 = kx2 + ky2
    directed = any(layer.prestress_x != layer.prestress_y for layer in tissue.layers)
    key = np.round(np.stack([k2, kx2 if directed else k2]) * (series.size[0] / np.pi) ** 2, 6)
    _, first, places = np.unique(key, axis=1, return_index=True, return_inverse=True)
    return Wavenumbers(np.sqrt(k2[first]), kx2[first], ky2[first]), places.ravel()
