"""Energy of a live scene, and the work of its instruments: what contact may not gain.

Stored are the waves' kinetic and elastic energy, a quadratic form of each mode's blocks; the near fields', p K p/2 of
each patch; and that of the surface drawn aside, give f^2/2. The work of a tip in a tick is the force held on it times
the way of its lowest point, and what turning it pushes in. Without damping, stored energy minus work never grows.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from trocar.contact.tips import underside_or_side
from trocar.model import FloatArray
from trocar.simulation import FORCE, RECORD, Scene, SceneState, advance, at_rest
from trocar.waves.membrane import WaveMembrane


def energy_forms(model: WaveMembrane, scene: Scene) -> FloatArray:
    """Return Q of every mode a scene moves: its energy is x Q x/2, x its blocks one after the other; (kept, 2r, 2r)."""
    waves = model.oscillators
    kept = scene.tick.kept
    amplitudes = waves.outputs[kept]
    rates = np.einsum("jkri,jrim->jkrm", amplitudes, waves.matrices[kept])
    rows = (*amplitudes.shape[:2], -1)
    mass, stiffness = model.matrices_of_motion
    area = model.size[0] * model.size[1] / 4
    return np.asarray(
        area * (_form(rates.reshape(rows), mass[kept]) + _form(amplitudes.reshape(rows), stiffness[kept])),
        dtype=np.float64,
    )


def _form(reading: FloatArray, matrix: FloatArray) -> FloatArray:
    return np.ascontiguousarray(np.swapaxes(reading, 1, 2) @ matrix @ reading)


def energies_along(scene: Scene, forms: FloatArray, poses: FloatArray) -> tuple[FloatArray, FloatArray, bool]:
    """Play a history from rest.

    Args:
        scene: parameters.
        forms: see `energy_forms`.
        poses: of both handles, shape (ticks, 2, POSE).

    Returns:
        Energy stored at the end of every tick and work done until then [J], each of shape (ticks,); and whether all
        numbers stayed finite.
    """
    stored, work = np.zeros(len(poses)), np.zeros(len(poses))
    records = np.zeros((2, RECORD))
    well = follow(scene, at_rest(scene), forms, poses, records, stored, work)
    return stored, work, bool(well)


@njit(cache=True, nogil=True)
def follow(
    scene: Scene,
    state: SceneState,
    forms: FloatArray,
    poses: FloatArray,
    records: FloatArray,
    stored: FloatArray,
    work: FloatArray,
) -> bool:  # pragma: no cover - compiled
    """Do what `energies_along` says; records is scratch, shape (2, RECORD)."""
    well, done = True, 0.0
    before, middles, spreads = np.zeros((2, 3)), np.zeros((2, 3)), np.zeros((2, 3, 3))
    for k in range(len(poses)):
        before[:], middles[:], spreads[:] = state.lowest, state.middles, state.spreads
        well = advance(scene, state, poses[k], records) and well
        for t in range(2):
            for i in range(3):
                done -= records[t, FORCE + i] * (state.lowest[t, i] - before[t, i])
            done += turning(scene, state, t, middles[t], spreads[t])
        stored[k], work[k] = stored_energy(scene, state, forms), done
    return well


@njit(cache=True, nogil=True)
def turning(
    scene: Scene, state: SceneState, t: int, middle: FloatArray, spread: FloatArray
) -> float:  # pragma: no cover - compiled
    """Return the work of a tip that turned in a tick [J]: what that alone pushed the points in.

    Args:
        scene: parameters.
        state: at the end of the tick.
        t: number of the instrument.
        middle: of the ellipsoid as it was before, shape (3,).
        spread: likewise, shape (3, 3).
    """
    pads, total = scene.tick.offsets.shape[1], 0.0
    if spread[2, 2] == 0.0:
        return total
    for i in range(pads * pads):
        force = state.forces[t * pads * pads + i]
        if force != 0.0:
            x = scene.tick.offsets[t, i // pads] + state.slip[t, 0]
            y = scene.tick.offsets[t, i % pads] + state.slip[t, 1]
            new = state.middles[t]
            total += force * (middle[2] + underside_or_side(spread, x - middle[0], y - middle[1]))
            total -= force * (new[2] + underside_or_side(state.spreads[t], x - new[0], y - new[1]))
    return total


@njit(cache=True, nogil=True)
def stored_energy(scene: Scene, state: SceneState, forms: FloatArray) -> float:  # pragma: no cover - compiled
    """Return what waves, near fields and the surface drawn aside hold at the end of a tick [J]."""
    tick = scene.tick
    order, lanes = tick.shape[0], state.tick.blocks.shape[1] // (2 * tick.shape[0])
    x = np.empty(2 * order)
    total = 0.0
    for j in range(len(tick.kept)):
        strip, lane = tick.strip[j], tick.lane[j]
        force = state.tick.force[tick.row[strip], tick.first[strip] + lane]
        for i in range(2 * order):
            x[i] = state.tick.blocks[strip, i * lanes + lane] + tick.gain[j, i // 2, i % 2] * force
        for i in range(2 * order):
            for k in range(2 * order):
                total += 0.5 * x[i] * forms[j, i, k] * x[k]
    points = scene.near.shape[1]
    for t in range(len(scene.near)):
        for i in range(points):
            one = state.forces[t * points + i]
            if one != 0.0:
                for k in range(points):
                    total += 0.5 * one * scene.near[t, i, k] * state.forces[t * points + k]
        total += 0.5 * scene.give[t] * (state.drag[t, 0] ** 2 + state.drag[t, 1] ** 2)
    return total
