"""What tips do to a sheet's nodes within a small step, and where blades find the sheet between them.

A node that would lie above a tip's underside is brought to the plane that touches it there, along its normal, and loses
its velocity into the tip, no more: it is pressed, never thrown. Friction takes of its velocity along that plane what
coefficient times the normal impulse can (Coulomb, implicit). A node has a mass of its own, so each is solved by itself,
exactly. A node in a jaw goes with it. All impulses come back to the tip.
"""

from __future__ import annotations

from math import inf, sqrt

from numba import njit

from trocar.contact.blades import EDGE, LEAN, SPLIT
from trocar.contact.tips import underside
from trocar.model import FloatArray
from trocar.simulation.sheet_scene import MOST_HELD, SheetScene, SheetState
from trocar.waves.sheet.cut import cut_along
from trocar.waves.sheet.lattice import Lattice

_ASTRAY = 4e-3  # [m] in the plane, by which nodes may be away from their rest places and are still looked at
_SHIFT = 1e-4  # [m] a node is brought out of a tip in a small step, at most
_STRIDE = 2e-4  # [m] between places where blades are held against the sheet
_TURNS = 6  # until a place on the sheet is known at rest; each halves what is left, or better, where strain is small
TOUCHED, HELD = 0, 1  # columns of counts


@njit(cache=True)
def press_nodes(
    scene: SheetScene, state: SheetState, t: int, tip: FloatArray
) -> None:  # pragma: no cover - compiled
    """Keep the nodes below a tip's underside, over a small step: velocities are those before it, changed here.

    Args:
        scene: parameters.
        state: the tip is where it will be at the step's end.
        t: number of the instrument.
        tip: its end [m], shape (3,).
    """
    lattice, sheet = scene.lattice, state.lattice
    n, h, dt = lattice.columns, lattice.spacing, lattice.dt
    centre, spread, way = state.centres[t], state.spreads[t], state.ways[t]
    u, v = sheet.places, sheet.speeds
    reach_x, reach_y = sqrt(spread[0, 0]), sqrt(spread[1, 1])
    rows = len(lattice.free) // n
    first = max(int((centre[0] - reach_x - _ASTRAY) / h), 1)
    last = min(int((centre[0] + reach_x + _ASTRAY) / h) + 1, n - 2)
    bottom = max(int((centre[1] - reach_y - _ASTRAY) / h), 1)
    top = min(int((centre[1] + reach_y + _ASTRAY) / h) + 1, rows - 2)
    count = 0
    for j in range(bottom, top + 1):
        for i in range(first, last + 1):
            at = j * n + i
            dx = i * h + u[0, at] + dt * v[0, at] - centre[0]
            dy = j * h + u[1, at] + dt * v[1, at] - centre[1]
            if abs(dx) >= reach_x or abs(dy) >= reach_y:
                continue
            height, slope_x, slope_y = underside(spread, dx, dy)
            if height == inf:
                continue
            above = u[2, at] + dt * v[2, at] - centre[2] - height
            if above <= 0.0:
                continue
            size = sqrt(1.0 + slope_x * slope_x + slope_y * slope_y)
            nx, ny, nz = slope_x / size, slope_y / size, -1.0 / size
            depth = above / size
            wx, wy, wz = v[0, at] - way[0] / dt, v[1, at] - way[1] / dt, v[2, at] - way[2] / dt
            push = min(max(-(wx * nx + wy * ny + wz * nz), 0.0), depth / dt)
            shift = min(depth - dt * push, _SHIFT)
            wx, wy, wz = wx + push * nx, wy + push * ny, wz + push * nz
            into = wx * nx + wy * ny + wz * nz
            tx, ty, tz = wx - into * nx, wy - into * ny, wz - into * nz
            along = sqrt(tx * tx + ty * ty + tz * tz)
            rub = 0.0
            if along > 0.0:
                rub = min(1.0, scene.friction * push / along)
            px, py, pz = push * nx - rub * tx, push * ny - rub * ty, push * nz - rub * tz
            v[0, at] += px
            v[1, at] += py
            v[2, at] += pz
            u[0, at] += shift * nx
            u[1, at] += shift * ny
            u[2, at] += shift * nz
            _feel(lattice, state, t, tip, at, px, py, pz)
            if count < MOST_HELD:
                state.touched[t, count] = at
                count += 1
    state.counts[t, TOUCHED] = count


