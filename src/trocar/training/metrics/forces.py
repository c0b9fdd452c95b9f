"""Metrics of what the tips did to the tissue: forces, the least stress they can have made, and their work.

The stress is bounded from below. The part of the tissue that a tip touches, seen along the force, lies within the
tip's shadow, and no shadow of an ellipsoid is larger than its largest plane section A; so the mean stress in the
direction of the force is at least |F|/A, and its peak is higher still (by half under a sphere: Hertz 1882).

The work of a tip in a tick is that of the force held on it,

    -(F(i) (r(i) - r(i-1)) + M(i) theta(i)),   theta(i) = d(i-1) x d(i) + (roll(i) - roll(i-1)) d(i),

r its end, M the moment about it, d the shaft's direction: exact but for the square of a tick's turn. Contact is passive
(`docs/explanation/contact.md`), so the tissue stores no more than the work since neither tip touched and what still
rang from before.
"""

from __future__ import annotations

import numpy as np

from trocar.model import FloatArray
from trocar.simulation import DIRECTION, FORCE, MOMENT, RECORD_ROLL, TIP
from trocar.training.metrics.attempt import Attempt
from trocar.training.metrics.motion import time_above

TOUCHING = 1e-3  # [N] less is no touch, for the root mean square


def peak_force(attempt: Attempt) -> float:
    """Return the largest force on either tip [N]."""
    return float(attempt.forces.max())


def rms_force(attempt: Attempt) -> float:
    """Return the root mean square of a tip's force while it touches [N]; 0 where none ever does."""
    forces = attempt.forces
    touching = forces[forces > TOUCHING]
    return float(np.sqrt(np.mean(touching**2))) if len(touching) else 0.0


def impulse(attempt: Attempt) -> float:
    """Return the time integral of the force on both tips [N s]."""
    return float(np.trapezoid(attempt.forces.sum(axis=1), attempt.times))


def time_over_limit(attempt: Attempt) -> float:
    """Return how long either tip pressed or pulled more than the task allows [s]."""
    return time_above(attempt.times, attempt.forces.max(axis=1), attempt.force_limit)


def peak_stress_ratio(attempt: Attempt) -> float:
    """Return the least that the largest contact stress can have been, over the weakest layer's tensile strength [1].

    It is nan where no layer states a strength.
    """
    return float((attempt.forces / attempt.sections).max()) / attempt.strength


def work_on_tissue(attempt: Attempt) -> float:
    """Return the most that both tips had worked on the tissue since neither touched it [J]; 0 without a touch."""
    touched = np.asarray(attempt.touching.any(axis=1))
    done = np.cumsum(np.where(touched, work(attempt).sum(axis=1), 0.0))
    begins = touched & ~np.concatenate([[False], touched[:-1]])
    before = np.concatenate([[0.0], done[:-1]])
    since = np.maximum.accumulate(np.where(begins, np.arange(len(done)), 0))
    return max(float((done - before[since])[touched].max(initial=0.0)), 0.0)


def work(attempt: Attempt) -> FloatArray:
    """Return what each tip put into the tissue in every tick, none in one before which it was not there [J], (n, 2)."""
    records = attempt.records
    r, d, roll = (
        records[..., TIP : TIP + 3],
        records[..., DIRECTION : DIRECTION + 3],
        records[..., RECORD_ROLL],
    )
    turn = np.cross(d[:-1], d[1:]) + np.diff(roll, axis=0)[..., None] * d[1:]
    force, moment = records[1:, :, FORCE : FORCE + 3], records[1:, :, MOMENT : MOMENT + 3]
    into = -(force * np.diff(r, axis=0) + moment * turn).sum(axis=2)
    there = attempt.present[1:] & attempt.present[:-1]
    return np.concatenate([np.zeros((1, 2)), np.where(there, into, 0.0)])
