"""The compiled half of a mesh's tick: patches are placed, the modes go on, points push each other in, forces are held.

Between sites everything is the cubic convolution of the four by four around a place (Keys 1981, IEEE Trans. Acoust.
Speech Signal Process. 29:1153): it goes through the sites, is exact for parabolas, and its slope has no jumps.
"""

from __future__ import annotations

from math import floor, sqrt

import numpy as np
import numpy.typing as npt
from numba import njit

from trocar.model import FloatArray
from trocar.waves.kernel import turned
from trocar.waves.mesh.footprint import STEEPEST
from trocar.waves.mesh.mesh_tick import ROUND, MeshTick, MeshTickState
from trocar.waves.mesh.solid_mesh import IntArray

BoolArray = npt.NDArray[np.bool_]

_DROPS = 8  # onto the surface along the normal at most, from a neighbour's height
_NEAR = 1e-7  # [m] a drop after which a knot is on the surface: the next would be smaller by the slope between them


@njit(cache=True)
def _cubic(
    cells: BoolArray, u: float, v: float, out: FloatArray
) -> tuple[int, int]:  # pragma: no cover - compiled
    """Write weights of four columns and four rows about a place of the grid; return the first, or -1 beside it."""
    columns, rows = cells.shape
    if not (0.0 <= u < columns and 0.0 <= v < rows):
        return -1, -1
    i, j = floor(u), floor(v)
    if not cells[i, j]:
        return -1, -1
    for axis in range(2):
        t = u - i if axis == 0 else v - j
        out[4 * axis] = t * (t * (1.0 - 0.5 * t) - 0.5)
        out[4 * axis + 1] = 1.0 + t * t * (1.5 * t - 2.5)
        out[4 * axis + 2] = t * (0.5 + t * (2.0 - 1.5 * t))
        out[4 * axis + 3] = 0.5 * t * t * (t - 1.0)
    return i - 1, j - 1


@njit(cache=True)
def _height(
    number: IntArray, heights: FloatArray, i: int, j: int, cubic: FloatArray
) -> float:  # pragma: no cover - compiled
    height = 0.0
    for a in range(4):
        site = number[i + a, j]
        row = 0.0
        for b in range(4):
            row += cubic[4 + b] * heights[site + b]
        height += cubic[a] * row
    return height


@njit(cache=True)
def stand(
    tick: MeshTick, x: float, y: float, cubic: FloatArray, frame: FloatArray
) -> bool:  # pragma: no cover - compiled
    """Write the frame of a place on the surface, without a patch.

    Args:
        tick: parameters.
        x: of the place, as seen from above [m].
        y: likewise.
        cubic: scratch, shape (8,).
        frame: overwritten with the place [m], the tangent that goes along x, the other one and the normal,
            shape (4, 3); worth nothing where False is returned.

    Returns:
        Whether the surface is there and looks up.
    """
    i, j = _cubic(tick.cells, (x - tick.first[0]) / tick.spacing, (y - tick.first[1]) / tick.spacing, cubic)
    if i < 0:
        return False
    origin, along, across, normal = frame[0], frame[1], frame[2], frame[3]
    origin[0], origin[1], origin[2] = x, y, _height(tick.number, tick.heights, i, j, cubic)
    normal[:] = 0.0
    for a in range(4):
        site = tick.number[i + a, j]
        for b in range(4):
            weight = cubic[a] * cubic[4 + b]
            for k in range(3):
                normal[k] += weight * tick.normals[site + b, k]
    size = sqrt(normal[0] ** 2 + normal[1] ** 2 + normal[2] ** 2)
    for k in range(3):
        normal[k] /= size
    if normal[2] < STEEPEST:
        return False
    level = sqrt(1.0 - normal[0] ** 2)
    along[0], along[1], along[2] = level, -normal[0] * normal[1] / level, -normal[0] * normal[2] / level
    across[0], across[1], across[2] = 0.0, normal[2] / level, -normal[1] / level
    return True


@njit(cache=True)
def place_patch(
    tick: MeshTick, state: MeshTickState, tool: int, x: float, y: float
) -> bool:  # pragma: no cover - compiled
    """Put a patch's centre on the surface at x, y [m], as seen from above, in the tangent plane there.

    Args:
        tick: parameters.
        state: overwritten; `frames`, `heights` and `on` say where the points are.
        tool: number of the patch.
        x: of its centre [m].
        y: likewise.

    Returns:
        Whether the surface is there and looks up; if not, the patch must carry no force.
    """
    on, heights = state.on[tool], state.heights[tool]
    on[:] = False
    heights[:] = 0.0
    state.counts[tool] = 0
    if not stand(tick, x, y, state.cubics[0], state.frames[tool]):
        return False
    onto = tick.onto[tool]
    if len(onto) > 0 and _lay(tick, state, tool, tick.knots[tool]):
        on[:] = True
        np.dot(onto, state.of_knots[: onto.shape[1]], heights)
    else:
        _lay(tick, state, tool, tick.offsets[tool])
        heights[:] = state.of_knots
    return True


