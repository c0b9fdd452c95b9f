"""One tick of a live mesh, laid out for compiled code: modes that answer sites, and sites around patches that move.

As on a flat block (`trocar.waves.tick`) a force is held over a tick, x1 = E x0 + W f is stepped as z1 = E (z0 + W f0)
with z = x - W f, and W is what the next force adds at once. Here a mode is one damped oscillator of the mesh, its shape
a number at every site of a `PressGrid`. A patch presses and reads the sites around its `knots` with weights B, and
its points take from these with weights L,

    sunk = L B^T S z,   f = S^T B L^T p,   W of points = L B^T (S W S^T + R) B L^T,

S the shapes, R the static answer of what is left out. The bracket is a table from every site to every other; it is
positive semidefinite to rounding, so W with a near field is positive definite wherever patches stand.
"""

from __future__ import annotations

from math import ceil, sqrt
from typing import NamedTuple

import numpy as np

from trocar.errors import InputError
from trocar.model import FloatArray
from trocar.waves.kernel import TINY
from trocar.waves.mesh.knots import knots
from trocar.waves.mesh.press_grid import PressGrid
from trocar.waves.mesh.solid_mesh import IntArray
from trocar.waves.mesh.surface_modes import SurfaceModes
from trocar.waves.oscillators import Oscillators
from trocar.waves.state import require_step

ROUND = 0.5  # the surface stays within so much of a patch's radius of its tangent plane


class MeshTick(NamedTuple):
    """What a tick needs to know; compiled code takes it whole. Nothing in it changes.

    Attributes:
        turn: E00, E01, E10, E11 and E W (2) of every mode, shape (6, r).
        read: from a mode's block to its amplitude, shape (2, r).
        shapes: displacement into the surface at the sites, shape (N, r) [kg^-1/2].
        at_once: how far each site sinks within a tick per newton held on each [m/N], shape (N, N).
        number, cells: of the `PressGrid`.
        heights: of the surface at the sites [m], shape (N,).
        normals: shape (N, 3).
        first: x, y of the grid's first column and row [m], shape (2,).
        spacing: of the sites [m].
        offsets: of a patch's points from its centre, along both its tangents [m], shape (tools, P).
        knots: of a patch, likewise, shape (tools, n); the offsets themselves where every point is one.
        onto: L, shape (tools, P P, n n), or (tools, 0, 0) where every point is a knot.
    """

    turn: FloatArray
    read: FloatArray
    shapes: FloatArray
    at_once: FloatArray
    number: IntArray
    cells: np.ndarray
    heights: FloatArray
    normals: FloatArray
    first: FloatArray
    spacing: float
    offsets: FloatArray
    knots: FloatArray
    onto: FloatArray


class MeshTickState(NamedTuple):
    """What a tick changes, in place.

    Attributes:
        blocks: z = x - W f of every mode, shape (2, r).
        force: modal forces f held in the last tick, shape (r,).
        amplitudes: of the modes without the next forces, shape (r,).
        frames: of the patches: origin [m], two tangents and the normal, shape (tools, 4, 3).
        heights: of the rest surface over the tangent plane at every point [m], shape (tools, P P).
        on: which points lie on the surface; others must carry no force, shape (tools, P P).
        counts: of the sites that a patch touches, 0 where it is beside the surface, shape (tools,).
        ranks: of the knots that it stands on: n n, or P P where a knot lies beside the surface, shape (tools,).
        sites: numbers of those sites, shape (tools, K).
        weights: B, rows of `ranks` numbers for each of `counts` sites, shape (tools, K P P).
        held: forces held on those sites [N], shape (tools, K).
        cubics: scratch, weights along x and y of every knot, shape (P P, 8).
        corners: scratch, cell of every knot, shape (P P, 2).
        of_knots: scratch, a number of every knot, shape (P P,).
        table, half: scratch, from sites to sites, and from sites to knots, shapes (K K,), (K P P,).
        core, side: scratch, from knots to knots, and from knots to points, shapes (P^4,), (P^4,).
    """

    blocks: FloatArray
    force: FloatArray
    amplitudes: FloatArray
    frames: FloatArray
    heights: FloatArray
    on: np.ndarray
    counts: IntArray
    ranks: IntArray
    sites: IntArray
    weights: FloatArray
    held: FloatArray
    cubics: FloatArray
    corners: IntArray
    of_knots: FloatArray
    table: FloatArray
    half: FloatArray
    core: FloatArray
    side: FloatArray


