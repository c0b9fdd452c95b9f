"""The nodes of a block and how far each is felt: graded planes of them, one on every interface, doubled on cuts.

A node's support is a box with its own reach on each of its six sides: DILATION times the distance to the next node
there, and never past a face of the node's layer, a held side or a mirror. So on an interface, on the base and on the
sides no nodes count but those of the face itself, which both layers share: fields are continuous across an interface,
their slopes jump there, and holding the nodes of a face holds all of the face. (L. W. Cordes and B. Moran 1996, Comput.
Methods Appl. Mech. Eng. 139:75, truncate supports at interfaces likewise and join the layers by multipliers.)
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from trocar.model import FloatArray, Load, Support
from trocar.reference.block import MeshSize, quarter_mesh
from trocar.reference.grid import IntArray
from trocar.reference.mesh_free.cut import ALONG, CORNER, DOWN, NORMAL, Cut, on_the_cut
from trocar.reference.parity import mirrored_lines
from trocar.tissues import Tissue

BoolArray = npt.NDArray[np.bool_]

DILATION = (1.6, 1.6, 1.0)
"""Reach of a node over the distance to the next one, along x, y and z [1].

Along z the next plane ends it: 1.3 there is as accurate for twice the neighbours.
"""

DILATION_AT_CUTS = 2.05
"""The same along x and y beside cuts [1]: from either side two nodes in a row are always felt."""

_THIN = 0.1  # of the smallest tool's radius: a thinner layer stretches more than it bends
_NEAR = 1e-7  # of the block's longest side: nearer nodes lie in a cut
_SAME_PLACE = 1e-9  # of the block's size: rounding in where a copy is seen, far below _NEAR
_APART = 4.0  # of that: by how much the copies of a node are moved apart when it is asked what is seen


class Cloud(NamedTuple):
    """Nodes, supports and cuts; a tuple of arrays, so that compiled functions take it.

    Args:
        x, y, z: planes of nodes [m], ascending; the cells of the quadrature lie between them.
        slab_layer: the layer between two z planes, shape (len(z) - 1,).
        places: of the nodes [m], shape (n, 3); first the grid's, z fastest, then the copies on cuts.
        seen_at: the same, copies moved apart.
        below, above: reach of the supports towards lower and higher coordinates [m], shape (n, 3).
        copy: the next copy of a node or -1, shape (n,).
        cuts: frames of the cuts, shape (cuts, 4, 3).
        lines: how many planes further a support may reach, along x, y, z; shape (3,).
    """

    x: FloatArray
    y: FloatArray
    z: FloatArray
    slab_layer: IntArray
    places: FloatArray
    seen_at: FloatArray
    below: FloatArray
    above: FloatArray
    copy: IntArray
    cuts: FloatArray
    lines: IntArray


def scatter(
    tissue: Tissue,
    size: tuple[float, float],
    support: Support,
    around: Load,
    spacing: MeshSize,
    cuts: tuple[Cut, ...] = (),
    *,
    mirrored: bool = False,
) -> Cloud:
    """Place the nodes of a block.

    Args:
        tissue: the layers.
        size: sides of the block [m].
        support: how it is held.
        around: presses under which nodes lie close together; at least one.
        spacing: how closely.
        cuts: what is cut.
        mirrored: whether to place those of the quarter 0 <= x <= a/2, 0 <= y <= b/2 alone.

    Raises:
        InputError: a footprint is off the block.
    """
    quarter = quarter_mesh(tissue, size, support, around, spacing)
    x, y = quarter.x, quarter.y
    if not mirrored:
        x, y = (mirrored_lines(half, side) for half, side in zip((x, y), size, strict=True))
    z, slab_layer = _split(quarter.z, quarter.slab_layer, _THIN * min(press.radius for press in around))
    ends_x, ends_y = (np.array([0, len(lines) - 1]) for lines in (x, y))
    faces = np.array([0, *(np.flatnonzero(np.diff(slab_layer)) + 1), len(z) - 1])
    places = _grid(x, y, z)
    usual, wide = (
        [_reach(x, ends_x, along[0]), _reach(y, ends_y, along[1]), _reach(z, faces, along[2])]
        for along in (DILATION, (DILATION_AT_CUTS, DILATION_AT_CUTS, DILATION[2]))
    )
    below, above, wider_below, wider_above = (
        _grid(*(reach[side] for reach in reaches)) for reaches in (usual, wide) for side in (0, 1)
    )
    frames = np.array([cut.frame(size, tissue.thickness) for cut in cuts]).reshape(-1, 4, 3)
    for frame in frames:
        beside = _beside(frame, places - wider_below, places + wider_above)
        below[beside], above[beside] = wider_below[beside], wider_above[beside]
    parent, seen_at, copy = _doubled(places, frames, _NEAR * max(*size, tissue.thickness))
    return Cloud(
        x=x,
        y=y,
        z=z,
        slab_layer=slab_layer,
        places=places[parent],
        seen_at=seen_at,
        below=below[parent],
        above=above[parent],
        copy=copy,
        cuts=frames,
        lines=np.array([int(np.ceil(dilation)) + 1 for dilation in (DILATION_AT_CUTS,) * 2 + DILATION[2:]]),
    )


def held_nodes(cloud: Cloud, support: Support, *, mirrored: bool) -> BoolArray:
    """Return which displacement components support and mirrors hold at zero, shape (n, 3)."""
    held = np.zeros(cloud.places.shape, dtype=np.bool_)
    if support.base_held:
        held |= (cloud.places[:, 2] == cloud.z[0])[:, None]
    for axis, lines in enumerate((cloud.x, cloud.y)):
        side, far = cloud.places[:, axis] == lines[0], cloud.places[:, axis] == lines[-1]
        if mirrored:
            held[:, axis] |= far
        else:
            side |= far
        for component in range(3):
            if support.sides_clamped or component != axis:
                held[:, component] |= side
    return held


def _split(z: FloatArray, slab_layer: IntArray, thin: float) -> tuple[FloatArray, IntArray]:
    """Return z planes with two slabs at least in every layer that is thicker than `thin` [m].

    A single slab that bends along x and y at once is 30 % too soft (`stiffness`).
    """
    for layer in range(slab_layer[0] + 1):
        slabs = np.flatnonzero(slab_layer == layer)
        lower, upper = z[slabs[0]], z[slabs[0] + 1]
        if len(slabs) == 1 and upper - lower > thin:
            z = np.insert(z, slabs[0] + 1, 0.5 * (lower + upper))
            slab_layer = np.insert(slab_layer, slabs[0], layer)
    return z, slab_layer


def _beside(frame: FloatArray, low: FloatArray, high: FloatArray) -> BoolArray:
    """Return which boxes, corners of shape (n, 3), meet the box around a cut; shape (n,)."""
    ends = frame[CORNER] + np.stack([0 * frame[ALONG], frame[ALONG], frame[DOWN], frame[ALONG] + frame[DOWN]])
    return np.asarray(((low <= ends.max(axis=0)) & (high >= ends.min(axis=0))).all(axis=1))


def _grid(x: FloatArray, y: FloatArray, z: FloatArray) -> FloatArray:
    return np.ascontiguousarray(np.stack(np.meshgrid(x, y, z, indexing="ij"), axis=-1).reshape(-1, 3))


def _reach(lines: FloatArray, faces: IntArray, dilation: float) -> tuple[FloatArray, FloatArray]:
    """Return how far the nodes of planes are felt below and above them [m]; faces are not reached across."""
    apart = np.diff(lines)
    below, above = (dilation * np.append(*pair) for pair in ((apart[:1], apart), (apart, apart[-1:])))
    for number in range(len(lines)):
        lower, upper = faces[faces < number], faces[faces > number]
        if len(lower):
            below[number] = min(below[number], lines[number] - lines[lower[-1]])
        if len(upper):
            above[number] = min(above[number], lines[upper[0]] - lines[number])
    return below, above


def _doubled(places: FloatArray, frames: FloatArray, near: float) -> tuple[IntArray, FloatArray, IntArray]:
    """Return of every node and copy: the node it is a copy of, where it is seen [m], and its next copy."""
    parent, seen_at = np.arange(len(places)), places.copy()
    copy = np.full(len(places), -1)
    for frame in frames:
        twice = np.flatnonzero(on_the_cut(frame, places[parent], near))
        apart = _APART * near * frame[NORMAL]
        fresh = len(parent) + np.arange(len(twice))
        copy = np.append(copy, copy[twice])
        copy[twice] = fresh
        parent = np.append(parent, parent[twice])
        seen_at = np.concatenate([seen_at, seen_at[twice] - apart])
        seen_at[twice] += apart
    return parent, seen_at, copy


def inherited(new: Cloud, old: Cloud, field: FloatArray) -> FloatArray:
    """Return a field of a cloud's nodes, shape (n, 3), from that of the same nodes cut otherwise.

    A copy takes over from the copy on its side; where a cut was joined, from the mean of both sides.
    """
    result = np.empty_like(new.places)
    for root in range(len(old.x) * len(old.y) * len(old.z)):
        candidates = _copies(old, root)
        for node in _copies(new, root):
            apart = np.linalg.norm(old.seen_at[candidates] - new.seen_at[node], axis=1)
            nearest = apart <= apart.min() + _SAME_PLACE * np.abs(new.places[-1]).max()
            result[node] = field[candidates[nearest]].mean(axis=0)
    return result


def _copies(cloud: Cloud, root: int) -> IntArray:
    found = [root]
    while (after := int(cloud.copy[found[-1]])) >= 0:
        found.append(after)
    return np.array(found)
