"""One tick of a live tissue, laid out for compiled code: which modes move, how they step, where instruments touch.

An instrument touches through a patch of P x P points about its place, each a Gaussian of width s/sqrt(2) (one
standard deviation) over which its force is spread and the surface is read: of waves k the patch passes
exp(-(s k)^2/4) each way. What the window leaves out, `near_field` counts. A force is held over a tick, so a block's
exact step

    x1 = E x0 + W f    is stepped as    z1 = E z0 + (E W) f0,    z = x - W f,    W = W0 + W1:

z1 is where the block would be without the next force, and W what that force adds at once by the end of the tick, which
is what an implicit contact law asks for. Layer k's amplitude is R_k z1 + (R_k W) f1.

Memory: a strip is up to 32 modes of one row m, and its coefficients lie in planes of 32, one after the other, so that a
compiled loop over a strip runs along every plane at once. Only modes with kx^2 + ky^2 <= K^2 are kept.
"""

from __future__ import annotations

from math import pi
from typing import NamedTuple, Protocol

import numpy as np
import numpy.typing as npt

from trocar.errors import InputError
from trocar.model import FloatArray
from trocar.waves.kernel import TINY
from trocar.waves.oscillators import Oscillators
from trocar.waves.state import require_step

IntArray = npt.NDArray[np.int64]

STRIP = 32  # modes: a strip's planes share a page of memory, and few rows need a second strip
LANES = 8  # doubles in the widest vector register; strips are padded to a multiple with zeros
STEP_PLANES = 6  # of one block: E (4), E W (2)
_CONTINUED = 8  # rows from which the waves without a sine are continued
FAR = 1e-4  # of its own: what a point does to another within one tick is left out below


class LiveWaves(Protocol):
    """A wave model whose upper face can be pressed in ticks."""

    @property
    def size(self) -> tuple[float, float]:
        """Sides a, b [m]."""
        ...

    @property
    def surface_modes(self) -> tuple[int, int]:
        """Highest m and n that move."""
        ...

    @property
    def surface_oscillators(self) -> Oscillators:
        """One group per mode (m, n), n fastest: from a modal force [N] to u_z of every layer's upper face [m]."""
        ...


class Tick(NamedTuple):
    """What a tick needs to know; a named tuple, because compiled code takes one whole. Nothing in it changes.

    Attributes:
        planes: coefficients, shape (strips, planes * 32): for each of r blocks E00, E01, E10, E11, G0, G1 with
            G = E W; then for each of k layers R0, R1 of every block, and R W.
        row: m - 1 of each strip, shape (strips,).
        first: n - 1 of its first mode, a multiple of 32, shape (strips,).
        modes: how many modes a strip steps, padding included, shape (strips,).
        offsets: of a patch's points from its centre, along x as along y [m], shape (tools, P).
        shift_x, shift_y: exp(-(s k)^2/4) times cos(k d) and sin(k d) of its points' offsets d, shapes (2, tools P, M)
            and (2, tools P, N padded).
        size: sides a, b [m], shape (2,).
        gain: W of every mode kept, shape (kept, r, 2).
        at_once: R W of the top layer, shape (M, N padded); 0 beyond the cut-off.
        kept: number of each mode kept among the model's, shape (kept,).
        strip, lane: where it is stepped, shape (kept,).
        inside: how far a patch's points push each other in within a tick, far from the sides [m/N], shape
            (tools, P P, P P).
        apart: distance from which on points do not push each other in within a tick [m].
        shape: blocks r, layers k of a mode, highest modes M, N kept.
        model: modes the model has.
        dt: length of a tick [s].
    """

    planes: FloatArray
    row: IntArray
    first: IntArray
    modes: IntArray
    offsets: FloatArray
    shift_x: FloatArray
    shift_y: FloatArray
    size: FloatArray
    gain: FloatArray
    at_once: FloatArray
    kept: IntArray
    strip: IntArray
    lane: IntArray
    inside: FloatArray
    apart: float
    shape: tuple[int, int, int, int]
    model: tuple[int, int]
    dt: float


class TickState(NamedTuple):
    """What a tick changes, in place.

    Attributes:
        blocks: z = x - W f, shape (strips, 2 r * 32).
        force: modal forces f held in the last tick [N], shape (M, N padded).
        shapes_x, shapes_y: sin(kx x) and sin(ky y) at every patch's points times what the window passes, shapes
            (tools P, M) and (tools P, N padded).
        surface: amplitudes of the top layer without the next forces [m], shape (M, N padded).
        waves: scratch, sin and cos of a patch's centre, shape (2, the longer of M and N padded).
        rows: scratch, sums over the rows, shape (tools P, N padded).
        pushes: scratch, forces of one patch as a matrix, shape (P, P).
        pairs_x, pairs_y, pairs_sum: scratch for pairs of points, shapes (P P, M), (N padded, P P), (P P, N padded).
        pairs: scratch, shape (P P, P P).
    """

    blocks: FloatArray
    force: FloatArray
    shapes_x: FloatArray
    shapes_y: FloatArray
    surface: FloatArray
    waves: FloatArray
    rows: FloatArray
    pushes: FloatArray
    pairs_x: FloatArray
    pairs_y: FloatArray
    pairs_sum: FloatArray
    pairs: FloatArray