def make_mesh_tick(modes: SurfaceModes, grid: PressGrid, dt: float, *, offsets: FloatArray) -> MeshTick:
    """Lay out a mesh's exact step of length dt [s] for as many patches as rows of offsets are given.

    Args:
        modes: that answer the sites.
        grid: the sites.
        dt: length of a tick [s].
        offsets: of the patches' points from their centres, along both tangents [m], shape (tools, P).

    Raises:
        InputError: an argument is not possible.
    """
    require_step((), (), dt)
    if offsets.ndim != 2 or not offsets.size or not np.isfinite(offsets).all():
        raise InputError("tick: offsets", "finite numbers [m], a row for each tool", offsets)
    one = np.ones((len(modes.squares), 1, 1))
    stiffness = modes.squares[:, None, None]
    oscillators = Oscillators.of(one, modes.retardation_time * stiffness, stiffness, one, one)
    step = oscillators.propagator(dt)
    transition = step.transition[:, 0]
    gain = (step.start_gain + step.end_gain)[:, 0, :, 0]
    read = oscillators.outputs[:, 0, 0]
    turned = np.concatenate([transition.reshape(-1, 4), np.einsum("rab,rb->ra", transition, gain)], axis=1)
    adds = (read * gain).sum(axis=1)
    places, onto = knots(np.asarray(offsets, dtype=np.float64), grid.spacing)
    at_once = (modes.shapes * adds) @ modes.shapes.T + modes.rest
    return MeshTick(
        turn=np.ascontiguousarray(np.where(np.abs(turned) > TINY, turned, 0.0).T),
        read=np.ascontiguousarray(read.T),
        shapes=np.ascontiguousarray(modes.shapes),
        at_once=0.5 * (at_once + at_once.T),
        number=grid.number,
        cells=grid.cells,
        heights=np.ascontiguousarray(grid.places[:, 2]),
        normals=np.ascontiguousarray(grid.normals),
        first=np.array(grid.first),
        spacing=grid.spacing,
        offsets=np.ascontiguousarray(offsets, dtype=np.float64),
        knots=np.ascontiguousarray(places),
        onto=np.ascontiguousarray(onto),
    )


def at_rest(tick: MeshTick) -> MeshTickState:
    """Return the state at rest without load, no patch on the surface, and the scratch arrays."""
    tools, points = tick.offsets.shape
    pads = points * points
    # A patch's radius along the tangents, and as far again as the surface bends away from them.
    radius = sqrt(2) * float(np.abs(tick.offsets).max())
    side = ceil(2 * radius * sqrt(1 + ROUND**2) / tick.spacing) + 4
    modes, most = tick.shapes.shape[1], side * side
    return MeshTickState(
        blocks=np.zeros((2, modes)),
        force=np.zeros(modes),
        amplitudes=np.zeros(modes),
        frames=np.zeros((tools, 4, 3)),
        heights=np.zeros((tools, pads)),
        on=np.zeros((tools, pads), dtype=np.bool_),
        counts=np.zeros(tools, dtype=np.int64),
        ranks=np.zeros(tools, dtype=np.int64),
        sites=np.zeros((tools, most), dtype=np.int64),
        weights=np.zeros((tools, most * pads)),
        held=np.zeros((tools, most)),
        cubics=np.zeros((pads, 8)),
        corners=np.zeros((pads, 2), dtype=np.int64),
        of_knots=np.zeros(pads),
        table=np.zeros(most * most),
        half=np.zeros(most * pads),
        core=np.zeros(pads * pads),
        side=np.zeros(pads * pads),
    )


def picture_length(tick: MeshTick) -> int:
    """Return how many numbers a picture is made of (`mesh_patch.write_picture`)."""
    state = at_rest(tick)
    return len(state.amplitudes) + 2 * state.held.size


def sunk_sites(tick: MeshTick, picture: FloatArray) -> FloatArray:
    """Return how deep the surface has sunk at every site at the end of a tick [m], shape (N,).

    Args:
        tick: parameters.
        picture: of the state (`mesh_patch.write_picture`), shape (..., `picture_length`).
    """
    modes = tick.shapes.shape[1]
    amplitudes, (held, sites) = picture.ravel()[:modes], picture.ravel()[modes:].reshape(2, -1)
    pressed = held != 0.0
    at_once = tick.at_once[:, sites[pressed].astype(np.int64)]
    return np.asarray(tick.shapes @ amplitudes + at_once @ held[pressed])
