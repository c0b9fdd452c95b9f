"""The force chain: what is left of the tissue's force before a hand feels it. No stage makes a force larger.

A device holds each force for one period T while the hand moves on, so a simulated spring gives back more than was put
in, and only the device's own damping b takes it away. In this order, F of the tissue, x the hand's place:

1. a number that is not finite makes the force zero, until the servo is reset;
2. |F| grows by at most K |x(n) - x(n-1)| a tick, and what `still_growth` allows a hand that does not move, with
   K = 2 b/T: above it a sampled wall gives energy (Colgate and Schenkel 1997, J Robotic Syst 14:37, b > K T/2);
3. an energy tank: |F| <= sqrt(4 b (E0 - G)/T), G the energy given to the hand so far less what b took. The held
   force does the work F(n-1).(x(n) - x(n-1)), exactly, and b takes b |x(n) - x(n-1)|^2/T at least, so that
   dG = F.dx - b |dx|^2/T is never too small. Its largest value over all motions is F^2 T/(4 b): G <= E0 whatever the
   hand does. It is ours, kin to energy bounding (Kim and Ryu 2010, Int J Robot Res 29:666);
4. F changes by at most `slew` T, falling excepted: a force is never held up against 2 or 3;
5. |F| <= `clamp`;
6. without a beat of the parent it falls: whole for 50 ms, then linearly to zero at 100 ms.

b must be a lower bound on the damping of the device in the hand. Credit from damping is kept up to `credit`, so that
minutes of calm do not buy a storm. One hand at a time, three translations; turning is not fed back.
"""

from __future__ import annotations

from math import isfinite, sqrt
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from numba import njit

from trocar.model import FloatArray

STILL_WHOLE = 0.05  # [s] without a beat until which forces stay what they are
GONE = 0.1  # [s] without a beat from which they are zero
UNTOUCHED, LIMITED, LATCHED = 0, 1, 2  # what the chain did


class GuardLimits(NamedTuple):
    """What a hand may feel.

    Attributes:
        damping: b, at least this much has the device in the hand [N s/m]. 0.2 makes K the 400 N/m that CHAI3D
            states for a Touch; that a Touch has it is an assumption.
        still_growth: how fast a force may grow on a hand that does not move [N/s].
        reserve: E0, energy that may be given to a hand before it has given any [J].
        credit: energy from the hand that is remembered [J].
        slew: fastest growth and turn of a force [N/s].
        clamp: largest force [N]; 3.3 is a Touch's.
    """

    damping: float = 0.2
    still_growth: float = 2.0
    reserve: float = 5e-3
    credit: float = 0.1
    slew: float = 500.0
    clamp: float = 3.3


class GuardState(NamedTuple):
    """What the chain remembers of both hands.

    Attributes:
        force: given in the last tick [N], shape (2, 3).
        place: of the hand in the last tick [m], shape (2, 3).
        given: G [J], shape (2,).
        held: whether the instrument was in a hand, shape (2,).
        latched: whether a number was not finite since the last reset, shape (2,).
    """

    force: FloatArray
    place: FloatArray
    given: FloatArray
    held: npt.NDArray[np.bool_]
    latched: npt.NDArray[np.bool_]


def unloaded() -> GuardState:
    """Return the state of two hands that feel nothing."""
    return GuardState(
        force=np.zeros((2, 3)),
        place=np.zeros((2, 3)),
        given=np.zeros(2),
        held=np.zeros(2, bool),
        latched=np.zeros(2, bool),
    )


@njit(cache=True, nogil=True)
def forget(state: GuardState) -> None:  # pragma: no cover - compiled
    """Start over, latches included."""
    state.force[:] = 0.0
    state.place[:] = 0.0
    state.given[:] = 0.0
    state.held[:] = False
    state.latched[:] = False


@njit(cache=True, nogil=True)
def stiffness_bound(damping: float, period: float) -> float:  # pragma: no cover - compiled
    """Return the stiffest passive wall, K = 2 b/T [N/m]."""
    return 2.0 * damping / period


