"""Creep, relaxation and hysteresis: what a tissue that remembers does under a tool, for any model.

One dead, uniform press. What is watched is the mean deflection of its footprint, which is what its force works on.

    creep        the force jumps to its value and is held: the deflection grows
    relaxation   the mean deflection jumps to its value and is held: the force falls. The traction stays uniform, so the
                 footprint does not stay flat, as under a rigid tip: the force is found by linearity at every step's end
    hysteresis   the force goes up and down at one rate: the loop's area is the energy lost in it

Made for models without inertia (`massless=True`), which answer a jump at once; one with inertia rings after it. Times
grow by doubling the step, so that few step lengths serve seconds as well as minutes.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from trocar.errors import InputError
from trocar.model import FloatArray, Press
from trocar.study.models import AnyModel

_JUMP = 1e-6  # length of a jump, in first steps
_STEPS_A_LENGTH = 8  # of one length, before it is doubled
_RINGS, _SPOKES = 6, 16  # of the points over the footprint: its mean is exact for polynomials of degree 11
_STEPS_A_RAMP = 100


@dataclass(frozen=True)
class Curve:
    """Force and deflection against time.

    Attributes:
        time: [s], shape (n,).
        force: along the tool's axis [N], shape (n,).
        deflection: mean over the footprint [m], shape (n,).
    """

    time: FloatArray
    force: FloatArray
    deflection: FloatArray

    @property
    def compliance(self) -> FloatArray:
        """Deflection over force [m/N], shape (n,)."""
        return np.asarray(self.deflection / self.force, dtype=np.float64)


@dataclass(frozen=True)
class Loop:
    """One loading and unloading.

    Attributes:
        curve: from rest, up to the peak and down to no force.
        given: work of the tool on the way up [J].
        lost: area of the loop [J]: what was not given back by the time the force is gone.
    """

    curve: Curve
    given: float
    lost: float

    @property
    def share_lost(self) -> float:
        """Energy lost over energy given [1]."""
        return self.lost / self.given


def creep(model: AnyModel, press: Press, *, first: float, last: float) -> Curve:
    """Hold a force.

    Args:
        model: a tissue without inertia.
        press: with the force that is held.
        first: length of the first steps [s], such as a fifth of the shortest relaxation time.
        last: time reached, at least [s].

    Returns:
        The first row is the instant after the jump.
    """
    watch = _mean_deflection(model, press)
    held = (press,)
    state = model.step(model.init(), (press.with_force(0.0),), held, _JUMP * first)
    depths, lengths = [watch(state)], _lengths(first, last)
    for dt in lengths:
        state = model.step(state, held, held, dt)
        depths.append(watch(state))
    time = np.append(0.0, np.cumsum(lengths))
    return Curve(time, np.full(len(time), press.force), np.array(depths))


def relaxation(model: AnyModel, press: Press, depth: float, *, first: float, last: float) -> Curve:
    """Hold a mean deflection; arguments as in `creep`, the press's own force does not matter.

    Args:
        model: a linear tissue without inertia.
        press: where.
        depth: held [m].
        first: length of the first steps [s].
        last: time reached, at least [s].
    """
    watch = _mean_deflection(model, press)
    free = (press.with_force(0.0),)
    gains: dict[float, float] = {}
    state, force, forces = model.init(), 0.0, []
    steps = [_JUMP * first, *_lengths(first, last)]
    for dt in steps:
        if dt not in gains:
            gains[dt] = watch(model.step(model.init(), free, (press.with_force(1.0),), dt))
        start = (press.with_force(force),)
        force = (depth - watch(model.step(state, start, free, dt))) / gains[dt]
        state = model.step(state, start, (press.with_force(force),), dt)
        forces.append(force)
    time = np.append(0.0, np.cumsum(steps[1:]))
    return Curve(time, np.array(forces), np.full(len(time), depth))


def hysteresis(model: AnyModel, press: Press, *, rate: float) -> Loop:
    """Press and let go at one rate.

    Args:
        model: a tissue without inertia.
        press: with the peak force.
        rate: of the force, up and down [N/s].

    Raises:
        InputError: the rate is not above 0.
    """
    if not rate > 0:
        raise InputError("hysteresis: rate", "a number above 0 [N/s]", rate)
    watch = _mean_deflection(model, press)
    ramp = np.linspace(0.0, press.force, _STEPS_A_RAMP + 1)
    forces = np.concatenate([ramp, ramp[-2::-1]])
    dt = press.force / rate / _STEPS_A_RAMP
    state, depths = model.init(), [0.0]
    for start, end in itertools.pairwise(forces):
        state = model.step(state, (press.with_force(start),), (press.with_force(end),), dt)
        depths.append(watch(state))
    curve = Curve(dt * np.arange(len(forces), dtype=np.float64), forces, np.array(depths))
    work = 0.5 * (forces[1:] + forces[:-1]) * np.diff(curve.deflection)
    return Loop(curve, given=float(work[:_STEPS_A_RAMP].sum()), lost=float(work.sum()))


def _lengths(first: float, last: float) -> list[float]:
    """Return steps that reach a time, their length doubled after every few."""
    if not 0 < first <= last:
        raise InputError("protocol: first", "a time above 0, up to the last [s]", first)
    lengths: list[float] = []
    length = first
    while sum(lengths) < last * (1 - 1e-9):
        lengths += [length] * _STEPS_A_LENGTH
        length *= 2
    return lengths


def _mean_deflection(model: AnyModel, press: Press) -> Callable[[object], float]:
    """Return what reads the footprint's mean deflection [m] of a state."""
    nodes, weights = np.polynomial.legendre.leggauss(_RINGS)
    radii = np.sqrt(0.5 * (nodes + 1))  # even in area
    angles = 2 * np.pi * (np.arange(_SPOKES) + 0.5) / _SPOKES
    along, across = press.semi_axes
    u, v = (along * np.outer(radii, np.cos(angles)), across * np.outer(radii, np.sin(angles)))
    cos, sin = np.cos(press.azimuth), np.sin(press.azimuth)
    x, y = press.x + cos * u - sin * v, press.y + sin * u + cos * v
    points = np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1)
    share = np.repeat(0.5 * weights / _SPOKES, _SPOKES)
    return lambda state: -float(share @ model.displacement(state, points)[:, 2])
