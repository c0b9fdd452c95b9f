"""Random ways of two tips that try to draw energy from contact."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from trocar.contact.instrument import Instrument
from trocar.model import FloatArray
from trocar.simulation import DT, poses_along

TICKS = 600
_OVER, _DEEPEST = (
    3e-3,
    0.8e-3,
)  # [m] where they start above the block; how far their ends go into it: their undersides to 1.4e-3
_SPEEDS = (0.05, 0.3, 1.0)  # [m/s] at most, along each axis
_CLOSE = 6e-3  # [m] of a start from the middle between both
_RIM = 4e-3  # [m] beyond a side and within it

Ways = tuple[FloatArray, FloatArray]


def jerk(rng: np.random.Generator, size: tuple[float, float]) -> Ways:
    """Straight at up to 1 m/s, another way every 20 ticks or so, all over the block and above it."""
    low, high = np.array([0.004, 0.004, -_DEEPEST]), np.array([size[0] - 0.004, size[1] - 0.004, 0.004])
    return _jerked(rng, low, high, _starts(rng, size))


def rim(rng: np.random.Generator, size: tuple[float, float]) -> Ways:
    """The same about one side of the block, on it and off it."""
    low, high = np.array([-_RIM, 0.0, -_DEEPEST]), np.array([_RIM, size[1], 0.004])
    starts = np.column_stack([np.full(2, 0.5 * _RIM), rng.uniform(0.3, 0.7, 2) * size[1], np.full(2, _OVER)])
    return _jerked(rng, low, high, starts)


def zigzag(rng: np.random.Generator, size: tuple[float, float]) -> Ways:
    """To and fro in every tick, pressed in: as bad as friction at half the tick rate can be."""
    ticks = np.arange(TICKS)
    ways = []
    for start in _starts(rng, size):
        step = rng.uniform(0.1e-3, 1e-3)
        depth = np.maximum(_OVER - 1e-3 * ticks, -rng.uniform(0.2, 1) * _DEEPEST)
        along = start[0] + step * (ticks % 2) * (ticks > 8)
        ways.append(np.stack([along, np.full(TICKS, start[1]), depth], axis=1))
    return ways[0], ways[1]


def sine(rng: np.random.Generator, size: tuple[float, float]) -> Ways:
    """Smooth swings of 0.5 to 15 Hz, up to 8 mm across and 2 mm deep."""
    seconds = DT * np.arange(TICKS)[:, None]
    ways = []
    for start in _starts(rng, size):
        swing = np.array([8e-3, 8e-3, 2e-3]) * rng.uniform(0.2, 1, 3)
        way = start + swing * np.sin(2 * np.pi * rng.uniform(0.5, 15, 3) * seconds)
        way[:, 2] -= _OVER * np.minimum(1, seconds[:, 0] / 0.05)
        way[:, 2] = np.maximum(way[:, 2], -_DEEPEST)
        ways.append(way)
    return ways[0], ways[1]


KINDS: Mapping[str, Callable[[np.random.Generator, tuple[float, float]], Ways]] = {
    "jerk": jerk,
    "zigzag": zigzag,
    "sine": sine,
    "rim": rim,
}


def random_poses(
    kind: str,
    rng: np.random.Generator,
    instruments: tuple[Instrument, Instrument],
    size: tuple[float, float],
) -> FloatArray:
    """Return poses of both handles along random ways; in half of them jaws snap and shafts roll as well.

    Args:
        kind: one of `KINDS`.
        rng: where chance comes from.
        instruments: left, right.
        size: sides of the block [m].

    Returns:
        Shape (TICKS, 2, POSE).
    """
    ways = KINDS[kind](rng, size)
    jaws, rolls = (1.0, 1.0), (0.0, 0.0)
    if rng.random() < 0.5:
        snaps = np.repeat(rng.random((2, TICKS // 10)) < 0.5, 10, axis=1).astype(np.float64)
        turns = np.cumsum(rng.uniform(-0.01, 0.01, (2, TICKS)), axis=1)
        return poses_along(instruments, ways, jaws=(snaps[0], snaps[1]), rolls=(turns[0], turns[1]))
    return poses_along(instruments, ways, jaws=jaws, rolls=rolls)


def _starts(rng: np.random.Generator, size: tuple[float, float]) -> FloatArray:
    middle = rng.uniform([0.25 * size[0], 0.33 * size[1]], [0.75 * size[0], 0.67 * size[1]])
    places = middle + rng.uniform(-_CLOSE, _CLOSE, (2, 2))
    return np.column_stack([places, np.full(2, _OVER)])


def _jerked(rng: np.random.Generator, low: FloatArray, high: FloatArray, starts: FloatArray) -> Ways:
    ways = []
    for start in starts:
        place, speed, way = start.copy(), np.zeros(3), np.empty((TICKS, 3))
        for k in range(TICKS):
            if rng.random() < 0.05:
                speed = rng.uniform(-1, 1, 3) * rng.choice(_SPEEDS)
            place = place + DT * speed
            speed = np.where((place < low) | (place > high), -speed, speed)
            place = np.clip(place, low, high)
            way[k] = place
        ways.append(way)
    return ways[0], ways[1]