@njit(cache=True)
def _lay(
    tick: MeshTick, state: MeshTickState, tool: int, offsets: FloatArray
) -> bool:  # pragma: no cover - compiled
    """Find the heights of a patch's knots over its tangent plane, and how they press; return whether all are on."""
    frame, on, heights = state.frames[tool], state.on[tool], state.of_knots
    number, surface, cells, cubics, corners = (
        tick.number, tick.heights, tick.cells, state.cubics, state.corners,
    )  # fmt: skip
    along, across, normal = frame[1], frame[2], frame[3]
    x, y, z = frame[0, 0] - tick.first[0], frame[0, 1] - tick.first[1], frame[0, 2]
    finer = 1.0 / tick.spacing
    radius = 0.0
    for a in range(len(offsets)):
        radius = max(radius, abs(offsets[a]))
    most = ROUND * sqrt(2.0) * radius
    low_i, low_j = number.shape
    high_i = high_j = -1
    height = of_row = 0.0
    count = len(offsets)
    every = True
    for a in range(count):
        height = of_row
        for b in range(count):
            knot = a * count + b
            px = x + offsets[a] * along[0] + offsets[b] * across[0]
            py = y + offsets[a] * along[1] + offsets[b] * across[1]
            pz = z + offsets[a] * along[2] + offsets[b] * across[2]
            cubic, i, j = cubics[knot], -1, -1
            for _ in range(_DROPS):
                i, j = _cubic(
                    cells, finer * (px + height * normal[0]), finer * (py + height * normal[1]), cubic
                )
                if i < 0:
                    break
                drop = _height(number, surface, i, j, cubic) - (pz + height * normal[2])
                height = min(max(height + drop * normal[2], -most), most)
                if abs(drop) < _NEAR:
                    break
            on[knot] = i >= 0
            if i < 0:
                height = heights[knot] = 0.0
                every = False
                continue
            heights[knot] = height
            if b == 0:
                of_row = height
            corners[knot, 0], corners[knot, 1] = i, j
            low_i, high_i = min(low_i, i), max(high_i, i)
            low_j, high_j = min(low_j, j), max(high_j, j)
    if high_i >= 0:
        _gather(tick, state, tool, count * count, low_i, high_i - low_i + 4, low_j, high_j - low_j + 4)
    return every


@njit(cache=True)
def _gather(
    tick: MeshTick, state: MeshTickState, tool: int, rank: int, first: int, columns: int, left: int, rows: int
) -> None:  # pragma: no cover - compiled
    """Number the sites about a patch, and write how every knot presses on them and reads them."""
    sites, on, count = state.sites[tool], state.on[tool], columns * rows
    state.counts[tool], state.ranks[tool] = count, rank
    weights = state.weights[tool, : count * rank].reshape(count, rank)
    weights[:] = 0.0
    for a in range(columns):
        for b in range(rows):
            # Of a site that is not there no knot has a weight.
            sites[a * rows + b] = max(tick.number[first + a, left + b], 0)
    for knot in range(rank):
        if on[knot]:
            cubic = state.cubics[knot]
            i, j = state.corners[knot, 0] - first, state.corners[knot, 1] - left
            for a in range(4):
                for b in range(4):
                    weights[(i + a) * rows + j + b, knot] = cubic[a] * cubic[4 + b]


@njit(cache=True)
def go_on(tick: MeshTick, state: MeshTickState) -> None:  # pragma: no cover - compiled
    """Advance the modes by one tick under the forces held; `amplitudes` are then those without the next ones."""
    x, y, f, u = state.blocks[0], state.blocks[1], state.force, state.amplitudes
    e, r = tick.turn, tick.read
    for k in range(len(f)):
        p, q = x[k], y[k]
        x[k] = turned(e[0, k], e[1, k], p, q, e[4, k] * f[k])
        y[k] = turned(e[2, k], e[3, k], p, q, e[5, k] * f[k])
        u[k] = r[0, k] * x[k] + r[1, k] * y[k]


