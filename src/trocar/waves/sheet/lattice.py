"""A taut sheet as a lattice: nodes on a square grid, a link to each of a node's eight neighbours.

A link of rest length l along n, lengthened by the stretch e before, pulls with

    f = k (n.d + e l) n + e k (d - n (n.d)),   d = u_j - u_i,

its spring along itself and, across, its tension over its length, to first order in d. Sides have k = k1, diagonals
k1/2. Per area that is the energy k1/2 (exx^2 + eyy^2) + k1/4 (exx + eyy)^2 + k1 exy^2: an isotropic film with

    nu = 1/3,   E h = 4/3 k1,   tension 2 k1 e,   up and down T |grad w|^2/2, the wave equation's,

(central forces alone leave no other ratio: Cauchy's relations; Love 1927, Mathematical Theory of Elasticity, note B).
What a link stores is k/2 (n.d + e l)^2 + e k/2 |d - n (n.d)|^2, never below nothing. A cut takes links away and what
they store with them, so a cut never gives energy, and what the others pull with, no longer balanced, opens it.

Nodes carry the mass of a square each; those on the rim stay. The step is that of Stoermer and Verlet, with the springs'
lag taken from the last half step's velocity: stable while omega^2 (dt^2 + 2 lag dt) <= 4 for every frequency. A link
stores at most twice what it would with one end held and then the other, so no omega^2 is above twice the sum of a
node's links over its mass: 6 k1 (1 + e)/m in the plane, 12 e k1/m across; fewer links only lower it.
"""

from __future__ import annotations

from math import ceil, inf, sqrt
from typing import NamedTuple

import numpy as np
from numba import njit

from trocar.errors import InputError
from trocar.model import FloatArray
from trocar.waves.sheet.sheet import Sheet

EAST, NORTH, NORTH_EAST, NORTH_WEST = range(4)  # the links a node is the beginning of
AHEAD = ((1, 0), (0, 1), (1, 1), (-1, 1))  # nodes from beginning to end along x and y, of each
_SAFE = 0.95  # of the longest stable step
_MOST_STEPS = 1000
_TINY = 1e-180  # [m] and [m/s]: added and taken away, it leaves nothing of what is smaller by its digits


class Lattice(NamedTuple):
    """Parameters; nothing in it changes.

    Attributes:
        size: sides [m].
        spacing: of the nodes [m].
        side: k1 [N/m].
        stretch: e [1].
        mass: of a node [kg].
        free: 1 of nodes that move and 0 on the rim, shape (ny nx,).
        along, across: lags in the plane and up and down [s].
        drag: for each kilogram [1/s].
        dt: length of a small step [s].
        steps: small ones in a tick.
        columns: nx.
    """

    size: tuple[float, float]
    spacing: float
    side: float
    stretch: float
    mass: float
    free: FloatArray
    along: float
    across: float
    drag: float
    dt: float
    steps: int
    columns: int


class LatticeState(NamedTuple):
    """What a lattice changes, in place.

    Attributes:
        places: displacement u of the nodes from the taut, whole sheet [m], shape (3, ny nx).
        speeds: of the nodes, half a small step before [m/s], shape (3, ny nx).
        lagged: scratch: x, y, z, half the sum and half the difference of x and y [m], shape (5, ny nx).
        whole: 1 of a link that holds and 0 of one that is cut, by node and `AHEAD`, shape (4, ny nx).
        crossed: how far along itself, from 0 to 1, each link that is cut was cut; shape (4, ny nx).
    """

    places: FloatArray
    speeds: FloatArray
    lagged: FloatArray
    whole: FloatArray
    crossed: FloatArray