def make_tick(
    waves: LiveWaves, dt: float, *, window: float, offsets: FloatArray, cutoff: float = float("inf")
) -> Tick:
    """Lay out a model's exact step of length dt [s] for as many patches as rows of offsets are given.

    Args:
        waves: the tissue; its modes bound those of the tick.
        dt: length of a tick [s].
        window: s [m].
        offsets: of the patches' points from their centres, along x as along y [m], shape (tools, P).
        cutoff: the largest wavenumber kept [1/m]; see `measured_cutoff`.

    Raises:
        InputError: an argument is not possible, or the cut-off leaves no mode.
    """
    require_step((), (), dt)
    if not 0 < window < float("inf"):
        raise InputError("tick: window", "a finite length above 0 [m]", window)
    if offsets.ndim != 2 or not offsets.size or not np.isfinite(offsets).all():
        raise InputError("tick: offsets", "finite numbers [m], a row for each tool", offsets)
    rows, columns = waves.surface_modes
    kx = pi / waves.size[0] * np.arange(1.0, rows + 1)
    ky = pi / waves.size[1] * np.arange(1.0, columns + 1)
    m, n = np.nonzero(kx[:, None] ** 2 + ky[None, :] ** 2 <= cutoff**2)
    if not len(m):
        longest = float(np.hypot(kx[0], ky[0]))
        raise InputError("tick: cutoff", f"at least {longest:.4g} [1/m], the longest wave", cutoff)
    parts, strip = np.unique(np.stack([m, n // STRIP]), axis=1, return_inverse=True)
    strip = strip.ravel()
    longest_run = np.zeros(parts.shape[1], dtype=np.int64)
    np.maximum.at(longest_run, strip, n % STRIP + 1)
    kept = m * columns + n
    oscillators = waves.surface_oscillators
    step, outputs = oscillators.propagator(dt), oscillators.outputs[kept]
    order, layers = outputs.shape[2], outputs.shape[1]
    all_hold = (step.start_gain + step.end_gain)[..., 0]
    transition, hold = step.transition[kept], all_hold[kept]
    turn = np.concatenate(
        [
            transition.reshape(len(kept), order, 4),
            np.einsum("jrab,jrb->jra", transition, hold),
        ],
        axis=2,
    )
    at_once = np.einsum("jkri,jri->jk", outputs, hold)
    read = np.concatenate([outputs.reshape(len(kept), layers, 2 * order), at_once[..., None]], axis=2)
    table = np.concatenate([turn.reshape(len(kept), -1), read.reshape(len(kept), -1)], axis=1)
    planes = np.zeros((parts.shape[1], table.shape[1], STRIP))
    planes[strip, :, n % STRIP] = np.where(np.abs(table) > TINY, table, 0.0)
    high_m, high_n = int(m.max()) + 1, int(n.max()) + 1
    width = int(_padded(high_n))
    at_once_table = np.zeros((high_m, width))
    at_once_table[m, n] = np.where(np.abs(at_once[:, 0]) > TINY, at_once[:, 0], 0.0)
    spectrum = _spectrum(np.einsum("jri,jri->j", oscillators.outputs[:, 0], all_hold).reshape(rows, columns))
    spectrum *= np.exp(-0.5 * window**2 * (_with_zero(kx)[:, None] ** 2 + _with_zero(ky) ** 2))
    spectrum[_with_zero(kx)[:, None] ** 2 + _with_zero(ky) ** 2 > cutoff**2] = 0.0
    inside = np.stack([_between(spectrum, waves.size, row) for row in offsets])
    return Tick(
        planes=planes.reshape(len(planes), -1),
        row=np.ascontiguousarray(parts[0]),
        first=parts[1] * STRIP,
        modes=np.asarray(_padded(longest_run), dtype=np.int64),
        offsets=np.ascontiguousarray(offsets, dtype=np.float64),
        shift_x=_shifts(kx[:high_m], window, offsets, high_m),
        shift_y=_shifts(ky[:high_n], window, offsets, width),
        size=np.array(waves.size),
        gain=np.ascontiguousarray(hold),
        at_once=at_once_table,
        kept=kept,
        strip=strip,
        lane=n % STRIP,
        inside=inside,
        apart=_reach(spectrum, waves.size),
        shape=(order, layers, high_m, high_n),
        model=(rows, columns),
        dt=dt,
    )


def _shifts(wavenumbers: FloatArray, window: float, offsets: FloatArray, width: int) -> FloatArray:
    table = np.zeros((2, offsets.size, width))
    phase = np.outer(offsets.ravel(), wavenumbers)
    passed = np.exp(-0.25 * (window * wavenumbers) ** 2)
    table[0, :, : len(wavenumbers)], table[1, :, : len(wavenumbers)] = (
        passed * np.cos(phase),
        passed * np.sin(phase),
    )
    return table


def _padded(counts: IntArray | int) -> IntArray | int:
    return -(-counts // LANES) * LANES


def _with_zero(wavenumbers: FloatArray) -> FloatArray:
    return np.append(0.0, wavenumbers)


def _spectrum(at_once: FloatArray) -> FloatArray:
    """Return the cosine spectrum S of what a point does to another within a tick, shape (M + 1, N + 1).

    With products of sines written as sums, and G(x, y) the sum of S cos(kx x) cos(ky y), a point does to another

        G(x - x', y - y') - G(x + x', y - y') - G(x - x', y + y') + G(x + x', y + y'):

    itself and its mirror images in the sides. Waves without a sine, m = 0 or n = 0, cancel in the four, so their share
    may be chosen: continued from the others it lets G die away with the distance.
    """
    table = np.empty((at_once.shape[0] + 1, at_once.shape[1] + 1))
    table[1:, 1:] = at_once
    table[0, 1:] = _continued(at_once)
    table[:, 0] = _continued(table[:, 1:].T)
    table[0, :] *= 0.5
    table[:, 0] *= 0.5
    return 0.25 * table


def _continued(rows: FloatArray) -> FloatArray:
    """Continue a table, even in its row number m = 1, 2, ..., to m = 0: Lagrange's polynomial in m^2."""
    count = min(len(rows), _CONTINUED)
    nodes = np.arange(1.0, count + 1) ** 2
    weights = [np.prod(np.delete(nodes, i) / (np.delete(nodes, i) - nodes[i])) for i in range(count)]
    result: FloatArray = np.array(weights) @ rows[:count]
    return result


def _waves(size: tuple[float, float], spectrum: FloatArray) -> tuple[FloatArray, FloatArray]:
    rows, columns = spectrum.shape
    return pi / size[0] * np.arange(float(rows)), pi / size[1] * np.arange(float(columns))


def _between(spectrum: FloatArray, size: tuple[float, float], offsets: FloatArray) -> FloatArray:
    """Return what a patch's points do to each other without the sides' mirror images, shape (P P, P P) [m/N]."""
    points = len(offsets)
    gaps, places = np.unique(np.abs(offsets[:, None] - offsets[None, :]).ravel(), return_inverse=True)
    kx, ky = _waves(size, spectrum)
    at = np.cos(np.outer(gaps, kx)) @ spectrum @ np.cos(np.outer(ky, gaps))
    place = places.reshape(points, points)
    table = at[place[:, None, :, None], place[None, :, None, :]]
    return np.ascontiguousarray(table.reshape(points * points, points * points))


def _reach(spectrum: FloatArray, size: tuple[float, float]) -> float:
    """Return the distance from which on a point does to another less than `FAR` of what it does to itself [m]."""
    distances = np.linspace(0.0, min(size), 481)
    kx, ky = _waves(size, spectrum)
    worst = np.zeros_like(distances)
    for angle in np.linspace(0.0, 0.5 * pi, 7):
        along_x, along_y = np.outer(distances * np.cos(angle), kx), np.outer(distances * np.sin(angle), ky)
        worst = np.maximum(
            worst, np.abs(np.einsum("dm,mn,dn->d", np.cos(along_x), spectrum, np.cos(along_y)))
        )
    loud = int(np.flatnonzero(worst > FAR * worst[0])[-1]) + 1
    return float(distances[loud]) if loud < len(distances) else 2 * sum(size)


def at_rest(tick: Tick) -> TickState:
    """Return the state at rest without load, and the scratch arrays."""
    order, _, rows, _ = tick.shape
    tools, points = tick.offsets.shape
    width = tick.at_once.shape[1]
    return TickState(
        blocks=np.zeros((len(tick.row), 2 * order * STRIP)),
        force=np.zeros((rows, width)),
        shapes_x=np.zeros((tools * points, rows)),
        shapes_y=np.zeros((tools * points, width)),
        surface=np.zeros((rows, width)),
        waves=np.zeros((2, max(rows, width))),
        rows=np.zeros((tools * points, width)),
        pushes=np.zeros((points, points)),
        pairs_x=np.zeros((points * points, rows)),
        pairs_y=np.zeros((width, points * points)),
        pairs_sum=np.zeros((points * points, width)),
        pairs=np.zeros((points * points, points * points)),
    )


def oscillators_of(tick: Tick, state: TickState) -> FloatArray:
    """Return the state as the model's oscillators have it, modes beyond the cut-off at rest; shape (M N, r, 2)."""
    order, (rows, columns) = tick.shape[0], tick.model
    force = state.force[tick.row[tick.strip], tick.first[tick.strip] + tick.lane]
    planes = state.blocks.reshape(len(tick.row), order, 2, STRIP)
    blocks = np.zeros((rows * columns, order, 2))
    blocks[tick.kept] = planes[tick.strip, :, :, tick.lane] + tick.gain * force[:, None, None]
    return blocks
