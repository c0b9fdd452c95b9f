"""Thin layers: a layered half of the problem solved through the thickness, one wavenumber at a time.

With u_z = W(z) sin sin, u_x = (kx V - ky S)/k cos sin, u_y = (ky V + kx S)/k sin cos (k^2 = kx^2 + ky^2), linear
elasticity of layers splits per wavenumber into W and V (vertical, and in-plane along the wave vector) and S
(horizontally polarised shear). The elastic energy per unit area of the mode is

    1/2 int lambda (W' - k V)^2 + 2 mu (W'^2 + k^2 V^2) + mu (V' + k W)^2 dz,     1/2 int mu (S'^2 + k^2 S^2) dz,

and a prestress adds (sigma_x kx^2 + sigma_y ky^2) (W^2 + V^2 + S^2). Quadratic elements in z turn each into banded
matrices that are quadratic in k (Lysmer 1970, Bull Seismol Soc Am 60:89; Kausel and Roesset 1981, ibid. 71:1743).
The volume term is integrated with two Gauss points an element, so that Poisson's ratios near 0.5 do not lock.

Unknowns run from the base up, so that the tool's force is the last of them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from math import inf

import numpy as np

from trocar.model import FloatArray
from trocar.tissues.layer import Layer
from trocar.tissues.tissue import Tissue

Element = Callable[[Layer, float], tuple[FloatArray, FloatArray, FloatArray, FloatArray]]
_GROWTH = 0.5  # element length over its depth below the surface: a wave k dies as exp(-k depth)
_TOP = 0.6  # first element as a share of the top layer, or of a thick one's upper part
_SHALLOW = 0.03  # that part, as a share of the whole: tools are that wide at least
_PER_LAYER = 5  # elements through the thickest layer at least: waves inside it


@dataclass(frozen=True)
class Wavenumbers:
    """The J wavenumbers a family of matrices is wanted for.

    Attributes:
        k: magnitude [1/m], shape (J,).
        kx2, ky2: squared components [1/m2], shape (J,).
    """

    k: FloatArray
    kx2: FloatArray
    ky2: FloatArray


@dataclass(frozen=True)
class ThinLayers:
    """Matrices through the thickness of one tissue; n nodes above the held base, c components a node.

    Every matrix is a sum over layers, so damping can differ between them. Index 0 of the coefficient arrays is the
    layer. Dense (n c, n c): n is a few dozen.

    Attributes:
        constant, linear, quadratic: coefficients of 1, k and k^2 in the stiffness, shape (layers, nc, nc).
        prestress_x, prestress_y: coefficients of kx^2 and ky^2, shape (nc, nc).
        mass: shape (nc, nc).
        retardation: Kelvin-Voigt time of each layer [s], shape (layers,).
        relaxation: relaxation times of all layers, ascending [s], shape (D,).
        relaxing: weight g of each time in each layer [1], shape (D, layers).
        faces: node of each layer's upper face, top layer first.
        components: c: 2 for W and V, 1 for S.
    """

    constant: FloatArray
    linear: FloatArray
    quadratic: FloatArray
    prestress_x: FloatArray
    prestress_y: FloatArray
    mass: FloatArray
    retardation: FloatArray
    relaxation: FloatArray
    relaxing: FloatArray
    faces: tuple[int, ...]
    components: int

    def stiffness(self, at: Wavenumbers) -> FloatArray:
        """Return K per unit area, shape (J, nc, nc)."""
        k = at.k[:, None, None]
        result: FloatArray = self.constant.sum(0) + k * self.linear.sum(0) + k**2 * self.quadratic.sum(0)
        return result + at.kx2[:, None, None] * self.prestress_x + at.ky2[:, None, None] * self.prestress_y

    def damping(self, at: Wavenumbers) -> FloatArray:
        """Return C = sum over layers of retardation time times elastic stiffness, shape (J, nc, nc)."""
        return self._elastic(self.retardation, at)

    def remembered(self, at: Wavenumbers) -> FloatArray:
        """Return G = sum over layers of g times elastic stiffness for each relaxation time, shape (D, J, nc, nc)."""
        parts = [self._elastic(weights, at) for weights in self.relaxing]
        return np.array(parts) if parts else np.zeros((0, len(at.k), self.size, self.size))

    def _elastic(self, weights: FloatArray, at: Wavenumbers) -> FloatArray:
        k = at.k[:, None, None]
        constant, linear, quadratic = (
            np.tensordot(weights, part, 1) for part in (self.constant, self.linear, self.quadratic)
        )
        result: FloatArray = constant + k * linear + k**2 * quadratic
        return result

    @property
    def prestressed(self) -> bool:
        """Whether any layer is."""
        return bool(self.prestress_x.any() or self.prestress_y.any())

    @property
    def size(self) -> int:
        """Unknowns per wavenumber."""
        return len(self.mass)

    def unknown(self, layer: int, component: int) -> int:
        """Place of a component at a layer's upper face."""
        return self.components * self.faces[layer] + component


