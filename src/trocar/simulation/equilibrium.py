"""The forces of both patches' points, within a tick: none penetrated, none pulled that does not hold.

A patch alone is one complementarity problem (`contact.normal`); far from the block's sides its compliance never
changes, so its factor is kept while the same points press. Near a side the mirror images count, near a nodule what it
holds, and on a mesh no two places are alike. Two patches that reach each other within a tick are solved in turns until
they agree.
"""

from __future__ import annotations

from numba import njit

from trocar.contact.normal import press
from trocar.model import FloatArray
from trocar.simulation.ground import keeps_its_answer, meets_within_a_tick, push_each_other
from trocar.simulation.scene import Scene, SceneState
from trocar.waves.springs import stiffen

_TURNS = 100  # of two patches that push each other in, until they agree; seen: 3 to 12
_AGREED = 1e-12  # of the deepest point


@njit(cache=True)
def press_patches(
    scene: Scene, state: SceneState, pressing: FloatArray
) -> bool:  # pragma: no cover - compiled
    """Find the points' forces: of each patch for itself, and in turns until they agree where patches meet."""
    tools = len(scene.near)
    points = scene.near.shape[1]
    for t in range(tools):
        if pressing[t] == 0.0:
            part = slice(t * points, (t + 1) * points)
            state.forces[part] = 0.0
            state.touching[part] = False
        elif not keeps_its_answer(scene.tick, t, state.lowest[t, 0], state.lowest[t, 1]):
            own = state.own[t]
            push_each_other(scene.tick, state.tick, t, t, own)
            for i in range(points):
                for k in range(points):
                    own[i, k] += scene.near[t, i, k]
            if state.springs.near[t]:
                stiffen(scene.springs, state.springs, t, t, own)
            state.order[t, -1] = 0
            state.inside[t] = False
        elif state.springs.near[t]:
            state.own[t] = scene.own[t]
            stiffen(scene.springs, state.springs, t, t, state.own[t])
            state.order[t, -1] = 0
            state.inside[t] = False
        elif not state.inside[t]:
            state.order[t, -1] = 0
            state.inside[t] = True
    by_springs = tools == 2 and (state.springs.near[0] or state.springs.near[1])
    meeting = (
        tools == 2
        and pressing[0] != 0.0
        and pressing[1] != 0.0
        and (by_springs or meets_within_a_tick(scene.tick, state.tick, state.lowest, state.own))
    )
    if not meeting:
        well = True
        for t in range(tools):
            well = (pressing[t] == 0.0 or _press_patch(scene, state, t, state.below)) and well
        return well
    push_each_other(scene.tick, state.tick, 0, 1, state.across)
    if by_springs:
        stiffen(scene.springs, state.springs, 0, 1, state.across)
    # Block Gauss-Seidel: W is positive definite, so it converges (Cottle, Pang and Stone 1992, The Linear
    # Complementarity Problem, section 5.3).
    rest = state.rest
    largest = 0.0
    for i in range(2 * points):
        largest = max(largest, abs(state.below[i]))
    for _ in range(_TURNS):
        change = 0.0
        for t in range(2):
            first, other = t * points, (1 - t) * points
            for i in range(points):
                pushed = 0.0
                for k in range(points):
                    force = state.forces[other + k]
                    if force != 0.0:
                        pushed += force * (state.across[i, k] if t == 0 else state.across[k, i])
                now = state.below[first + i] - pushed
                change = max(change, abs(now - rest[first + i]))
                rest[first + i] = now
            if not _press_patch(scene, state, t, rest):
                return False
        if change <= _AGREED * largest:
            return True
    return False


@njit(cache=True)
def _press_patch(
    scene: Scene, state: SceneState, t: int, below: FloatArray
) -> bool:  # pragma: no cover - compiled
    points = scene.near.shape[1]
    part = slice(t * points, (t + 1) * points)
    return bool(
        press(
            scene.own[t] if state.inside[t] else state.own[t],
            below[part],
            state.holding[part],
            state.touching[part],
            state.forces[part],
            state.factor[t],
            state.order[t],
            state.wrong,
        )
    )
