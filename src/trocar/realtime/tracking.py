"""From poses that come 60 to 90 times a second to one a tick: no jumps, no haste, nothing impossible.

Each coordinate follows the newest pose as a critically damped oscillator, stepped exactly for a pose held over the
tick: with e the distance to it, v the velocity and w = 2/s,

    e1 = (e + (v + w e) T) exp(-w T),   v1 = (v - w (v + w e) T) exp(-w T).

s is the `smoothing`: how far the instrument lags behind a hand that moves steadily. The handle then moves no faster
than `speed`. A pose with an impossible number is not followed: the last good one stays.
"""

from __future__ import annotations

from math import exp, isfinite, sqrt
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from numba import njit

from trocar.model import FloatArray
from trocar.simulation import HANDLE, JAW, POSE, PRESENT, ROLL

FARTHEST = 2.0  # [m] of a handle from the block's corner
MOST_TURNED = 1e4  # [rad]
JAW_SLACK = 1e-6  # of rounding, beyond 0..1


class Following(NamedTuple):
    """How poses are followed.

    Attributes:
        smoothing: s [s]; 0 for devices that bring a pose every tick.
        speed: of a handle at most [m/s]; what lies beyond is made good later.
    """

    smoothing: float = 8e-3
    speed: float = 1.0


class TrackState(NamedTuple):
    """Where the instruments are on their way.

    Attributes:
        target: the last good poses, shape (2, POSE).
        pose: followed so far, shape (2, POSE).
        velocity: of each coordinate, shape (2, POSE).
        step: scratch, shape (2, 3).
    """

    target: FloatArray
    pose: FloatArray
    velocity: FloatArray
    step: FloatArray


def absent() -> TrackState:
    """Return the state of two instruments that nobody holds."""
    return TrackState(
        target=np.zeros((2, POSE)),
        pose=np.zeros((2, POSE)),
        velocity=np.zeros((2, POSE)),
        step=np.zeros((2, 3)),
    )


@njit(cache=True, nogil=True)
def possible(pose: FloatArray) -> bool:  # pragma: no cover - compiled
    """Say whether a pose, shape (POSE,), is finite and in range."""
    for k in range(POSE):
        if not isfinite(pose[k]):
            return False
    x, y, z = pose[HANDLE], pose[HANDLE + 1], pose[HANDLE + 2]
    return bool(
        (pose[PRESENT] == 0.0 or pose[PRESENT] == 1.0)
        and x * x + y * y + z * z < FARTHEST * FARTHEST
        and abs(pose[ROLL]) <= MOST_TURNED
        and -JAW_SLACK <= pose[JAW] <= 1.0 + JAW_SLACK
    )


@njit(cache=True, nogil=True)
def aim(state: TrackState, hand: int, pose: FloatArray) -> bool:  # pragma: no cover - compiled
    """Follow a new pose, shape (POSE,), from now on.

    Returns:
        False where it was not possible and is not followed.
    """
    if not possible(pose):
        return False
    state.target[hand, :] = pose
    state.target[hand, JAW] = min(max(pose[JAW], 0.0), 1.0)
    return True


@njit(cache=True, nogil=True)
def arrive(state: TrackState) -> None:  # pragma: no cover - compiled
    """Put both instruments where their poses say, standing still: what follows owes nothing to what was."""
    state.pose[:] = state.target
    state.velocity[:] = 0.0


@njit(cache=True, nogil=True)
def follow(
    following: Following, state: TrackState, hand: int, period: float
) -> bool:  # pragma: no cover - compiled
    """Move one instrument by a tick of length `period` [s]; it is then at state.pose[hand].

    An instrument that was not there before is at once where the pose says.

    Returns:
        Whether the handle would have been faster than allowed.
    """
    target, pose, velocity = state.target[hand], state.pose[hand], state.velocity[hand]
    if target[PRESENT] == 0.0 or pose[PRESENT] == 0.0:
        pose[:] = target
        velocity[:] = 0.0
        return False
    w = 2.0 / following.smoothing if following.smoothing > 0.0 else 0.0
    decay = exp(-w * period)
    length = 0.0
    for k in range(HANDLE, POSE):
        if w > 0.0:
            e = pose[k] - target[k]
            drive = velocity[k] + w * e
            velocity[k] = (velocity[k] - w * drive * period) * decay
            new = target[k] + (e + drive * period) * decay
        else:
            new = target[k]
        if k < HANDLE + 3:
            length += (new - pose[k]) ** 2
            state.step[hand, k - HANDLE] = new - pose[k]
        else:
            pose[k] = new
    length = sqrt(length)
    most = following.speed * period
    share = most / length if length > most else 1.0
    for k in range(3):
        pose[HANDLE + k] += share * state.step[hand, k]
        velocity[HANDLE + k] *= share
    if pose[JAW] < 0.0 or pose[JAW] > 1.0:  # carried past the end by its speed
        pose[JAW] = min(max(pose[JAW], 0.0), 1.0)
        velocity[JAW] = 0.0
    return share < 1.0


@njit(cache=True, nogil=True)
def follow_again(
    following: Following,
    state: TrackState,
    targets: FloatArray,
    began: npt.NDArray[np.bool_],
    period: float,
    poses: FloatArray,
) -> None:  # pragma: no cover - compiled
    """Follow poses once more as the servo did, tick by tick.

    Args:
        following: how.
        state: of the instruments, overwritten.
        targets: newest good poses in each tick, shape (n, 2, POSE).
        began: whether a tick began from rest, shape (n,).
        period: of a tick [s].
        poses: overwritten with where the instruments were, shape (n, 2, POSE).
    """
    for tick in range(len(targets)):
        state.target[:] = targets[tick]
        if began[tick]:
            arrive(state)
        for hand in range(2):
            follow(following, state, hand, period)
            poses[tick, hand, :] = state.pose[hand]