def make_lattice(sheet: Sheet, dt: float) -> Lattice:
    """Lay out a sheet.

    Args:
        sheet: the film.
        dt: length of a tick [s].

    Raises:
        InputError: the film is so light and stiff that a tick would take more than a thousand small steps.
    """
    columns, rows = sheet.nodes
    side = 0.75 * sheet.stiffness
    mass = sheet.density * sheet.thickness * sheet.spacing**2
    in_plane = 6 * side * (1 + sheet.stretch) / mass
    up_and_down = 12 * side * sheet.stretch / mass
    longest = _SAFE * min(_longest(in_plane, sheet.along), _longest(up_and_down, sheet.across))
    if not dt / longest <= _MOST_STEPS:
        raise InputError(
            "sheet", f"one that {_MOST_STEPS} small steps a tick can follow", f"{dt / longest:.0f}"
        )
    steps = ceil(dt / longest)
    free = np.zeros((rows, columns))
    free[1:-1, 1:-1] = 1.0
    return Lattice(
        size=sheet.size,
        spacing=sheet.spacing,
        side=side,
        stretch=sheet.stretch,
        mass=mass,
        free=free.ravel(),
        along=sheet.along,
        across=sheet.across,
        drag=sheet.drag,
        dt=dt / steps,
        steps=steps,
        columns=columns,
    )