def vertical_and_along(
    tissue: Tissue,
    *,
    base_held: bool,
    refinement: int = 1,
    finest: float = inf,
    lengths: list[FloatArray] | None = None,
) -> ThinLayers:
    """Assemble the matrices of W and V (components 0 and 1).

    Args:
        tissue: the layers.
        base_held: whether the lower face cannot move.
        refinement: every element is cut into this many.
        finest: length of the first element, at most [m]; for waves shorter than a tool makes.
        lengths: the elements' of each layer, top down [m], in place of `element_lengths`.
    """
    lengths = lengths or element_lengths(tissue, finest)
    return _assemble(tissue, _element_wv, 2, lengths, base_held=base_held, refinement=refinement)


def horizontal_shear(
    tissue: Tissue, *, base_held: bool, refinement: int = 1, lengths: list[FloatArray] | None = None
) -> ThinLayers:
    """Assemble the matrices of S; arguments as in `vertical_and_along`."""
    lengths = lengths or element_lengths(tissue)
    return _assemble(tissue, _element_s, 1, lengths, base_held=base_held, refinement=refinement)


def element_lengths(tissue: Tissue, finest: float = inf) -> list[FloatArray]:
    """Return the elements' lengths [m] of each layer, top down: growing with depth, capped inside thick layers."""
    depth, lengths = 0.0, []
    first = min(_TOP * min(tissue.layers[0].thickness, _SHALLOW * tissue.thickness), finest)
    cap = max(layer.thickness for layer in tissue.layers) / _PER_LAYER
    for layer in tissue.layers:
        left, own = layer.thickness, []
        while left > 0:
            step = min(max(first, _GROWTH * depth), cap)
            step = left if left < 1.5 * step else step
            own.append(step)
            depth, left = depth + step, left - step
        lengths.append(np.array(own))
    return lengths


