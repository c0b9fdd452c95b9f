"""Clamped sides for the layered solid: tractions on the sides that undo what the series leaves free there.

A simply supported side x = 0 or x = a holds u_y and u_z; u_x, a cosine, slides. A clamp is the traction along x that
brings u_x to zero there at every depth, and likewise along y. With sines along the sides and the thin layers' nodes
through the depth, the tractions p obey

    A p = -(slide of the simply supported block),

where A is what the sides slide under tractions on themselves: the flexibility of the waves (m, n), summed over m for
the sides across x, over n for those across y, and of one wave alone where a pair of sides moves the other. Waves of
odd and of even m, or n, do not meet, which leaves four systems of about a thousand unknowns each. The sums end at the
highest mode; of the waves beyond it, whose stiffness is k^2 times a matrix, the integral is added.

In other words: of all fields that obey the clamps, the result is the nearest one in the energy norm. So what was a
static answer of the simply supported block becomes that of the clamped one. A block in motion moves as the simply
supported one does, brought to the clamped fields at every instant: the clamps' tractions do not wait for inertia.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from trocar.model import FloatArray
from trocar.waves.series import Series
from trocar.waves.thin_layer import ThinLayers, Wavenumbers

SIDE_MODES = (48, 48)  # the correction is then resolved to a few per cent of itself
_SILENT = 1e-13  # amplitude relative to the largest: below it is rounding
_PARITIES = ((0, 0), (0, 1), (1, 0), (1, 1))


@dataclass(frozen=True)
class _Waves:
    """The waves of one parity: odd or even m, odd or even n; zero where a wave or a traction does not exist.

    Attributes:
        place: of the waves in a table of all m and n.
        toward_x, toward_y: kx/k and ky/k, shape (m, n, 1).
        weight_x: wave amplitude per unit amplitude of traction on the sides across x [1/m], shape (m, 1, 1).
        weight_y: the same across y, shape (1, n, 1).
        w_along, v_along: W and V of a face per traction along the wave at a node [m/Pa], shape (m, n, faces, nodes).
        s_side: S of a face per traction beside it, the same shape.
        factor: of A in symmetric form, as `cho_factor` returns it.
        lines_x, lines_y: which n have sides across x to hold, and which m across y.
        size: sides a, b [m].
    """

    place: tuple[np.ndarray, ...]
    toward_x: FloatArray
    toward_y: FloatArray
    weight_x: FloatArray
    weight_y: FloatArray
    w_along: FloatArray
    v_along: FloatArray
    s_side: FloatArray
    factor: tuple[FloatArray, bool]
    lines_x: slice
    lines_y: slice
    size: tuple[float, float]

    def pulls(self, slide_x: FloatArray, slide_y: FloatArray) -> FloatArray:
        """Return slides of lines of the sides, times the lengths of the sides: that makes A symmetric."""
        a, b = self.size
        return np.concatenate([b * slide_x[self.lines_x].ravel(), a * slide_y[self.lines_y].ravel()])

    def slide_of_push(self, across: FloatArray) -> FloatArray:
        """Return `pulls` of what a pressure on top (M + 1, N + 1) makes slide."""
        v = across[self.place][..., None] * self.w_along[:, :, 0]
        return self.pulls((self.toward_x * v).sum(axis=0), (self.toward_y * v).sum(axis=1))

    def under_load(self, across: FloatArray, along: FloatArray, side: FloatArray) -> FloatArray:
        v = across[self.place][..., None] * self.w_along[:, :, 0]
        v += along[self.place][..., None] * self.v_along[:, :, 0]
        return self.under_slide(v, side[self.place][..., None] * self.s_side[:, :, 0])

    def under_slide(self, v: FloatArray, s: FloatArray) -> FloatArray:
        """Return W, V, S of the faces under the tractions that undo a slide; (m, n, nodes) to (3, m, n, faces)."""
        slide_x = (self.toward_x * v - self.toward_y * s).sum(axis=0)
        slide_y = (self.toward_y * v + self.toward_x * s).sum(axis=1)
        p = -cho_solve(self.factor, self.pulls(slide_x, slide_y))
        across_x, across_y = np.zeros_like(slide_x), np.zeros_like(slide_y)
        first = across_x[self.lines_x].size
        across_x[self.lines_x] = p[:first].reshape(across_x[self.lines_x].shape)
        across_y[self.lines_y] = p[first:].reshape(across_y[self.lines_y].shape)
        x, y = self.weight_x * across_x, self.weight_y * across_y[:, None]
        along, side = self.toward_x * x + self.toward_y * y, self.toward_x * y - self.toward_y * x
        return np.stack(
            [
                np.einsum("mnfz,mnz->mnf", self.w_along, along),
                np.einsum("mnfz,mnz->mnf", self.v_along, along),
                np.einsum("mnfz,mnz->mnf", self.s_side, side),
            ]
        )


class ClampedSides:
    """What clamps at the sides add to the waves of a simply supported block.

    Args:
        layers_wv: matrices of the vertical and in-plane waves.
        layers_s: matrices of the horizontally polarised shear waves, of the same nodes.
        series: the waves that resolve the clamps.
    """

    def __init__(self, layers_wv: ThinLayers, layers_s: ThinLayers, series: Series) -> None:
        self._layers_wv, self._layers_s, self._series = layers_wv, layers_s, series
        self._built: dict[tuple[int, int], _Waves] = {}

    @property
    def dofs(self) -> int:
        """Tractions on the sides that were solved for so far."""
        return sum(len(waves.factor[0]) for waves in self._built.values())

    def under_load(self, across: FloatArray, along: FloatArray, side: FloatArray) -> FloatArray:
        """Return what the clamps add to the static waves under a traction on the top face.

        Args:
            across: its amplitudes normal to the face [Pa], shape (M' + 1, N' + 1) for any M', N'.
            along: those along the wave vectors.
            side: those beside them.

        Returns:
            W, V and S of every face [m], shape (3, M + 1, N + 1, faces).
        """
        parts = np.stack([self._own(part) for part in (across, along, side)])
        return self._sum(parts[..., None], lambda waves: waves.under_load(*parts))

    def mutual(self, pressures: FloatArray) -> FloatArray:
        """Return what the clamps add to the work of pressures on each other's deflection.

        The tractions that hold the sides under one pressure work on what another makes slide: -r_i A^-1 r_j.

        Args:
            pressures: waves of each of n pressures on the top face [Pa], shape (n, M' + 1, N' + 1) for any M', N'.

        Returns:
            Shape (n, n) [J]; deflections where the pressures are those of 1 N.
        """
        own = [self._own(pressure) for pressure in pressures]
        total = np.zeros((len(own), len(own)))
        for parity in _PARITIES:
            if any(np.abs(p[parity[0] :: 2, parity[1] :: 2]).max() > _SILENT * np.abs(p).max() for p in own):
                waves = self._waves_of(parity)
                slides = np.array([waves.slide_of_push(pressure) for pressure in own])
                total -= slides @ cho_solve(waves.factor, slides.T)
        return total

    def under_slide(self, v: FloatArray, s: FloatArray) -> FloatArray:
        """Return what the clamps add to given waves V and S [m], shape (M' + 1, N' + 1, nodes); see `under_load`."""
        parts = np.stack([self._own(part) for part in (v, s)])
        return self._sum(parts, lambda waves: waves.under_slide(*(part[waves.place] for part in parts)))

    def _own(self, table: FloatArray) -> FloatArray:
        rows, columns = (min(*pair) for pair in zip(table.shape, self._series.shape, strict=False))
        own = np.zeros((*self._series.shape, *table.shape[2:]))
        own[:rows, :columns] = table[:rows, :columns]
        return own

    def _waves_of(self, parity: tuple[int, int]) -> _Waves:
        if parity not in self._built:
            self._built[parity] = _waves(self._layers_wv, self._layers_s, self._series, parity)
        return self._built[parity]

    def _sum(self, parts: FloatArray, answer: Callable[[_Waves], FloatArray]) -> FloatArray:
        loudness = np.abs(parts).max(axis=(0, 3))
        total = np.zeros((3, *self._series.shape, len(self._layers_wv.faces)))
        for parity in _PARITIES:
            if loudness[parity[0] :: 2, parity[1] :: 2].max() > _SILENT * max(loudness.max(), 1e-300):
                waves = self._waves_of(parity)
                total[:, parity[0] :: 2, parity[1] :: 2] = answer(waves)
        return total


def _waves(layers_wv: ThinLayers, layers_s: ThinLayers, series: Series, parity: tuple[int, int]) -> _Waves:
    """Assemble the flexibility of the sides for m = parity[0], parity[0] + 2, ... and n likewise."""
    a, b = series.size
    m, n = np.arange(parity[0], series.kx.size, 2), np.arange(parity[1], series.ky.size, 2)
    kx, ky = series.kx[m], series.ky[n]
    weight_x, weight_y = np.where(m == 0, 2 / a, 4 / a), np.where(n == 0, 2 / b, 4 / b)
    lines_x, lines_y = slice(int(n[0] == 0), None), slice(int(m[0] == 0), None)
    nodes, faces = layers_s.size, list(layers_s.faces)
    w_along, v_along, s_side = (np.zeros((len(m), len(n), len(faces), nodes)) for _ in range(3))
    toward_x, toward_y = np.zeros((len(m), len(n))), np.zeros((len(m), len(n)))
    across_x = b * _beyond(layers_wv, layers_s, ky, kx[-1] + np.pi / a, layers_s.prestress_x)
    across_y = a * _beyond(layers_wv, layers_s, kx, ky[-1] + np.pi / b, layers_s.prestress_y)
    both = np.zeros((len(n), nodes, len(m), nodes))
    for i in range(len(m)):
        k = np.hypot(kx[i], ky)
        k[k == 0] = np.pi / a  # there is no wave m = n = 0: whatever it yields is multiplied by 0
        at = Wavenumbers(k, np.full(len(n), kx[i] ** 2), ky**2)
        flexibility = np.linalg.inv(layers_wv.stiffness(at))
        w, v = flexibility[:, 0::2, 1::2], flexibility[:, 1::2, 1::2]
        s = np.linalg.inv(layers_s.stiffness(at))
        w_along[i], v_along[i], s_side[i] = w[:, faces], v[:, faces], s[:, faces]
        toward_x[i], toward_y[i] = c, d = kx[i] / k, ky / k
        c, d = c[:, None, None], d[:, None, None]
        across_x += b * weight_x[i] * (c**2 * v + d**2 * s)
        across_y[i] += a * np.einsum("n,nzy->zy", weight_y, d**2 * v + c**2 * s)
        both[:, :, i] = 4.0 * c * d * (v - s)
    return _Waves(
        place=np.ix_(m, n),
        toward_x=toward_x[..., None],
        toward_y=toward_y[..., None],
        weight_x=weight_x[:, None, None],
        weight_y=weight_y[None, :, None],
        w_along=w_along,
        v_along=v_along,
        s_side=s_side,
        factor=_factorised(across_x[lines_x], across_y[lines_y], both[lines_x, :, lines_y]),
        lines_x=lines_x,
        lines_y=lines_y,
        size=series.size,
    )


def _factorised(across_x: FloatArray, across_y: FloatArray, both: FloatArray) -> tuple[FloatArray, bool]:
    """Factorise A from its diagonal blocks (n, nodes, nodes) and (m, nodes, nodes) and what couples them."""
    nodes = both.shape[1]
    first = len(across_x) * nodes
    matrix = np.zeros((first + len(across_y) * nodes,) * 2)
    for i, block in enumerate([*across_x, *across_y]):
        span = slice(i * nodes, (i + 1) * nodes)
        matrix[span, span] = block
    matrix[:first, first:] = both.reshape(first, -1)
    factor, lower = cho_factor(matrix, lower=False, overwrite_a=True)  # reads the upper half
    return factor, lower


def _beyond(
    layers_wv: ThinLayers, layers_s: ThinLayers, k: FloatArray, first: float, prestress: FloatArray
) -> FloatArray:
    """Return what the waves beyond the last add to the slide of a pair of sides.

    There the stiffness is that of k^2 alone, and the sum over every second wave is an integral.

    Args:
        layers_wv: matrices of the vertical and in-plane waves.
        layers_s: those of the shear waves.
        k: wavenumbers along the sides [1/m], shape (n,).
        first: wavenumber across them that the integral begins at [1/m].
        prestress: across them, between nodes.

    Returns:
        Shape (n, nodes, nodes) [m/Pa].
    """
    along = np.linalg.inv(layers_wv.quadratic.sum(0)[1::2, 1::2] + prestress)
    beside = np.linalg.inv(layers_s.quadratic.sum(0) + prestress)
    angle = np.where(k > 0, np.arctan2(k, first) / np.where(k > 0, k, 1.0), 1 / first)
    ratio = first / (first**2 + k**2)
    # The integrals of kx^2/k^4 and ky^2/k^4 are half of angle +- ratio; a side has its length over 2 pi waves to a unit
    # of kx, each with the weight 4 over that length.
    pure, mixed = (angle + ratio) / np.pi, (angle - ratio) / np.pi
    result: FloatArray = pure[:, None, None] * along + mixed[:, None, None] * beside
    return result
