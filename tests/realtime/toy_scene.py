"""Physics for tests: a spring under each handle below z = 0, and what a test asks to go wrong."""

import time
from typing import NamedTuple

import numpy as np
from numba import njit

from trocar.realtime.clock import now
from trocar.realtime.physics import Physics
from trocar.simulation import DEPTH, FORCE, HANDLE, HANDLE_FORCE, JAW, PRESENT, RECORD_JAW, ROLL, TIP, TOUCH


class Pad(NamedTuple):
    stiffness: float
    roll_of_nan: float  # a handle turned this far makes the force not a number
    roll_of_fault: float  # a handle turned this far makes `advance` give up
    roll_of_hang: float  # this far, it never comes back
    roll_of_sloth: float  # this far, it takes three ticks


class ToyScene(NamedTuple):
    dt: float
    modes: tuple[int, int]
    layers: int
    pad: Pad


class ToyState(NamedTuple):
    ticks: np.ndarray
    deepest: np.ndarray


def toy_scene(stiffness=100.0, dt=1e-3):
    return ToyScene(dt, (3, 2), 2, Pad(stiffness, 7.0, 8.0, 9.0, 10.0))


def at_rest():
    return ToyState(ticks=np.zeros(1, np.int64), deepest=np.zeros(2))


@njit(cache=True, nogil=True)
def advance(scene, state, poses, records):
    state.ticks[0] += 1
    records[:] = 0.0
    for hand in range(2):
        if poses[hand, PRESENT] == 0.0:
            continue
        roll = poses[hand, ROLL]
        if roll == scene.pad.roll_of_fault:
            return False
        enough = now() + (3_000_000 if roll == scene.pad.roll_of_sloth else 0)
        while now() < enough or roll == scene.pad.roll_of_hang:
            state.ticks[0] += 1
        depth = max(-poses[hand, HANDLE + 2], 0.0)
        state.deepest[hand] = max(state.deepest[hand], depth)
        records[hand, TIP : TIP + 3] = poses[hand, HANDLE : HANDLE + 3]
        records[hand, RECORD_JAW] = poses[hand, JAW]
        records[hand, DEPTH] = depth
        records[hand, TOUCH] = 3.0 if depth > 0.0 else 1.0
        records[hand, FORCE + 2] = scene.pad.stiffness * depth
        records[hand, HANDLE_FORCE + 2] = scene.pad.stiffness * depth
        if roll == scene.pad.roll_of_nan:
            records[hand, HANDLE_FORCE] = np.nan
    return True


@njit(cache=True, nogil=True)
def amplitudes(scene, state, out):
    out[:] = 0.0
    for layer in range(scene.layers):
        out[layer, 0, 0] = -state.deepest[0] / (1 + layer)


@njit(cache=True, nogil=True)
def come_to_rest(scene, state):
    state.deepest[:] = 0.0


@njit
def broken_advance(scene, state, poses, records):
    return scene.no_such_thing


TOY = Physics(advance=advance, amplitudes=amplitudes, come_to_rest=come_to_rest)


def until(condition, within=60.0, beating=None):
    """Wait for something, and say whether it came; keep a servo alive meanwhile."""
    end = time.monotonic() + within
    while time.monotonic() < end:
        if beating is not None:
            beating.beat()
        if condition():
            return True
        time.sleep(2e-3)
    return False
