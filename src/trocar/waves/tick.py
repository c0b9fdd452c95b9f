"""One tick of a live tissue: `WaveMembrane.step` and its read-out under the tools, in one compiled pass.

Each tool has a Gaussian footprint, so its modal force is one product, -F X_m Y_n with
X_m = exp(-(R kx)^2/8) sin(kx x): the whole load is a sum of as many products as there are tools. Between two
ticks the modal forces go linearly from the last ones to those at the tools' new places, as in
`WaveMembrane.step`. A block's exact step

    x1 = E x0 + W0 f0 + W1 f1    is stepped as    z1 = E z0 + (E W1 + W0) f0,    z = x - W1 f,

which needs one gain instead of two and does not ask for the next force: z1 and the one-step compliance R W1
are what an implicit contact law starts from. Layer k's read-out is R_k z1 + (R_k W1) f1.

Memory: a strip is up to 64 modes of one row m, and its coefficients lie in planes of 64, one after the other,
so that a compiled loop over a strip runs along every plane at once. Only modes with kx^2 + ky^2 <= K^2 are
kept.
"""

from __future__ import annotations

from math import pi, sin
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from numba import njit

from trocar.errors import InputError
from trocar.model import FloatArray, Load, Profile
from trocar.waves.footprint import transform
from trocar.waves.kernel import TINY, turned
from trocar.waves.membrane import WaveMembrane
from trocar.waves.state import WaveState, require_step

IntArray = npt.NDArray[np.int64]

STRIP = 64  # modes: a strip's planes share a page of memory, and few rows need a second strip
_LANES = 8  # doubles in the widest vector register; strips are padded to a multiple with zeros
_STEP_PLANES = 6  # of one block: E (4), E W1 + W0 (2)


class Tick(NamedTuple):
    """What a tick needs to know; a named tuple, because compiled code takes one whole. Nothing in it changes.

    Attributes:
        planes: coefficients, shape (strips, planes * 64): for each of r blocks E00, E01, E10, E11, G0, G1;
            then for each of k layers R0, R1 of every block, and R W1.
        row: m - 1 of each strip, shape (strips,).
        first: n - 1 of its first mode, a multiple of 64, shape (strips,).
        modes: how many modes a strip steps, padding included, shape (strips,).
        spread_x, spread_y: exp(-(R k)^2/8) of every tool along x and y, shapes (tools, M) and
            (tools, N padded).
        size: sides a, b [m], shape (2,).
        end_gain: W1 of every mode kept, shape (kept, r, 2).
        kept: number of each mode kept among the model's (M N), shape (kept,).
        strip, lane: where it is stepped, shape (kept,).
        shape: blocks r, layers k of a mode, modes M, N of the model.
        dt: length of a tick [s].
    """

    planes: FloatArray
    row: IntArray
    first: IntArray
    modes: IntArray
    spread_x: FloatArray
    spread_y: FloatArray
    size: FloatArray
    end_gain: FloatArray
    kept: IntArray
    strip: IntArray
    lane: IntArray
    shape: tuple[int, int, int, int]
    dt: float


class TickState(NamedTuple):
    """What a tick changes, in place.

    Attributes:
        blocks: z = x - W1 f, shape (strips, 2 r * 64).
        force: modal forces f now [N], shape (strips, 64).
        shapes_x, shapes_y: scratch, sin(kx x) and sin(ky y) of every tool, shapes (tools, M) and
            (tools, N padded).
        pressed_y: scratch, the latter times the spread of the footprint.
        read: scratch, sums over the rows, shape (tools, layers, N padded).
        strip_read: scratch, one layer's amplitudes in a strip, shape (64,).
    """

    blocks: FloatArray
    force: FloatArray
    shapes_x: FloatArray
    shapes_y: FloatArray
    read: FloatArray
    pressed_y: FloatArray
    strip_read: FloatArray


