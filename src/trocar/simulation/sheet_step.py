"""One coupled tick of a sheet, compiled: handle poses to tips, snips, contact and grip, the lattice's waves, wrenches.

In this order, for both instruments at once:

1. The port's lever puts the tips; an instrument that is first seen below the sheet touches nothing until it has been
   above it. A jaw that closes takes hold of what its tip touches.
2. Blades that have been wide open, and close, cut what lies between them: every link that they cross, at once and
   whatever it pulls with. No toughness is reckoned, and the hand feels none.
3. The lattice goes on in small steps, tips with it from where they were to where they are; in each, nodes are kept
   below the tips (`sheet_contact`). The forces' mean over the tick comes to the hands.

The same poses give the same bits: nothing else goes in.
"""

from __future__ import annotations

from math import cos, isfinite, sqrt

from numba import njit

from trocar.contact.port import reach
from trocar.contact.tips import lowest, turn_body
from trocar.model import FloatArray
from trocar.simulation.hand import bring_to_hand
from trocar.simulation.sheet_contact import (
    HELD,
    TOUCHED,
    carry_nodes,
    place_at_rest,
    press_nodes,
    snip,
    take_hold,
)
from trocar.simulation.sheet_scene import SheetScene, SheetState
from trocar.simulation.step import (
    CLOSED,
    CUT,
    DEPTH,
    DIRECTION,
    DRAG,
    FORCE,
    GRIP,
    HANDLE,
    HANDLE_FORCE,
    JAW,
    MOMENT,
    OPEN,
    OPENED,
    OUTSIDE,
    PLACE,
    PRESENT,
    RECORD,
    RECORD_JAW,
    RECORD_ROLL,
    ROLL,
    TIP,
    TOUCH,
    TOUCH_HOLDING,
    TOUCH_PRESENT,
    TOUCH_TOUCHING,
    TWIST,
)
from trocar.waves.sheet.lattice import lag, move, pull, still

TOLD = (
    300  # ticks for which a snip stays in the record, or until the next: long enough to be seen as a mistake
)
_IN_HAND, _FREE, _JAW, _OPENED, _TOUCHES = range(5)
AT_LEAST = 1 / 255  # [1] of a link, where a cut is told
_ABOVE = 0.02  # [m] a tip higher above the rest surface than this is not looked at
_LEFT = 5  # column of snips: ticks for which it is still told


@njit(cache=True, nogil=True)
def advance_sheet(
    scene: SheetScene, state: SheetState, poses: FloatArray, records: FloatArray
) -> bool:  # pragma: no cover - compiled
    """Advance by one tick; arguments and what is returned as in `step.advance`.

    Args:
        scene: parameters.
        state: overwritten.
        poses: of both handles at the end of the tick, shape (2, POSE).
        records: overwritten; of both instruments, shape (2, RECORD).

    Returns:
        Whether all went well; if not, a number was not finite, and no force acts.
    """
    tools = len(poses)
    near, tip = state.vectors[0], state.vectors[3]
    for t in range(tools):
        near[t] = 1.0 if _put(scene, state, poses, records, t) else 0.0
    lattice = scene.lattice
    still(state.lattice)
    for left in range(lattice.steps - 1, -1, -1):
        lag(lattice, state.lattice)
        pull(lattice, state.lattice)
        for t in range(tools):
            if near[t] == 0.0:
                continue
            for i in range(3):
                state.centres[t, i] += state.ways[t, i]
                tip[i] = records[t, TIP + i] - left * state.ways[t, i]
            if state.counts[t, HELD] > 0:
                carry_nodes(scene, state, t, tip)
            else:
                press_nodes(scene, state, t, tip)
            if state.counts[t, TOUCHED] + state.counts[t, HELD] > 0:
                state.flags[t, _TOUCHES] += 1.0
        move(lattice, state.lattice)
    well = True
    for t in range(tools):
        _answer(scene, state, records, t)
        for i in range(RECORD):
            well = well and isfinite(records[t, i])
    for axis in range(3):
        total = 0.0
        for i in range(len(state.lattice.places[axis])):
            total += state.lattice.places[axis, i]
        well = well and isfinite(total)
    if not well:
        for t in range(tools):
            records[t, FORCE : HANDLE_FORCE + 3] = 0.0
            records[t, DRAG : DRAG + 2] = 0.0
            records[t, MOMENT : TWIST + 1] = 0.0
    return well