def profile_of(lengths: list[FloatArray], layers: ThinLayers, z: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return what reads one component through the thickness, and its slope [1/m].

    Args:
        lengths: of the elements of each layer, top down [m].
        layers: assembled of them, base held, no element cut.
        z: heights, 0 on top [m], shape (q,).

    Returns:
        Both of shape (q, nodes above the base).
    """
    upward = np.concatenate([own[::-1] for own in reversed(lengths)])
    edges = np.append(0.0, np.cumsum(upward))
    edges -= edges[-1]
    element = np.clip(np.searchsorted(edges, z, side="right") - 1, 0, len(upward) - 1)
    length = upward[element]
    s = (z - edges[element]) / length
    value, slope = (np.zeros((len(z), layers.size // layers.components + 1)) for _ in range(2))
    rows = np.arange(len(z))
    shapes = (
        ((1 - s) * (1 - 2 * s), 4 * s - 3),
        (4 * s * (1 - s), 4 - 8 * s),
        (s * (2 * s - 1), 4 * s - 1),
    )
    for node, (own, steep) in enumerate(shapes):
        value[rows, 2 * element + node] = own
        slope[rows, 2 * element + node] = steep / length
    return value[:, 1:], slope[:, 1:]


def _assemble(
    tissue: Tissue,
    element: Element,
    components: int,
    lengths: list[FloatArray],
    *,
    base_held: bool,
    refinement: int,
) -> ThinLayers:
    upward = [np.repeat(own / refinement, refinement)[::-1] for own in reversed(lengths)]
    layers = tissue.layers[::-1]
    elements = [(place, length) for place, own in enumerate(upward) for length in own]
    total = components * (2 * len(elements) + 1)
    constant, linear, quadratic = (np.zeros((len(layers), total, total)) for _ in range(3))
    prestress_x, prestress_y, mass = (np.zeros((total, total)) for _ in range(3))
    for i, (place, length) in enumerate(elements):
        span = slice(2 * i * components, (2 * i + 3) * components)
        layer = layers[place]
        k0, k1, k2, unit = element(layer, length)
        constant[place, span, span] += k0
        linear[place, span, span] += k1
        quadratic[place, span, span] += k2
        prestress_x[span, span] += layer.prestress_x * unit
        prestress_y[span, span] += layer.prestress_y * unit
        mass[span, span] += layer.density * unit
    held = components if base_held else 0
    free = slice(held, None)
    tops = np.cumsum([2 * len(own) for own in upward])[::-1] - (1 if base_held else 0)
    return ThinLayers(
        constant=constant[:, free, free],
        linear=linear[:, free, free],
        quadratic=quadratic[:, free, free],
        prestress_x=prestress_x[free, free],
        prestress_y=prestress_y[free, free],
        mass=mass[free, free],
        retardation=np.array([layer.retardation_time for layer in layers]),
        relaxation=np.array(tissue.relaxation_times),
        relaxing=np.array([[layer.relaxing(time) for layer in layers] for time in tissue.relaxation_times]),
        faces=tuple(int(top) for top in tops),
        components=components,
    )


@cache
def _shapes(points: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return weights, values and slopes of the quadratic element on [0, 1] at Gauss points, shapes (q,), (q, 3)."""
    nodes, weights = np.polynomial.legendre.leggauss(points)
    s = 0.5 * (nodes + 1)
    values = np.stack([(1 - s) * (1 - 2 * s), 4 * s * (1 - s), s * (2 * s - 1)], axis=1)
    slopes = np.stack([4 * s - 3, 4 - 8 * s, 4 * s - 1], axis=1)
    return 0.5 * weights, values, slopes


def _element_wv(layer: Layer, length: float) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Return the element's coefficients of 1, k, k^2 and its int N N, components interleaved."""
    (volume0, volume1, volume2), (shear0, shear1, shear2), unit = _reference_wv()
    lame, mu = layer.lame_lambda, layer.shear_modulus
    return (
        (lame * volume0 + mu * shear0) / length,
        lame * volume1 + mu * shear1,
        (lame * volume2 + mu * shear2) * length,
        unit * length,
    )


@cache
def _reference_wv() -> tuple[tuple[FloatArray, ...], tuple[FloatArray, ...], FloatArray]:
    """Return the coefficients of lambda and of mu for an element of length 1, and its int N N."""
    w, v = slice(0, None, 2), slice(1, None, 2)
    volume, shear = (tuple(np.zeros((6, 6)) for _ in range(3)) for _ in range(2))
    unit = np.zeros((6, 6))
    weight, value, slope = _shapes(2)
    volume[0][w, w] = np.einsum("q,qi,qj->ij", weight, slope, slope)
    volume[1][w, v] = -np.einsum("q,qi,qj->ij", weight, slope, value)  # W' V
    volume[1][v, w] = volume[1][w, v].T
    volume[2][v, v] = np.einsum("q,qi,qj->ij", weight, value, value)
    weight, value, slope = _shapes(3)
    steep, both = (np.einsum("q,qi,qj->ij", weight, shape, shape) for shape in (slope, value))
    shear[0][w, w], shear[0][v, v] = 2 * steep, steep
    shear[1][w, v] = np.einsum("q,qi,qj->ij", weight, value, slope)  # W V'
    shear[1][v, w] = shear[1][w, v].T
    shear[2][w, w], shear[2][v, v] = both, 2 * both
    unit[w, w] = unit[v, v] = both
    return volume, shear, unit


def _element_s(layer: Layer, length: float) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    weight, value, slope = _shapes(3)
    unit = np.einsum("q,qi,qj->ij", weight, value, value) * length
    steep = np.einsum("q,qi,qj->ij", weight, slope, slope) / length
    mu = layer.shear_modulus
    return mu * steep, np.zeros((3, 3)), mu * unit, unit
