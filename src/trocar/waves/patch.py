"""The compiled half of a tick: patches are placed, the waves go on, points push each other in, forces are held."""

from __future__ import annotations

from math import pi, sin

import numpy as np
from numba import njit

from trocar.model import FloatArray
from trocar.waves.kernel import turned
from trocar.waves.tick import STEP_PLANES, STRIP, Tick, TickState


@njit(cache=True)
def sines_and_cosines(place: float, side: float, out: FloatArray) -> None:  # pragma: no cover - compiled
    """Write sin(m pi place/side) and cos(m pi place/side), m = 1, 2, ..., by differences; shape (2, modes).

    s_(m+1) - s_m = s_m - s_(m-1) - 4 sin^2(phi/2) s_m keeps its accuracy where phi is small (Reinsch's form
    of the three-term recurrence: Stoer and Bulirsch 2002, Introduction to Numerical Analysis, section 1.3);
    the far half is the mirror image of the near one.
    """
    mirrored = place > 0.5 * side
    phi = pi * ((side - place) if mirrored else place) / side
    half = sin(0.5 * phi)
    turn = -4.0 * half * half
    s = sin(phi)
    ds = s
    dc = -2.0 * half * half
    c = 1.0 + dc
    odd = 1.0
    for m in range(out.shape[1]):
        out[0, m] = odd * s if mirrored else s
        out[1, m] = -odd * c if mirrored else c
        odd = -odd
        ds += turn * s
        s += ds
        dc += turn * c
        c += dc


@njit(cache=True)
def place_patch(
    tick: Tick, state: TickState, tool: int, x: float, y: float
) -> None:  # pragma: no cover - compiled
    """Put a patch's centre at a rest place x, y [m]; points off the block must carry no force."""
    points = tick.offsets.shape[1]
    sines_and_cosines(x, tick.size[0], state.waves)
    _shifted(state.waves, tick.shift_x, tool * points, points, state.shapes_x)
    sines_and_cosines(y, tick.size[1], state.waves)
    _shifted(state.waves, tick.shift_y, tool * points, points, state.shapes_y)


@njit(cache=True)
def _shifted(
    waves: FloatArray, shift: FloatArray, first: int, points: int, out: FloatArray
) -> None:  # pragma: no cover - compiled
    s, c = waves[0], waves[1]
    for i in range(first, first + points):
        along, aside, row = shift[0, i], shift[1, i], out[i]
        for m in range(len(row)):
            row[m] = s[m] * along[m] + c[m] * aside[m]


@njit(cache=True)
def go_on(tick: Tick, state: TickState) -> None:  # pragma: no cover - compiled
    """Advance the waves by one tick under the forces held; `surface` is then the top face without the next ones."""
    order = tick.shape[0]
    for s in range(len(tick.row)):
        n0 = tick.first[s]
        modes = tick.modes[s]
        c = tick.planes[s]
        z = state.blocks[s]
        f = state.force[tick.row[s], n0:]
        u = state.surface[tick.row[s], n0:]
        r = c[order * STEP_PLANES * STRIP :]
        for i in range(order):
            e = c[i * STEP_PLANES * STRIP :]
            x = z[2 * i * STRIP :]
            for j in range(modes):
                p = x[j]
                q = x[STRIP + j]
                x[j] = turned(e[j], e[STRIP + j], p, q, e[4 * STRIP + j] * f[j])
                x[STRIP + j] = turned(e[2 * STRIP + j], e[3 * STRIP + j], p, q, e[5 * STRIP + j] * f[j])
            out = r[2 * i * STRIP :]
            if i == 0:
                for j in range(modes):
                    u[j] = out[j] * x[j] + out[STRIP + j] * x[STRIP + j]
            else:
                for j in range(modes):
                    u[j] += out[j] * x[j] + out[STRIP + j] * x[STRIP + j]


@njit(cache=True)
def read_patches(tick: Tick, state: TickState, sunk: FloatArray) -> None:  # pragma: no cover - compiled
    """Write how deep the top face lies at every patch's points without the next forces [m], shape (tools, P P)."""
    tools, points = tick.offsets.shape
    np.dot(state.shapes_x, state.surface, state.rows)
    for t in range(tools):
        part = slice(t * points, (t + 1) * points)
        np.dot(state.rows[part], state.shapes_y[part].T, state.pushes)
        for i in range(points):
            for k in range(points):
                sunk[t, i * points + k] = -state.pushes[i, k]


@njit(cache=True)
def push_each_other(
    tick: Tick, state: TickState, one: int, other: int, out: FloatArray
) -> None:  # pragma: no cover - compiled
    """Write how far each point of a patch sinks within a tick per newton held on each of another [m/N].

    Args:
        tick: parameters.
        state: scratch in it is overwritten.
        one: number of a patch.
        other: of the one that presses; it may be the same.
        out: overwritten, shape (P P, P P).
    """
    points = tick.offsets.shape[1]
    for i in range(points):
        for k in range(points):
            a, b = state.shapes_x[one * points + i], state.shapes_x[other * points + k]
            row = state.pairs_x[i * points + k]
            for m in range(len(row)):
                row[m] = a[m] * b[m]
            a, b = state.shapes_y[one * points + i], state.shapes_y[other * points + k]
            for n in range(len(a)):
                state.pairs_y[n, i * points + k] = a[n] * b[n]
    np.dot(state.pairs_x, tick.at_once, state.pairs_sum)
    np.dot(state.pairs_sum, state.pairs_y, state.pairs)
    for i in range(points):
        for k in range(points):
            row = state.pairs[i * points + k]
            for j in range(points):
                for h in range(points):
                    out[i * points + j, k * points + h] = row[j * points + h]


@njit(cache=True)
def hold(tick: Tick, state: TickState, forces: FloatArray) -> None:  # pragma: no cover - compiled
    """Set the forces that are held through this tick.

    Args:
        tick: parameters.
        state: overwritten.
        forces: of every point into the surface [N], shape (tools, P P).
    """
    tools, points = tick.offsets.shape
    for t in range(tools):
        part = slice(t * points, (t + 1) * points)
        for i in range(points):
            for k in range(points):
                state.pushes[i, k] = -forces[t, i * points + k]
        np.dot(state.pushes, state.shapes_y[part], state.rows[part])
    np.dot(state.shapes_x.T, state.rows, state.force)


@njit(cache=True)
def let_go(state: TickState) -> None:  # pragma: no cover - compiled
    """Hold no forces through this tick."""
    state.force[:] = 0.0


@njit(cache=True)
def read_layers(tick: Tick, state: TickState, out: FloatArray) -> None:  # pragma: no cover - compiled
    """Write every layer's amplitudes of u_z at the end of the tick [m], shape (layers, M, N); 0 beyond the cut-off."""
    order, layers, _, columns = tick.shape
    out[:] = 0.0
    for s in range(len(tick.row)):
        n0 = tick.first[s]
        modes = min(tick.modes[s], columns - n0)
        z = state.blocks[s]
        f = state.force[tick.row[s], n0:]
        r = tick.planes[s, order * STEP_PLANES * STRIP :]
        for k in range(layers):
            own = r[k * (2 * order + 1) * STRIP :]
            at_once = own[2 * order * STRIP :]
            u = out[k, tick.row[s], n0:]
            for j in range(modes):
                u[j] = at_once[j] * f[j]
            for i in range(order):
                from_x = own[2 * i * STRIP :]
                x = z[2 * i * STRIP :]
                for j in range(modes):
                    u[j] += from_x[j] * x[j] + from_x[STRIP + j] * x[STRIP + j]