@njit(cache=True, nogil=True)
def sheet_planes(
    scene: SheetScene, state: SheetState, out: FloatArray
) -> None:  # pragma: no cover - compiled
    """Write u_z, u_x and u_y of every node [m], and of each of three of its links where it is cut; (6, ny, nx).

    The links are `lattice.AHEAD`'s first three, the sides of the triangles that are drawn; each has 0 as long as it
    holds, then how far along it the cut went, from `AT_LEAST` to 1.
    """
    n = scene.lattice.columns
    for j in range(out.shape[1]):
        for i in range(n):
            at = j * n + i
            out[0, j, i] = state.lattice.places[2, at]
            out[1, j, i] = state.lattice.places[0, at]
            out[2, j, i] = state.lattice.places[1, at]
            for way in range(3):
                cut = state.lattice.whole[way, at] == 0.0
                out[3 + way, j, i] = max(state.lattice.crossed[way, at], AT_LEAST) if cut else 0.0


@njit(cache=True, nogil=True)
def renew_sheet(scene: SheetScene, state: SheetState) -> None:  # pragma: no cover - compiled
    """Clip a new sheet into the frame; instruments that are below it touch nothing until they have been above."""
    n = scene.lattice.columns
    rows = len(scene.lattice.free) // n
    state.lattice.places[:] = 0.0
    state.lattice.speeds[:] = 0.0
    for j in range(rows):
        for i in range(n):
            at = j * n + i
            state.lattice.whole[0, at] = 1.0 if i < n - 1 else 0.0
            state.lattice.whole[1, at] = 1.0 if j < rows - 1 else 0.0
            state.lattice.whole[2, at] = 1.0 if i < n - 1 and j < rows - 1 else 0.0
            state.lattice.whole[3, at] = 1.0 if i > 0 and j < rows - 1 else 0.0
    state.counts[:] = 0
    state.snips[:] = 0.0
    state.flags[:, _FREE] = 0.0
    state.flags[:, _OPENED] = 0.0


@njit(cache=True)
def _put(
    scene: SheetScene, state: SheetState, poses: FloatArray, records: FloatArray, t: int
) -> bool:  # pragma: no cover - compiled
    """Place an instrument, let it take hold or cut; return whether it may touch."""
    flags, record = state.flags[t], records[t]
    handle, tip, direction, back = state.vectors[2], state.vectors[3], state.vectors[4], state.vectors[1]
    for i in range(3):
        handle[i] = poses[t, HANDLE + i]
    flags[_TOUCHES] = 0.0
    state.forces[t] = 0.0
    state.moments[t] = 0.0
    possible = poses[t, PRESENT] != 0.0 and reach(handle, scene.ports[t], scene.lengths[t], tip, direction)
    if not possible:
        record[:] = 0.0
        record[DIRECTION + 2] = -1.0
        state.counts[t] = 0
        state.snips[t] = 0.0
        flags[:] = 0.0
        return False
    record[RECORD_ROLL], record[RECORD_JAW] = poses[t, ROLL], poses[t, JAW]
    outside = 0.0
    for i in range(3):
        record[TIP + i], record[DIRECTION + i] = tip[i], direction[i]
        back[i] = -direction[i]
        outside += (scene.ports[t, i] - handle[i]) ** 2
    record[OUTSIDE] = sqrt(outside)
    # The tip's true lowest point first, then the larger body that presses, as high above it as the true one.
    middle, low = state.vectors[5], state.lowest[t]
    turn_body(scene.axes[t], scene.middles[t], tip, direction, poses[t, ROLL], middle, state.spread)
    lowest(middle, state.spread, low)
    size = scene.lattice.size
    on_sheet = 0.0 < low[0] < size[0] and 0.0 < low[1] < size[1]
    record[DEPTH] = max(-low[2], 0.0) if on_sheet else 0.0
    was_free = flags[_FREE] != 0.0
    if low[2] > 0.0:
        flags[_FREE] = 1.0
    elif not on_sheet or flags[_IN_HAND] == 0.0:
        flags[_FREE] = 0.0
    flags[_IN_HAND] = 1.0
    turn_body(
        scene.axes[t] + scene.wider,
        scene.middles[t],
        tip,
        direction,
        poses[t, ROLL],
        middle,
        state.spreads[t],
    )
    middle[2] += sqrt(state.spreads[t, 2, 2]) - (middle[2] - low[2])
    for i in range(3):
        state.ways[t, i] = (middle[i] - state.centres[t, i]) / scene.lattice.steps if was_free else 0.0
        if not was_free:
            state.centres[t, i] = middle[i]
    place_at_rest(scene.lattice, state.lattice.places, low[0], low[1], handle)
    record[PLACE], record[PLACE + 1] = handle[0], handle[1]
    _close(scene, state, poses[t], t, tip, back)
    near = bool(flags[_FREE] != 0.0 and on_sheet and low[2] <= _ABOVE)
    if not near:
        state.counts[t] = 0
        state.centres[t] = middle  # so far on as the small steps would have brought it
    return near