@njit(cache=True)
def carry_nodes(
    scene: SheetScene, state: SheetState, t: int, tip: FloatArray
) -> None:  # pragma: no cover - compiled
    """Let the nodes in a jaw go with it, over a small step; arguments as in `press_nodes`."""
    lattice, sheet = scene.lattice, state.lattice
    n, h = lattice.columns, lattice.spacing
    for k in range(state.counts[t, HELD]):
        at = state.held[t, k]
        rest = (at % n * h, at // n * h, 0.0)
        p = state.vectors[5]
        for axis in range(3):
            wanted = state.centres[t, axis] + state.offsets[t, k, axis] - rest[axis]
            p[axis] = (wanted - sheet.places[axis, at]) / lattice.dt - sheet.speeds[axis, at]
            sheet.speeds[axis, at] += p[axis]
        _feel(lattice, state, t, tip, at, p[0], p[1], p[2])


@njit(cache=True)
def take_hold(scene: SheetScene, state: SheetState, t: int) -> None:  # pragma: no cover - compiled
    """Close a jaw on the nodes that its tip touches."""
    n, h = scene.lattice.columns, scene.lattice.spacing
    for k in range(state.counts[t, TOUCHED]):
        at = state.touched[t, k]
        rest = (at % n * h, at // n * h, 0.0)
        state.held[t, k] = at
        for axis in range(3):
            place = rest[axis] + state.lattice.places[axis, at]
            state.offsets[t, k, axis] = place - state.centres[t, axis]
    state.counts[t, HELD] = state.counts[t, TOUCHED]


@njit(cache=True)
def snip(
    scene: SheetScene, state: SheetState, t: int, tip: FloatArray, back: FloatArray, opens: float
) -> bool:  # pragma: no cover - compiled
    """Cut the sheet where it lies between open blades; write into `state.snips` what was cut, and return whether.

    Args:
        scene: parameters.
        state: the sheet is cut.
        t: number of the instrument.
        tip: its end [m], shape (3,).
        back: unit vector from the tip along the shaft, shape (3,).
        opens: vertical part of the unit vector along which blades open [1].
    """
    lattice = scene.lattice
    begun = False
    cut, found = state.snips[t], state.vectors[5]
    for k in range(int(EDGE / _STRIDE) + 1):
        s = k * _STRIDE
        place_at_rest(lattice, state.lattice.places, tip[0] + s * back[0], tip[1] + s * back[1], found)
        inside = 0.0 <= found[0] <= lattice.size[0] and 0.0 <= found[1] <= lattice.size[1]
        if inside and abs(tip[2] + s * back[2] - found[2]) < (EDGE - s) * LEAN * abs(opens):
            if not begun:
                begun = True
                cut[1], cut[2] = found[0], found[1]
            cut[3], cut[4] = found[0], found[1]
        elif begun:
            break
    if begun:
        level = sqrt(back[0] ** 2 + back[1] ** 2)
        for axis in range(2):
            further = SPLIT * back[axis] / level
            cut[1 + axis] -= further
            cut[3 + axis] += further
        cut[0] = cut_along(lattice, state.lattice, cut[1], cut[2], cut[3], cut[4])
    return begun


@njit(cache=True)
def place_at_rest(
    lattice: Lattice, places: FloatArray, x: float, y: float, out: FloatArray
) -> None:  # pragma: no cover - compiled
    """Write where at rest the sheet lies that is at x, y now, and its height there: x, y, z [m], shape (3,)."""
    n, h = lattice.columns, lattice.spacing
    rows = len(lattice.free) // n
    rest_x, rest_y, height = x, y, 0.0
    for _ in range(_TURNS):
        column, row = min(max(rest_x / h, 0.0), n - 1.0), min(max(rest_y / h, 0.0), rows - 1.0)
        i, j = min(int(column), n - 2), min(int(row), rows - 2)
        a, b = column - i, row - j
        at = j * n + i
        moved_x = moved_y = height = 0.0
        for corner, share in (
            (at, (1 - a) * (1 - b)),
            (at + 1, a * (1 - b)),
            (at + n, (1 - a) * b),
            (at + n + 1, a * b),
        ):
            moved_x += share * places[0, corner]
            moved_y += share * places[1, corner]
            height += share * places[2, corner]
        rest_x, rest_y = 0.5 * (rest_x + x - moved_x), 0.5 * (rest_y + y - moved_y)
    out[0], out[1], out[2] = rest_x, rest_y, height


@njit(cache=True)
def _feel(
    lattice: Lattice, state: SheetState, t: int, tip: FloatArray, at: int, px: float, py: float, pz: float
) -> None:  # pragma: no cover - compiled
    """Bring back to a tip what it gave a node: a change of velocity [m/s], as a force over a tick."""
    n, h = lattice.columns, lattice.spacing
    share = -lattice.mass / (lattice.dt * lattice.steps)
    fx, fy, fz = share * px, share * py, share * pz
    rx = at % n * h + state.lattice.places[0, at] - tip[0]
    ry = at // n * h + state.lattice.places[1, at] - tip[1]
    rz = state.lattice.places[2, at] - tip[2]
    force, moment = state.forces[t], state.moments[t]
    force[0] += fx
    force[1] += fy
    force[2] += fz
    moment[0] += ry * fz - rz * fy
    moment[1] += rz * fx - rx * fz
    moment[2] += rx * fy - ry * fx
