"""What the faces of the layers change of how stress in a ball strains it: Gamma in the layers, less in an endless body.

Both are sums over plane waves along the layers, exp(i k.x), each a problem through the thickness (`thin_layer`): with
u_z = W, i V along k and i S across it, in the frame of k,

    e_ll = -k V,   e_zz = W',   2 e_lz = i (V' + k W),   2 e_tz = i S',   2 e_lt = -k S.

The endless body is a stack so thick that its ends do not matter. Both have the same elements around the ball, so that
what is wrong of a ball's own strain is wrong in both, and the difference is smooth.
"""

from __future__ import annotations

from dataclasses import replace
from math import pi, sqrt

import numpy as np

from trocar.model import FloatArray
from trocar.tissues.layer import Layer
from trocar.tissues.nodule import Nodule
from trocar.tissues.tissue import Tissue
from trocar.waves.easing import MANDEL, PAIRS, ball_points, ball_polynomials
from trocar.waves.thin_layer import ThinLayers, Wavenumbers, horizontal_shear, profile_of, vertical_and_along

_ELEMENT = (
    0.15  # of the ball's radius: longest element of the layers, and of the endless body around the ball
)
_BEYOND, _GROWTH = (
    6.0,
    1.3,
)  # radii of endless body above and below, at least; of its elements, one to the next
_POINTS = (16, 6, 16)  # of the ball
_SHORTEST = 12.0  # largest wavenumber, in inverse radii: a ball's polynomials hold little of shorter waves
_WAVENUMBERS, _TURNS = 28, 12


def image_in_layers(tissue: Tissue, nodule: Nodule, host: Layer, degree: int) -> FloatArray:
    """Return the difference between a ball's polynomials [1/J], shape (polynomials, 6, polynomials, 6).

    Args:
        tissue: the layers, base held.
        nodule: the ball.
        host: the layer it lies in.
        degree: of the polynomials.
    """
    points, shares = ball_points(*_POINTS)
    weights = shares[:, None] * ball_polynomials(points, degree)
    slices = points[:: len(points) // _POINTS[0], 2] * nodule.radius - nodule.depth
    longest = _ELEMENT * nodule.radius
    lengths = [_even(layer.thickness, longest) for layer in tissue.layers]
    number = tissue.layers.index(host)
    beyond = _growing(lengths[number][0], _BEYOND * nodule.radius)
    endless = np.concatenate([beyond[::-1], lengths[number], beyond])
    lowered = beyond.sum() - sum(layer.thickness for layer in tissue.layers[:number])
    stacks = [
        (tissue, lengths, slices),
        (Tissue(layers=(replace(host, thickness=float(endless.sum())),)), [endless], slices - lowered),
    ]
    nodes, gauss = np.polynomial.legendre.leggauss(_WAVENUMBERS)
    k = 0.5 * (1 + nodes) * _SHORTEST / nodule.radius
    upright = _difference(k, [_upright(*stack, k) for stack in stacks])
    across = _difference(k, [_across(*stack, k) for stack in stacks])
    total = np.zeros((weights.shape[1], 6, weights.shape[1], 6))
    flat = points[:, :2] * nodule.radius
    for turn in 2 * pi * (np.arange(_TURNS) + 0.5) / _TURNS:
        phase = np.exp(1j * np.outer(k, flat @ (np.cos(turn), np.sin(turn))))
        sliced = (phase[:, :, None] * weights).reshape(len(k), _POINTS[0], -1, weights.shape[1]).sum(axis=2)
        seen = _turned(turn)
        for frame, of_k in (
            (seen[:, (0, 2, 4)] * np.array([1, 1, 1j / sqrt(2)]), upright),
            (seen[:, (3, 5)] * np.array([1j / sqrt(2), 1 / sqrt(2)]), across),
        ):
            own = np.einsum("khm,as->kmash", sliced, frame).reshape(len(k), weights.shape[1] * 6, -1)
            share = 0.5 * gauss * _SHORTEST / nodule.radius * k / (2 * pi * _TURNS)
            part = (own * share[:, None, None]) @ of_k @ own.conj().swapaxes(1, 2)
            total += part.sum(axis=0).real.reshape(total.shape)
    return total


def _even(thickness: float, longest: float) -> FloatArray:
    count = int(np.ceil(thickness / longest))
    return np.full(count, thickness / count)


def _growing(first: float, least: float) -> FloatArray:
    """Return lengths that grow from one a little above the first, to at least so much together [m]."""
    count = int(np.ceil(np.log1p(least * (_GROWTH - 1) / (first * _GROWTH)) / np.log(_GROWTH)))
    return np.asarray(first * _GROWTH ** np.arange(1.0, count + 1))


def _upright(
    tissue: Tissue, lengths: list[FloatArray], z: FloatArray, k: FloatArray
) -> tuple[ThinLayers, FloatArray]:
    """Return the stack, and what reads e_ll, e_zz and V' + k W at heights of it; shape (J, 3, h, unknowns)."""
    layers = vertical_and_along(tissue, base_held=True, lengths=lengths)
    value, slope = profile_of(lengths, layers, z)
    read = np.zeros((len(k), 3, len(z), layers.size))
    read[:, 0, :, 1::2] = -k[:, None, None] * value
    read[:, 1, :, 0::2] = slope
    read[:, 2, :, 1::2] = slope
    read[:, 2, :, 0::2] = k[:, None, None] * value
    return layers, read


def _across(
    tissue: Tissue, lengths: list[FloatArray], z: FloatArray, k: FloatArray
) -> tuple[ThinLayers, FloatArray]:
    """Return the stack, and what reads S' and -k S at heights of it; shape (J, 2, h, unknowns)."""
    layers = horizontal_shear(tissue, base_held=True, lengths=lengths)
    value, slope = profile_of(lengths, layers, z)
    read = np.zeros((len(k), 2, len(z), layers.size))
    read[:, 0] = slope
    read[:, 1] = -k[:, None, None] * value
    return layers, read


def _difference(k: FloatArray, stacks: list[tuple[ThinLayers, FloatArray]]) -> FloatArray:
    """Return what is read per unit of what acts likewise, in the first stack less in the second, (J, n h, n h)."""
    found = []
    for layers, read in stacks:
        rows = read.reshape(len(k), -1, layers.size)
        stiffness = layers.stiffness(Wavenumbers(k, 0.5 * k**2, 0.5 * k**2))
        found.append(rows @ np.linalg.solve(stiffness, rows.swapaxes(1, 2)))
    return np.asarray(found[0] - found[1])


def _turned(turn: float) -> FloatArray:
    """Return strains in x, y, z of those along, across and upright, both in Mandel's order, shape (6, 6)."""
    axes = np.array([[np.cos(turn), -np.sin(turn), 0.0], [np.sin(turn), np.cos(turn), 0.0], [0.0, 0.0, 1.0]])
    found = np.empty((6, 6))
    for column, (i, j) in enumerate(PAIRS):
        tensor = 0.5 * (np.outer(axes[:, i], axes[:, j]) + np.outer(axes[:, j], axes[:, i]))
        for row, (p, q) in enumerate(PAIRS):
            found[row, column] = MANDEL[row] * MANDEL[column] * tensor[p, q]
    return found