@njit(cache=True)
def _close(
    scene: SheetScene, state: SheetState, pose: FloatArray, t: int, tip: FloatArray, back: FloatArray
) -> None:  # pragma: no cover - compiled
    """Take hold or cut when a jaw closes; let go when it opens or what it holds is pulled out of it."""
    flags, jaw, cut = state.flags[t], pose[JAW], state.snips[t]
    if cut[_LEFT] > 0.0:
        cut[_LEFT] -= 1.0
        if cut[_LEFT] == 0.0:
            cut[:] = 0.0
    closes = jaw < CLOSED and flags[_JAW] >= CLOSED
    if state.counts[t, HELD] > 0:
        if jaw > OPEN:
            state.counts[t, HELD] = 0
    elif closes and scene.holds[t] != 0.0:
        take_hold(scene, state, t)
    if jaw > OPEN:
        flags[_OPENED] = 1.0
    if closes and flags[_OPENED] != 0.0 and scene.cuts[t] != 0.0:
        flags[_OPENED] = 0.0
        # Blades open along y of `contact.tips`, which stands up across the shaft where roll is 0.
        upright = sqrt(max(1.0 - back[2] ** 2, 0.0))
        if flags[_FREE] != 0.0 and snip(scene, state, t, tip, back, upright * cos(pose[ROLL])):
            cut[_LEFT] = TOLD
    flags[_JAW] = jaw


@njit(cache=True)
def _answer(
    scene: SheetScene, state: SheetState, records: FloatArray, t: int
) -> None:  # pragma: no cover - compiled
    """Bring the sheet's force to the tip and to the hand; a jaw that pulls too hard lets go."""
    flags, record = state.flags[t], records[t]
    if flags[_IN_HAND] == 0.0:
        return
    force, moment, direction, hand = state.forces[t], state.moments[t], state.vectors[4], state.vectors[5]
    held = state.counts[t, HELD] > 0
    for i in range(3):
        direction[i] = record[DIRECTION + i]
        record[FORCE + i] = force[i]
        record[MOMENT + i] = moment[i]
    record[TWIST] = bring_to_hand(force, moment, direction, record[OUTSIDE], scene.lengths[t], hand)
    for i in range(3):
        record[HANDLE_FORCE + i] = hand[i]
    record[DRAG], record[DRAG + 1] = -force[0], -force[1]
    record[TOUCH] = (
        TOUCH_PRESENT + (TOUCH_TOUCHING if flags[_TOUCHES] > 0.0 else 0) + (TOUCH_HOLDING if held else 0)
    )
    for i in range(5):
        record[CUT + i] = state.snips[t, i]
    record[OPENED] = flags[_OPENED]
    if held and force[0] ** 2 + force[1] ** 2 + force[2] ** 2 > GRIP**2:
        state.counts[t, HELD] = 0