@njit(cache=True)
def read_patches(
    tick: MeshTick, state: MeshTickState, sunk: FloatArray
) -> None:  # pragma: no cover - compiled
    """Write how deep the surface has sunk at every patch's points without the next forces [m], shape (tools, P P)."""
    for t in range(len(state.counts)):
        count, rank = state.counts[t], state.ranks[t]
        if count == 0:
            sunk[t] = 0.0
            continue
        weights = state.weights[t, : count * rank].reshape(count, rank)
        of_knots = state.of_knots[:rank]
        of_knots[:] = 0.0
        for k in range(count):
            site = np.dot(tick.shapes[state.sites[t, k]], state.amplitudes)
            for knot in range(rank):
                of_knots[knot] += weights[k, knot] * site
        if rank < sunk.shape[1]:
            np.dot(tick.onto[t], of_knots, sunk[t])
        else:
            sunk[t] = of_knots


@njit(cache=True)
def push_each_other(
    tick: MeshTick, state: MeshTickState, one: int, other: int, out: FloatArray
) -> None:  # pragma: no cover - compiled
    """Write how far each point of a patch sinks within a tick per newton held on each of another [m/N].

    Args:
        tick: parameters.
        state: scratch in it is overwritten.
        one: number of a patch.
        other: of the one that presses; it may be the same.
        out: overwritten, shape (P P, P P); zero at points that are beside the surface.
    """
    here, there, pads = state.counts[one], state.counts[other], out.shape[0]
    if here == 0 or there == 0:
        out[:] = 0.0
        return
    table = state.table[: here * there].reshape(here, there)
    for i in range(here):
        row = tick.at_once[state.sites[one, i]]
        for k in range(there):
            table[i, k] = row[state.sites[other, k]]
    rank, others = state.ranks[one], state.ranks[other]
    half = state.half[: here * others].reshape(here, others)
    core = state.core[: rank * others].reshape(rank, others)
    np.dot(table, state.weights[other, : there * others].reshape(there, others), half)
    np.dot(state.weights[one, : here * rank].reshape(here, rank).T, half, core)
    side = state.side[: rank * pads].reshape(rank, pads)
    if others < pads:
        np.dot(core, tick.onto[other].T, side)
    else:
        side[:] = core
    if rank < pads:
        np.dot(tick.onto[one], side, out)
    else:
        out[:] = side


@njit(cache=True)
def between(
    tick: MeshTick, state: MeshTickState, one: int, other: int
) -> float:  # pragma: no cover - compiled
    """Return how far about the middle of a patch sinks within a tick per newton held on another [m/N], or nearly so.

    One entry of the sites' table: it tells whether the two need to be solved for together.
    """
    if state.counts[one] == 0 or state.counts[other] == 0:
        return 0.0
    here, there = state.sites[one, state.counts[one] // 2], state.sites[other, state.counts[other] // 2]
    depth: float = abs(tick.at_once[here, there])
    return depth


@njit(cache=True)
def hold(tick: MeshTick, state: MeshTickState, forces: FloatArray) -> None:  # pragma: no cover - compiled
    """Set the forces that are held through this tick.

    Args:
        tick: parameters.
        state: overwritten.
        forces: of every point into the surface [N], shape (tools, P P).
    """
    state.force[:] = 0.0
    for t in range(len(state.counts)):
        count, rank = state.counts[t], state.ranks[t]
        if count == 0:
            continue
        weights = state.weights[t, : count * rank].reshape(count, rank)
        of_knots = state.of_knots[:rank]
        if rank < forces.shape[1]:
            np.dot(forces[t], tick.onto[t], of_knots)
        else:
            of_knots[:] = forces[t]
        for k in range(count):
            total = 0.0
            for knot in range(rank):
                total += weights[k, knot] * of_knots[knot]
            state.held[t, k] = total
            if total != 0.0:
                shape = tick.shapes[state.sites[t, k]]
                for r in range(len(shape)):
                    state.force[r] += total * shape[r]


@njit(cache=True)
def let_go(state: MeshTickState) -> None:  # pragma: no cover - compiled
    """Hold no forces through this tick."""
    state.force[:] = 0.0
    state.held[:] = 0.0


@njit(cache=True)
def write_picture(
    tick: MeshTick, state: MeshTickState, out: FloatArray
) -> None:  # pragma: no cover - compiled
    """Write what `mesh_tick.sunk_sites` makes a picture of: a few numbers, for a tick has no time for all sites.

    Args:
        tick: parameters.
        state: of the tissue.
        out: overwritten with amplitudes of the modes, forces held [N] and the numbers of the sites that they are held
            on, shape (1, 1, `picture_length`).
    """
    modes, many = len(state.amplitudes), state.held.size
    most = state.held.shape[1]
    out[0, 0, :modes] = state.amplitudes
    out[0, 0, modes:] = 0.0
    for t in range(len(state.counts)):
        for k in range(state.counts[t]):
            out[0, 0, modes + t * most + k] = state.held[t, k]
            out[0, 0, modes + many + t * most + k] = state.sites[t, k]