def taut(lattice: Lattice) -> LatticeState:
    """Return the state of a whole sheet at rest."""
    nodes = len(lattice.free)
    whole = np.zeros((4, nodes // lattice.columns, lattice.columns))
    whole[EAST, :, :-1] = whole[NORTH, :-1] = 1.0
    whole[NORTH_EAST, :-1, :-1] = whole[NORTH_WEST, :-1, 1:] = 1.0
    return LatticeState(
        places=np.zeros((3, nodes)),
        speeds=np.zeros((3, nodes)),
        lagged=np.zeros((5, nodes)),
        whole=whole.reshape(4, nodes),
        crossed=np.zeros((4, nodes)),
    )


def stored(lattice: Lattice, state: LatticeState) -> float:
    """Return what the links that hold store, with what stretching the whole sheet put in [J]."""
    nodes = np.arange(len(lattice.free))
    total = 0.0
    for way, (dx, dy) in enumerate(AHEAD):
        begins = nodes[state.whole[way] != 0.0]
        d = state.places[:, begins + dy * lattice.columns + dx] - state.places[:, begins]
        length = sqrt(dx * dx + dy * dy)
        along = (dx * d[0] + dy * d[1]) / length
        across = (d**2).sum(axis=0) - along**2
        spring = lattice.side / (1 if way in (EAST, NORTH) else 2)
        pulled = along + lattice.stretch * length * lattice.spacing
        total += 0.5 * spring * float((pulled**2 + lattice.stretch * across).sum())
    return total


def moving(lattice: Lattice, state: LatticeState) -> float:
    """Return the nodes' energy of motion [J]."""
    return 0.5 * lattice.mass * float((state.speeds**2).sum())


@njit(cache=True)
def lag(lattice: Lattice, state: LatticeState) -> None:  # pragma: no cover - compiled
    """Write where nodes would be if links did not lag behind."""
    for axis in range(3):
        late = lattice.along if axis < 2 else lattice.across
        u, v, y = state.places[axis], state.speeds[axis], state.lagged[axis]
        for i in range(len(y)):
            y[i] = u[i] + late * v[i]
    x, y, half, other = state.lagged[0], state.lagged[1], state.lagged[3], state.lagged[4]
    for i in range(len(x)):
        half[i], other[i] = 0.5 * (x[i] + y[i]), 0.5 * (x[i] - y[i])


@njit(cache=True)
def pull(lattice: Lattice, state: LatticeState) -> None:  # pragma: no cover - compiled
    """Let the links change every node's velocity over a small step; `lag` comes before.

    Every array is read through views that begin at the same node, so that the loop runs over one index.
    """
    n = lattice.columns
    first, count = n + 1, len(lattice.free) - 2 * n - 2
    e, k1, k2 = lattice.stretch, lattice.side, 0.5 * lattice.side
    eh = e * lattice.spacing
    kept, push = 1.0 - lattice.drag * lattice.dt, lattice.dt / lattice.mass
    x, y, z = state.lagged[0], state.lagged[1], state.lagged[2]
    p, q = state.lagged[3], state.lagged[4]
    x0, y0, z0, p0, q0 = x[first:], y[first:], z[first:], p[first:], q[first:]
    xe, ye, ze = x[first + 1 :], y[first + 1 :], z[first + 1 :]
    xw, yw, zw = x[first - 1 :], y[first - 1 :], z[first - 1 :]
    xn, yn, zn = x[first + n :], y[first + n :], z[first + n :]
    xs, ys, zs = x[first - n :], y[first - n :], z[first - n :]
    pne, qne, zne = p[first + n + 1 :], q[first + n + 1 :], z[first + n + 1 :]
    psw, qsw, zsw = p[first - n - 1 :], q[first - n - 1 :], z[first - n - 1 :]
    pnw, qnw, znw = p[first + n - 1 :], q[first + n - 1 :], z[first + n - 1 :]
    pse, qse, zse = p[first - n + 1 :], q[first - n + 1 :], z[first - n + 1 :]
    east, west = state.whole[0][first:], state.whole[0][first - 1 :]
    north, south = state.whole[1][first:], state.whole[1][first - n :]
    north_east, south_west = state.whole[2][first:], state.whole[2][first - n - 1 :]
    north_west, south_east = state.whole[3][first:], state.whole[3][first - n + 1 :]
    vx, vy, vz = state.speeds[0][first:], state.speeds[1][first:], state.speeds[2][first:]
    free = lattice.free[first:]
    for i in range(count):
        px, py, pz = x0[i], y0[i], z0[i]
        ke, kw, kn, ks = k1 * east[i], k1 * west[i], k1 * north[i], k1 * south[i]
        a, b = k2 * north_east[i], k2 * south_west[i]
        c, d = k2 * north_west[i], k2 * south_east[i]
        fx = ke * (xe[i] - px + eh) - kw * (px - xw[i] + eh) + e * (kn * (xn[i] - px) + ks * (xs[i] - px))
        fy = kn * (yn[i] - py + eh) - ks * (py - ys[i] + eh) + e * (ke * (ye[i] - py) + kw * (yw[i] - py))
        # Half the sum and half the difference of the ways along x and y: along and across the diagonals.
        sa, ta = a * (pne[i] - p0[i] + eh), a * e * (qne[i] - q0[i])
        sb, tb = b * (p0[i] - psw[i] + eh), b * e * (q0[i] - qsw[i])
        sc, tc = c * (q0[i] - qnw[i] + eh), c * e * (pnw[i] - p0[i])
        sd, td = d * (qse[i] - q0[i] + eh), d * e * (p0[i] - pse[i])
        fx += sa - sb - sc + sd + (ta - tb + tc - td)
        fy += sa - sb + sc - sd - (ta - tb - tc + td)
        fz = ke * (ze[i] - pz) + kw * (zw[i] - pz) + kn * (zn[i] - pz) + ks * (zs[i] - pz)
        fz += a * (zne[i] - pz) + b * (zsw[i] - pz) + c * (znw[i] - pz) + d * (zse[i] - pz)
        moves = push * free[i]
        vx[i] = kept * vx[i] + moves * fx
        vy[i] = kept * vy[i] + moves * fy
        vz[i] = kept * vz[i] + moves * e * fz


@njit(cache=True)
def move(lattice: Lattice, state: LatticeState) -> None:  # pragma: no cover - compiled
    """Let the nodes go on over a small step."""
    for axis in range(3):
        u, v = state.places[axis], state.speeds[axis]
        for i in range(len(u)):
            u[i] += lattice.dt * v[i]


@njit(cache=True)
def still(state: LatticeState) -> None:  # pragma: no cover - compiled
    """Let what hardly moves rest: numbers too small for their format would make every step many times slower."""
    for axis in range(3):
        u, v = state.places[axis], state.speeds[axis]
        for i in range(len(u)):
            u[i] = (u[i] + _TINY) - _TINY
            v[i] = (v[i] + _TINY) - _TINY


@njit(cache=True)
def go_on(lattice: Lattice, state: LatticeState) -> None:  # pragma: no cover - compiled
    """Advance by a tick that nothing touches the sheet in."""
    still(state)
    for _ in range(lattice.steps):
        lag(lattice, state)
        pull(lattice, state)
        move(lattice, state)


def _longest(squared: float, late: float) -> float:
    """Return the longest stable step for a frequency's square [1/s^2] and a lag [s]."""
    return sqrt(late**2 + 4 / squared) - late if squared > 0 else inf