def make_tick(
    model: WaveMembrane, dt: float, radii: tuple[float, ...], *, cutoff: float = float("inf")
) -> Tick:
    """Lay out a model's exact step of length dt [s] for as many tools as radii are given.

    Args:
        model: the tissue; its modes bound those of the tick.
        dt: length of a tick [s].
        radii: of the tools' Gaussian footprints [m]; at least one.
        cutoff: the largest wavenumber kept [1/m]; see `cutoff_for`.

    Raises:
        InputError: an argument is not possible, or the cut-off leaves no mode.
    """
    require_step((), (), dt)
    if not radii or not all(0 < radius < float("inf") for radius in radii):
        raise InputError("tick: radii", "one finite number above 0 [m] for each tool", radii)
    rows, columns = model.modes
    kx = pi / model.size[0] * np.arange(1.0, rows + 1)
    ky = pi / model.size[1] * np.arange(1.0, columns + 1)
    m, n = np.nonzero(kx[:, None] ** 2 + ky[None, :] ** 2 <= cutoff**2)
    if not len(m):
        raise InputError(
            "tick: cutoff", f"at least {np.hypot(kx[0], ky[0]):.4g} [1/m], the longest wave", cutoff
        )
    parts, strip = np.unique(np.stack([m, n // STRIP]), axis=1, return_inverse=True)
    strip = strip.ravel()
    longest = np.zeros(parts.shape[1], dtype=np.int64)
    np.maximum.at(longest, strip, n % STRIP + 1)
    kept = m * columns + n
    step, outputs = model.oscillators.propagator(dt), model.oscillators.outputs[kept]
    order, layers = outputs.shape[2], outputs.shape[1]
    transition, end = step.transition[kept], step.end_gain[kept, ..., 0]
    gain = np.einsum("jrab,jrb->jra", transition, end) + step.start_gain[kept, ..., 0]
    turn = np.concatenate([transition.reshape(len(kept), order, 4), gain], axis=2)
    read = np.concatenate(
        [outputs.reshape(len(kept), layers, 2 * order), np.einsum("jkri,jri->jk", outputs, end)[..., None]],
        axis=2,
    )
    table = np.concatenate([turn.reshape(len(kept), -1), read.reshape(len(kept), -1)], axis=1)
    planes = np.zeros((parts.shape[1], table.shape[1], STRIP))
    planes[strip, :, n % STRIP] = np.where(np.abs(table) > TINY, table, 0.0)
    width = int(_padded(np.array([columns]))[0])
    return Tick(
        planes=planes.reshape(len(planes), -1),
        row=np.ascontiguousarray(parts[0]),
        first=parts[1] * STRIP,
        modes=_padded(longest),
        spread_x=_spread(kx, radii, rows),
        spread_y=_spread(ky, radii, width),
        size=np.array(model.size),
        end_gain=end,
        kept=kept,
        strip=strip,
        lane=n % STRIP,
        shape=(order, layers, rows, columns),
        dt=dt,
    )


def _padded(counts: IntArray) -> IntArray:
    result: IntArray = -(-counts // _LANES) * _LANES
    return result


def _spread(wavenumbers: FloatArray, radii: tuple[float, ...], width: int) -> FloatArray:
    table = np.zeros((len(radii), width))
    for tool, radius in enumerate(radii):
        spread = transform(Profile.GAUSSIAN, radius * wavenumbers)
        table[tool, : len(wavenumbers)] = np.where(spread > TINY, spread, 0.0)
    return table


def at_rest(tick: Tick) -> TickState:
    """Return the state at rest without load, and the scratch arrays."""
    order, layers, _, _ = tick.shape
    tools, rows = tick.spread_x.shape
    width = tick.spread_y.shape[1]
    return TickState(
        blocks=np.zeros((len(tick.row), 2 * order * STRIP)),
        force=np.zeros((len(tick.row), STRIP)),
        shapes_x=np.zeros((tools, rows)),
        shapes_y=np.zeros((tools, width)),
        read=np.zeros((tools, layers, width)),
        pressed_y=np.zeros((tools, width)),
        strip_read=np.zeros(STRIP),
    )


def from_wave_state(tick: Tick, model: WaveMembrane, state: WaveState) -> TickState:
    """Return where a model stands, under the load it stands with; modes beyond the cut-off are dropped."""
    ticking = at_rest(tick)
    order = tick.shape[0]
    (blocks,) = state.oscillators
    force = model.modal_forces(state.load)[tick.kept]
    ticking.force[tick.strip, tick.lane] = force
    planes = ticking.blocks.reshape(len(tick.row), order, 2, STRIP)
    planes[tick.strip, :, :, tick.lane] = blocks[tick.kept] - tick.end_gain * force[:, None, None]
    return ticking


def to_wave_state(tick: Tick, state: TickState, time: float, load: Load = ()) -> WaveState:
    """Return the model's state at a time [s], for its whole surface or its energy; load is what acts then."""
    order, _, rows, columns = tick.shape
    force = state.force[tick.strip, tick.lane]
    planes = state.blocks.reshape(len(tick.row), order, 2, STRIP)
    blocks = np.zeros((rows * columns, order, 2))
    blocks[tick.kept] = planes[tick.strip, :, :, tick.lane] + tick.end_gain * force[:, None, None]
    return WaveState(time, (blocks,), load)


@njit(cache=True)
def sines(place: float, side: float, out: FloatArray) -> None:  # pragma: no cover - compiled
    """Write sin(m pi place/side), m = 1, 2, ..., by differences.

    s_(m+1) - s_m = s_m - s_(m-1) - 4 sin^2(phi/2) s_m keeps its accuracy where phi is small (Reinsch's form
    of the three-term recurrence: Stoer and Bulirsch 2002, Introduction to Numerical Analysis, section 1.3);
    the far half is the mirror image of the near one.
    """
    mirrored = place > 0.5 * side
    phi = pi * ((side - place) if mirrored else place) / side
    turn = -4.0 * sin(0.5 * phi) ** 2
    value = sin(phi)
    change = value
    sign = 1.0
    for m in range(len(out)):
        out[m] = sign * value
        change += turn * value
        value += change
        if mirrored:
            sign = -sign


@njit(cache=True)
def advance_tick(
    tick: Tick, state: TickState, tools: FloatArray, displacement: FloatArray
) -> None:  # pragma: no cover - compiled
    """Advance by one tick: to tools at new places with new forces, from those of the last tick.

    Args:
        tick: parameters.
        state: overwritten.
        tools: x [m], y [m] and force [N], positive pressing in, of every tool at the end of the tick, shape
            (tools, 3). A tool that touches nothing has force 0; it should lie on the block.
        displacement: u_z [m] of every layer's upper face at the tools' centres at the end of the tick, shape
            (tools, layers); written.
    """
    order, layers, _, _ = tick.shape
    count = len(tools)
    for t in range(count):
        sines(tools[t, 0], tick.size[0], state.shapes_x[t])
        sines(tools[t, 1], tick.size[1], state.shapes_y[t])
        for n in range(state.shapes_y.shape[1]):
            state.pressed_y[t, n] = tick.spread_y[t, n] * state.shapes_y[t, n]
    state.read[:] = 0.0
    u = state.strip_read
    for s in range(len(tick.row)):
        m = tick.row[s]
        n0 = tick.first[s]
        modes = tick.modes[s]
        c = tick.planes[s]
        z = state.blocks[s]
        f = state.force[s]
        for i in range(order):
            e = c[i * _STEP_PLANES * STRIP :]
            x = z[2 * i * STRIP :]
            for j in range(modes):
                p = x[j]
                q = x[STRIP + j]
                x[j] = turned(e[j], e[STRIP + j], p, q, e[4 * STRIP + j] * f[j])
                x[STRIP + j] = turned(e[2 * STRIP + j], e[3 * STRIP + j], p, q, e[5 * STRIP + j] * f[j])
        for j in range(modes):
            f[j] = 0.0
        for t in range(count):
            push = -tools[t, 2] * tick.spread_x[t, m] * state.shapes_x[t, m]
            pressed = state.pressed_y[t, n0:]
            for j in range(modes):
                f[j] += push * pressed[j]
        r = c[order * _STEP_PLANES * STRIP :]
        for k in range(layers):
            own = r[k * (2 * order + 1) * STRIP :]
            at_once = own[2 * order * STRIP :]
            for j in range(modes):
                u[j] = at_once[j] * f[j]
            for i in range(order):
                out = own[2 * i * STRIP :]
                x = z[2 * i * STRIP :]
                for j in range(modes):
                    u[j] += out[j] * x[j] + out[STRIP + j] * x[STRIP + j]
            for t in range(count):
                weight = state.shapes_x[t, m]
                sums = state.read[t, k, n0:]
                for j in range(modes):
                    sums[j] += weight * u[j]
    for t in range(count):
        for k in range(layers):
            total = 0.0
            for n in range(state.read.shape[2]):
                total += state.shapes_y[t, n] * state.read[t, k, n]
            displacement[t, k] = total
