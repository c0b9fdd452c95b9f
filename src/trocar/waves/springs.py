"""Springs on the waves of the upper face, compiled: what something stiffer beneath it does in each tick.

Spring a feels e_a = sum over waves of B_a u, and holds sigma = S e against them: the waves get the forces -B sigma.
Like a press it is held over a tick, and like one it is what is right at the tick's end,

    e = e0 - h F - B^T w B sigma,   so   sigma = A (e0 - h F),   A = (S^-1 + B^T w B)^-1,

with e0 what the springs would feel without the next forces, F the points' forces into the surface, h what these do to
e within the tick, and w what a wave yields within it. S is positive, so nothing it does gives energy, whatever the
tick. To the points the surface is stiffer by h^T A h, and it lies h^T A e0 deeper.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from numba import njit

from trocar.model import FloatArray
from trocar.waves.tick import TickState


class Springs(NamedTuple):
    """What does not change of them; of none, every shape has a zero.

    Attributes:
        row, column: m - 1 and n - 1 of the waves they feel, shape (waves,).
        feel: B [1/m], shape (waves, springs).
        answer: A [J]; S is 1 J each; shape (springs, springs).
        table: what a newton into the surface at a node of a grid, spread as a patch's point is, does to them within a
            tick: h [1/N], shape (nx, ny, springs).
        spacing: of the grid along x and y [m], shape (2,).
        quiet: what they take from a point's compliance may be left out of it below this [m/N].
    """

    row: npt.NDArray[np.int64]
    column: npt.NDArray[np.int64]
    feel: FloatArray
    answer: FloatArray
    table: FloatArray
    spacing: FloatArray
    quiet: float


class SpringState(NamedTuple):
    """What changes of them, in place.

    Attributes:
        free: e0, shape (springs,); held: A e0 [J], shape (springs,).
        points: h at every patch's points [1/N], shape (tools P P, springs).
        stiff: scratch, A h, shape (tools P P, springs).
        stress: sigma held in this tick [J], shape (springs,).
        near: whether a patch does anything to them to speak of, shape (tools,).
    """

    free: FloatArray
    held: FloatArray
    points: FloatArray
    stiff: FloatArray
    stress: FloatArray
    near: np.ndarray


NO_SPRINGS = Springs(
    row=np.zeros(0, dtype=np.int64),
    column=np.zeros(0, dtype=np.int64),
    feel=np.zeros((0, 0)),
    answer=np.zeros((0, 0)),
    table=np.zeros((0, 0, 0)),
    spacing=np.ones(2),
    quiet=0.0,
)


def springs_at_rest(springs: Springs, tools: int, each: int) -> SpringState:
    """Return the state at rest of springs under the patches of some tools, with so many points each."""
    count, points = len(springs.answer), tools * each
    return SpringState(
        free=np.zeros(count),
        held=np.zeros(count),
        points=np.zeros((points, count)),
        stiff=np.zeros((points, count)),
        stress=np.zeros(count),
        near=np.zeros(tools, dtype=np.bool_),
    )


@njit(cache=True, nogil=True)
def feel_waves(springs: Springs, state: SpringState, tick: TickState) -> None:  # pragma: no cover - compiled
    """Read what the springs would feel without the next forces, once the waves have gone on."""
    count = len(springs.answer)
    for a in range(count):
        state.free[a] = 0.0
    for j in range(len(springs.row)):
        amplitude = tick.surface[springs.row[j], springs.column[j]]
        for a in range(count):
            state.free[a] += springs.feel[j, a] * amplitude
    for a in range(count):
        held = 0.0
        for b in range(count):
            held += springs.answer[a, b] * state.free[b]
        state.held[a] = held


@njit(cache=True, nogil=True)
def feel_points(
    springs: Springs, state: SpringState, offsets: FloatArray, tool: int, x: float, y: float
) -> None:  # pragma: no cover - compiled
    """Read what the points of a patch at x, y [m] do to the springs; their offsets are those of all tools [m]."""
    count = len(springs.answer)
    state.near[tool] = False
    if count == 0:
        return
    each = offsets.shape[1]
    last_x, last_y = springs.table.shape[0] - 1, springs.table.shape[1] - 1
    loud = 0.0
    for i in range(each):
        right = min(max((x + offsets[tool, i]) / springs.spacing[0], 0.0), float(last_x))
        at_x = min(int(right), last_x - 1)
        p = right - at_x
        for k in range(each):
            up = min(max((y + offsets[tool, k]) / springs.spacing[1], 0.0), float(last_y))
            at_y = min(int(up), last_y - 1)
            q = up - at_y
            point = state.points[(tool * each + i) * each + k]
            stiff = state.stiff[(tool * each + i) * each + k]
            one, two = springs.table[at_x, at_y], springs.table[at_x, at_y + 1]
            three, four = springs.table[at_x + 1, at_y], springs.table[at_x + 1, at_y + 1]
            for a in range(count):
                point[a] = (1 - p) * ((1 - q) * one[a] + q * two[a]) + p * ((1 - q) * three[a] + q * four[a])
            taken = 0.0
            for a in range(count):
                total = 0.0
                for b in range(count):
                    total += springs.answer[a, b] * point[b]
                stiff[a] = total
                taken += total * point[a]
            loud = max(loud, taken)
    state.near[tool] = loud > springs.quiet


@njit(cache=True, nogil=True)
def lie_deeper(
    springs: Springs, state: SpringState, tool: int, sunk: FloatArray
) -> None:  # pragma: no cover - compiled
    """Add what the springs draw the surface down by at a patch's points [m], shape (P P,)."""
    for i in range(len(sunk)):
        for a in range(len(springs.answer)):
            sunk[i] += state.points[tool * len(sunk) + i, a] * state.held[a]


@njit(cache=True, nogil=True)
def stiffen(
    springs: Springs, state: SpringState, one: int, other: int, out: FloatArray
) -> None:  # pragma: no cover - compiled
    """Take from how far points of a patch sink per newton on those of another what the springs hold; (P P, P P)."""
    points = len(out)
    for i in range(points):
        for k in range(points):
            for a in range(len(springs.answer)):
                out[i, k] -= state.points[one * points + i, a] * state.stiff[other * points + k, a]


@njit(cache=True, nogil=True)
def hold_springs(
    springs: Springs, state: SpringState, tick: TickState, forces: FloatArray
) -> None:  # pragma: no cover - compiled
    """Add the springs' forces to those that the waves are held with; `forces` of all points [N] are part of it."""
    count = len(springs.answer)
    if count == 0:
        return
    for a in range(count):
        state.stress[a] = state.held[a]
    for i in range(len(forces)):
        if forces[i] != 0.0:
            for a in range(count):
                state.stress[a] -= state.stiff[i, a] * forces[i]
    for j in range(len(springs.row)):
        total = 0.0
        for a in range(count):
            total += springs.feel[j, a] * state.stress[a]
        tick.force[springs.row[j], springs.column[j]] -= total