@njit(cache=True, nogil=True)
def growth_bound(
    previous: float, moved: float, limits: GuardLimits, period: float
) -> float:  # pragma: no cover - compiled
    """Return the largest force [N] after one of size `previous` [N] when the hand has moved so far [m]."""
    return previous + stiffness_bound(limits.damping, period) * moved + limits.still_growth * period


@njit(cache=True, nogil=True)
def energy_given(
    work: float, moved: float, damping: float, period: float
) -> float:  # pragma: no cover - compiled
    """Return dG [J]: the work of the held force on the hand [J], less what damping took over a motion [m]."""
    return work - damping * moved * moved / period


@njit(cache=True, nogil=True)
def tank_bound(
    given: float, reserve: float, damping: float, period: float
) -> float:  # pragma: no cover - compiled
    """Return the largest force [N] that cannot overdraw the tank, whatever the hand does next."""
    return sqrt(4.0 * damping * max(reserve - given, 0.0) / period)


@njit(cache=True, nogil=True)
def beat_factor(silence: float) -> float:  # pragma: no cover - compiled
    """Return the share of a force that is left so long after the last beat [s]."""
    return min(max((GONE - silence) / (GONE - STILL_WHOLE), 0.0), 1.0)


@njit(cache=True, nogil=True)
def guarded(
    limits: GuardLimits,
    state: GuardState,
    hand: int,
    wanted: FloatArray,
    place: FloatArray,
    holds: bool,
    silence: float,
    period: float,
    force: FloatArray,
) -> int:  # pragma: no cover - compiled
    """Pass one hand's force through the chain.

    Args:
        limits: what the hand may feel.
        state: overwritten.
        hand: 0 left, 1 right.
        wanted: force of the tissue on the hand [N], shape (3,).
        place: of the hand [m], shape (3,).
        holds: whether the instrument is in the hand.
        silence: time since the parent's last beat [s].
        period: T [s].
        force: overwritten with what the hand may feel [N], shape (3,).

    Returns:
        `UNTOUCHED`; `LIMITED`, where a stage made it smaller; `LATCHED`, where the first stage has made it zero.
    """
    last = state.force[hand]
    force[:] = 0.0
    moved = 0.0
    work = 0.0
    finite = isfinite(silence)
    for k in range(3):
        finite = finite and isfinite(wanted[k]) and isfinite(place[k])
        if state.held[hand]:
            step = place[k] - state.place[hand, k]
            moved += step * step
            work += last[k] * step
    moved = sqrt(moved)
    size = _size(wanted)
    if not (finite and isfinite(size)):
        state.latched[hand] = True
    if state.latched[hand]:
        last[:] = 0.0
        state.held[hand] = False
        return LATCHED
    if not holds:
        last[:] = 0.0
        state.held[hand] = False
        return UNTOUCHED
    given = state.given[hand] + energy_given(work, moved, limits.damping, period)
    state.given[hand] = max(given, -limits.credit)
    before = _size(last)
    allowed = min(
        growth_bound(before, moved, limits, period),
        tank_bound(state.given[hand], limits.reserve, limits.damping, period),
    )
    share = allowed / size if size > allowed else 1.0
    change = 0.0
    for k in range(3):
        force[k] = share * wanted[k]
        change += (force[k] - last[k]) ** 2
    change = sqrt(change)
    target = min(size, allowed)
    if change > limits.slew * period:
        for k in range(3):
            force[k] = last[k] + limits.slew * period / change * (force[k] - last[k])
    left = min(target, limits.clamp)
    reached = _size(force)
    factor = beat_factor(silence) * (left / reached if reached > left else 1.0)
    state.held[hand] = True
    touched = 0.0
    for k in range(3):
        force[k] *= factor
        last[k] = force[k]
        state.place[hand, k] = place[k]
        touched += abs(force[k] - wanted[k])
    return LIMITED if touched > 1e-9 * size else UNTOUCHED


@njit(cache=True, nogil=True)
def _size(vector: FloatArray) -> float:  # pragma: no cover - compiled
    return sqrt(vector[0] ** 2 + vector[1] ** 2 + vector[2] ** 2)
