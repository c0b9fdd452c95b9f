"""The springs of a lattice and their constants, derived from the layers' moduli.

Every box, its edges a, b, c along the axes and its volume V = a b c, is filled with three kinds of springs:

* an *edge spring* along each of its 12 edges, which resists the change of its length;
* a *scissor spring* in each of its 6 faces, which resists the difference s of the lengths of the face's diagonals:
  it resists shear and nothing else;
* a *volume spring*, which resists the change of the volume J V spanned by the means of its edges along x, y and z.

Under a homogeneous small strain e they store

    edges along x     4 k a^2 e_xx^2 / 2
    faces normal to z 2 k s^2 / 2,      s = 4 a b e_xy / sqrt(a^2 + b^2)
    volume            k (e_xx + e_yy + e_zz)^2 / 2

and the layer stores V (2 mu e_ij e_ij + lambda e_kk^2) / 2. They are equal for every e where

    k_edge = mu V / (2 a^2),    k_scissor = mu V (a^2 + b^2) / (8 a^2 b^2),    k_volume = lambda V:

the long-wave method (M. Born and K. Huang 1954, Dynamical Theory of Crystal Lattices, ch. V; for spring networks
M. Ostoja-Starzewski 2002, Appl. Mech. Rev. 55:35, sec. 2 and 3), the three kinds at right angles to each other, so no
equation is solved and no constant is ever negative, whatever the box's shape and Poisson's ratio from 0 to 0.5.
What hangs on a face or an edge of several boxes is added up there.

A prestress sigma along x pulls on each edge with sigma V / (4 a), whatever its length; see `energies`.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TypeVar

import numpy as np

from trocar.model import FloatArray
from trocar.reference.grid import IntArray
from trocar.reference.springs.boxes import Boxes
from trocar.tissues import Layer

CODES = (9, 3, 1)
"""One step along x, y, z in the number of a neighbour, 13 being the node itself: base 3, digits 0, 1, 2."""

_PLANES = ((0, 1), (0, 2), (1, 2))


@dataclass(frozen=True, eq=False)
class Edges:
    """Springs between neighbours.

    Args:
        ends: nodes, shape (n, 2).
        code: of the step from the first to the second (`CODES`), shape (n,).
        length: at rest [m].
        stiffness: [N/m].
        tension: what pulls besides [N].
    """

    ends: IntArray
    code: IntArray
    length: FloatArray
    stiffness: FloatArray
    tension: FloatArray


@dataclass(frozen=True, eq=False)
class Scissors:
    """Springs between the diagonals of a face.

    Args:
        corners: nodes around the face, shape (n, 4): the diagonals are 0 to 2 and 1 to 3.
        code: of each corner as seen from the first, shape (n, 4).
        stiffness: [N/m].
    """

    corners: IntArray
    code: IntArray
    stiffness: FloatArray


@dataclass(frozen=True, eq=False)
class Volumes:
    """Springs of the boxes' volume.

    Args:
        corners: nodes, shape (n, 8): x slowest, z fastest.
        sides: at rest [m], shape (n, 3).
        energy: stiffness [J].
    """

    corners: IntArray
    sides: FloatArray
    energy: FloatArray


Kind = TypeVar("Kind", Edges, Scissors)


@dataclass(frozen=True, eq=False)
class Springs:
    """All springs of a lattice."""

    edges: Edges
    scissors: Scissors
    volumes: Volumes


def springs(boxes: Boxes, lame: FloatArray, shear: FloatArray, tension: FloatArray) -> Springs:
    """Return the springs of boxes whose layers have these moduli.

    Args:
        boxes: the grid.
        lame: lambda of each layer [Pa], shape (layers,), 0 or above.
        shear: mu of each layer [Pa], likewise.
        tension: prestress along x, y and z [Pa], shape (layers, 3).
    """
    lam, mu, sigma = (values[boxes.element_layer] for values in (lame, shear, tension))
    sides, volume = boxes.edges, boxes.edges.prod(axis=0)
    edges, scissors = [], []
    for i in range(3):
        across = tuple(axis for axis in range(3) if axis != i)
        counts = _counts(boxes, across)
        first = boxes.first_nodes(counts)
        edges.append(
            Edges(
                ends=np.stack([first, first + boxes.strides[i]], axis=1),
                code=np.full(len(first), CODES[i]),
                length=np.broadcast_to(_along(boxes, i), counts).ravel().copy(),
                stiffness=_shared(boxes, mu * volume / (2 * sides[i] ** 2), across),
                tension=_shared(boxes, sigma[:, i] * volume / (4 * sides[i]), across),
            )
        )
    for i, j in _PLANES:
        normal = (3 - i - j,)
        first = boxes.first_nodes(_counts(boxes, normal))
        one, other = boxes.strides[i], boxes.strides[j]
        scissors.append(
            Scissors(
                corners=np.stack([first, first + one, first + one + other, first + other], axis=1),
                code=np.tile([0, CODES[i], CODES[i] + CODES[j], CODES[j]], (len(first), 1)),
                stiffness=_shared(
                    boxes,
                    mu * volume * (sides[i] ** 2 + sides[j] ** 2) / (8 * (sides[i] * sides[j]) ** 2),
                    normal,
                ),
            )
        )
    first = boxes.first_nodes(boxes.shape)
    steps = np.array([np.dot(corner, boxes.strides) for corner in np.ndindex(2, 2, 2)])
    return Springs(
        edges=_joined(Edges, edges),
        scissors=_joined(Scissors, scissors),
        volumes=Volumes(
            corners=first[:, None] + steps, sides=np.ascontiguousarray(sides.T), energy=lam * volume
        ),
    )


def layer_springs(boxes: Boxes, layers: tuple[Layer, ...]) -> Springs:
    """Return the springs of layers, prestress included."""
    return springs(
        boxes,
        np.array([layer.lame_lambda for layer in layers]),
        np.array([layer.shear_modulus for layer in layers]),
        np.array([(layer.prestress_x, layer.prestress_y, 0.0) for layer in layers]),
    )


def weighted_springs(boxes: Boxes, layers: tuple[Layer, ...], weights: list[float]) -> Springs:
    """Return the springs of layers, each times a weight, without prestress: dashpots where the weights are times."""
    share = np.array(weights)
    return springs(
        boxes,
        share * np.array([layer.lame_lambda for layer in layers]),
        share * np.array([layer.shear_modulus for layer in layers]),
        np.zeros((len(layers), 3)),
    )


def masses(boxes: Boxes, layers: tuple[Layer, ...]) -> FloatArray:
    """Return the mass of each node [kg], shape (nodes,): an eighth of every box around it."""
    density = np.array([layer.density for layer in layers])[boxes.element_layer]
    return _shared(boxes, density * boxes.edges.prod(axis=0) / 8, (0, 1, 2))


def _counts(boxes: Boxes, axes: tuple[int, ...]) -> tuple[int, int, int]:
    """Return the number of boxes along x, y, z, and along some axes that of nodes."""
    x, y, z = (count + (axis in axes) for axis, count in enumerate(boxes.shape))
    return x, y, z


def _along(boxes: Boxes, axis: int) -> FloatArray:
    """Return the lengths of the boxes along an axis [m], shaped to spread over the others."""
    lengths: FloatArray = np.diff((boxes.x, boxes.y, boxes.z)[axis])
    return lengths.reshape([-1 if other == axis else 1 for other in range(3)])


def _joined(kind: type[Kind], parts: list[Kind]) -> Kind:
    """Return springs of one kind end to end."""
    return kind(
        **{part.name: np.concatenate([getattr(one, part.name) for one in parts]) for part in fields(kind)}
    )


def _shared(boxes: Boxes, values: FloatArray, axes: tuple[int, ...]) -> FloatArray:
    """Add what boxes give to their sides along some axes; what is left over is what several boxes share."""
    result = values.reshape(boxes.shape)
    for axis in axes:
        before, after = (
            [(side if other == axis else (0, 0)) for other in range(3)] for side in ((1, 0), (0, 1))
        )
        result = np.pad(result, before) + np.pad(result, after)
    return result.ravel()
