"""One coupled tick, compiled: handle poses to tips, contact, friction and grip, the tissue's waves, wrenches.

In this order, for both instruments at once:

1. The port's lever puts the tips (`contact.port`); a tip's ellipsoid has a lowest point (`contact.tips`), whose motion
   over the surface meets friction (`contact.friction`). The patch stands on the rest place of what lies under it: the
   surface there has moved by give times what drags it along, friction and the slopes under the tip.
2. The tissue goes on under the forces held so far, and is read at the patches (`waves.patch`); nodules hold on to it
   (`waves.springs`).
3. Points of the tips' undersides press where they would lie below the surface: force held over the tick, no
   penetration at its end (`contact.normal`), with the near field. Points that hold may pull.
4. Slopes push aside, friction keeps to the new normal force; the forces on the tips come to the hands by the lever.

An instrument that is first seen inside the tissue touches nothing until it has been outside: tissue is never thrown.
"""

from __future__ import annotations

from math import inf, isfinite, sqrt

from numba import njit

from trocar.contact.friction import drag
from trocar.contact.port import reach
from trocar.contact.tips import turn_body, underside, underside_or_side
from trocar.model import FloatArray
from trocar.simulation.equilibrium import press_patches
from trocar.simulation.frames import part_along, turn_in, turn_out
from trocar.simulation.ground import (
    feel_waves,
    go_on,
    height_of,
    hold,
    hold_springs,
    is_there,
    let_go,
    place_patch,
    read_patches,
    show,
    stand_under,
)
from trocar.simulation.hand import bring_to_hand
from trocar.simulation.scene import Scene, SceneState
from trocar.waves.springs import feel_points, lie_deeper

# Columns of an instrument's pose, shape (2, POSE): left, right.
PRESENT, HANDLE, ROLL, JAW, POSE = 0, 1, 4, 5, 6
# Columns of an instrument's record, shape (2, RECORD); see `advance`.
TIP, DIRECTION, RECORD_ROLL, RECORD_JAW = 0, 3, 6, 7
FORCE, HANDLE_FORCE, TOUCH, DEPTH, OUTSIDE = 8, 11, 14, 15, 16
DRAG, PLACE, MOMENT, TWIST = 17, 19, 21, 24
CUT = 25  # the last snip, for a while after it: links cut, rest places x, y of both ends (`sheet_step`)
OPENED = 30  # whether blades have been wide open since they last closed
RECORD = 31
TOUCH_PRESENT, TOUCH_TOUCHING, TOUCH_HOLDING = 1, 2, 4

CLOSED, OPEN = (
    0.2,
    0.35,
)  # of a jaw: it takes hold when it falls below the first, and lets go above the second
GRIP = 4.0  # [N] more than this pulls the tissue out of a jaw
_IN_HAND, _FREE, _GRIPPING, _JAW, _NORMAL = range(5)
_ABOVE = 0.02  # [m] a tip higher above the rest surface than this is not looked at
# Of what slopes push aside, the surface follows this share in a tick. All at once would ring on tissue that gives way
# by more than a tip's radius under the normal force laid on its side; so it may give way nineteen times that.
_FOLLOW = 0.1
_STILL = 1e-9  # [m] a slip below this is none
_AWAY = -1.0  # [m] depth of a point that lies beside the tip or the block


@njit(cache=True, nogil=True)
def advance(
    scene: Scene, state: SceneState, poses: FloatArray, records: FloatArray
) -> bool:  # pragma: no cover - compiled
    """Advance by one tick.

    Args:
        scene: parameters.
        state: overwritten.
        poses: of both handles at the end of the tick: in the hand (0 or 1), x, y, z [m], roll [rad], jaw (0 closed to
            1 open); shape (2, POSE).
        records: overwritten; of both instruments: tip [m], direction of the shaft, roll, jaw, force of the tissue on
            the tip [N], force on the hand [N], touch bits, depth of the tip below the rest surface [m], shaft outside
            the port [m], drag on the surface x, y [N], rest place under the tip x, y [m], moment on the tip about
            its end [N m], its part about the shaft [N m]; shape (2, RECORD).

    Returns:
        Whether all went well; if not, a number was not finite, and no force acts.
    """
    tools = len(poses)
    points = scene.near.shape[1]
    wanted, pressing = state.vectors[0], state.vectors[1]
    for t in range(tools):
        wanted[t] = 1.0 if _put(scene, state, poses, records, t) else 0.0
    go_on(scene.tick, state.tick)
    feel_waves(scene.springs, state.springs, state.tick)
    if wanted[0] + wanted[1] != 0.0:
        read_patches(scene.tick, state.tick, state.sunk)
        for t in range(tools):
            if wanted[t] != 0.0:
                lie_deeper(scene.springs, state.springs, t, state.sunk[t])
    pressed, well = False, True
    for t in range(tools):
        pressing[t] = 0.0
        for i in range(points):
            at = t * points + i
            below = state.depths[t, i] - state.sunk[t, i] if wanted[t] != 0.0 else _AWAY
            state.below[at] = below
            well = well and isfinite(below)
            if below > 0.0 or state.holding[at]:
                pressing[t] = 1.0
        pressed = pressed or pressing[t] != 0.0
    pressed = pressed and well
    if pressed:
        well = press_patches(scene, state, pressing)
    else:
        state.forces[:] = 0.0
        state.touching[:] = False
    for t in range(tools):
        _answer(scene, state, records, t, points)
    if well:
        for t in range(tools):
            for i in range(RECORD):
                well = well and isfinite(records[t, i])
    if not well:
        state.forces[:] = 0.0
        state.drag[:] = 0.0
        state.aside[:] = 0.0
        state.leaning[:] = 0.0
        for t in range(tools):
            records[t, FORCE : HANDLE_FORCE + 3] = 0.0
            records[t, DRAG : DRAG + 2] = 0.0
            records[t, MOMENT : TWIST + 1] = 0.0
    if pressed and well:
        hold(scene.tick, state.tick, state.forces.reshape(tools, points))
    else:
        let_go(state.tick)
    if well:
        hold_springs(scene.springs, state.springs, state.tick, state.forces)
    return well


@njit(cache=True, nogil=True)
def amplitudes(scene: Scene, state: SceneState, out: FloatArray) -> None:  # pragma: no cover - compiled
    """Write what a picture of the tissue is made of, shape (layers, M, N).

    Of a flat block u_z of every layer's upper face in sin(m pi x/a) sin(n pi y/b), m and n from 1 [m]; of a mesh what
    `simulation.organ_surface` reads.
    """
    show(scene.tick, state.tick, out)


@njit(cache=True, nogil=True)
def come_to_rest(scene: Scene, state: SceneState) -> None:  # pragma: no cover - compiled
    """Put the tissue back to rest; instruments that are in it touch nothing until they have been outside."""
    state.tick.blocks[:] = 0.0
    let_go(state.tick)
    state.forces[:] = 0.0
    state.drag[:] = 0.0
    state.aside[:] = 0.0
    state.leaning[:] = 0.0
    state.touching[:] = False
    state.holding[:] = False
    for t in range(len(state.flags)):
        state.flags[t, _FREE] = 0.0
        state.flags[t, _GRIPPING] = 0.0
        state.flags[t, _NORMAL] = 0.0


@njit(cache=True)
def _put(
    scene: Scene, state: SceneState, poses: FloatArray, records: FloatArray, t: int
) -> bool:  # pragma: no cover - compiled
    """Place an instrument and its patch; return whether it may touch."""
    flags, record = state.flags[t], records[t]
    points = scene.tick.offsets.shape[1]
    handle, tip, direction = state.vectors[2], state.vectors[3], state.vectors[4]
    for i in range(3):
        handle[i] = poses[t, HANDLE + i]
    possible = poses[t, PRESENT] != 0.0 and reach(handle, scene.ports[t], scene.lengths[t], tip, direction)
    if not possible:
        for i in range(RECORD):
            record[i] = 0.0
        record[DIRECTION + 2] = -1.0
        _let_go(state, t, points * points)
        flags[:] = 0.0
        return False
    record[RECORD_ROLL], record[RECORD_JAW] = poses[t, ROLL], poses[t, JAW]
    outside = 0.0
    for i in range(3):
        record[TIP + i], record[DIRECTION + i] = tip[i], direction[i]
        outside += (scene.ports[t, i] - handle[i]) ** 2
    record[OUTSIDE] = sqrt(outside)
    spread, frame = state.spreads[t], state.frames[t]
    turn_body(scene.axes[t], scene.middles[t], tip, direction, poses[t, ROLL], state.centre, spread)
    low, motion = state.lowest[t], state.motions[t]
    for i in range(3):
        motion[i] = -low[i]
    over = stand_under(scene.tick, state.tick, state.centre, spread, low, frame)
    for i in range(3):
        motion[i] += low[i]
    rise = part_along(frame[3], low[0] - frame[0, 0], low[1] - frame[0, 1], low[2] - frame[0, 2])
    record[DEPTH] = max(-rise, 0.0) if over else 0.0
    if rise > 0.0:
        flags[_FREE] = 1.0
    elif not over or flags[_IN_HAND] == 0.0:
        flags[_FREE] = 0.0
    flags[_IN_HAND] = 1.0
    _grip(scene, state, t, poses[t, JAW], points * points)
    if flags[_FREE] == 0.0 or not over or rise > _ABOVE:
        _let_go(state, t, points * points)
        return False
    _drag_along(
        scene,
        state,
        t,
        part_along(frame[1], motion[0], motion[1], motion[2]),
        part_along(frame[2], motion[0], motion[1], motion[2]),
    )
    gone_along, gone_across = scene.give[t] * state.drag[t, 0], scene.give[t] * state.drag[t, 1]
    x = frame[0, 0] - (gone_along * frame[1, 0] + gone_across * frame[2, 0])
    y = frame[0, 1] - (gone_along * frame[1, 1] + gone_across * frame[2, 1])
    record[PLACE], record[PLACE + 1] = x, y
    if not place_patch(scene.tick, state.tick, t, x, y, frame):
        _let_go(state, t, points * points)
        return False
    feel_points(scene.springs, state.springs, scene.tick.offsets, t, x, y)
    state.rises[t] = rise
    turn_in(frame, state.centre, low, spread, state.middles[t])
    middle = state.middles[t]
    for i in range(points):
        for k in range(points):
            at = i * points + k
            dx, dy = scene.tick.offsets[t, i], scene.tick.offsets[t, k]
            # From the ellipsoid's middle: its lowest point stands over the patch's centre.
            height, slope_x, slope_y = underside(spread, dx - middle[0], dy - middle[1])
            inside = is_there(scene.tick, state.tick, t, at, x, y)
            rest = height_of(state.tick, t, at)
            state.depths[t, at] = rest - (rise + middle[2] + height) if inside and height < inf else _AWAY
            if state.depths[t, at] == _AWAY:
                state.holding[t * points * points + at] = False
            state.slopes[t, at, 0], state.slopes[t, at, 1] = slope_x, slope_y
    return True


@njit(cache=True)
def _drag_along(
    scene: Scene, state: SceneState, t: int, motion_x: float, motion_y: float
) -> None:  # pragma: no cover - compiled
    """Move the surface along with a tip, as far as friction can beside what the slopes push aside; note the slip."""
    flags, along, leaning, slip = state.flags[t], state.drag[t], state.leaning[t], state.slip[t]
    before_x, before_y = along[0], along[1]
    limit = inf if flags[_GRIPPING] != 0.0 else scene.friction * flags[_NORMAL]
    for i in range(2):
        leaning[i] += _FOLLOW * (state.aside[t, i] - leaning[i])
        along[i] -= leaning[i]
    drag(along, motion_x, motion_y, scene.give[t], 1.0, limit)
    for i in range(2):
        along[i] += leaning[i]
    slip[0] = motion_x - scene.give[t] * (along[0] - before_x)
    slip[1] = motion_y - scene.give[t] * (along[1] - before_y)
    way = motion_x**2 + motion_y**2
    share = (slip[0] * motion_x + slip[1] * motion_y) / way if way > _STILL**2 else 0.0
    state.sliding[t] = min(max(share, 0.0), 1.0)


@njit(cache=True)
def _push_aside(scene: Scene, state: SceneState, t: int, points: int) -> None:  # pragma: no cover - compiled
    """Find what the slopes under a tip push aside, so that its work over the slip is what the points are pushed in.

    Slopes at the tick's end do too little: a point that presses now lay less deep under the tip before. The share
    along the slip is taken from the depths themselves (a discrete gradient: Gonzalez 1996, J Nonlinear Sci 6:449).
    """
    aside, slip, middle, spread = state.aside[t], state.slip[t], state.middles[t], state.spreads[t]
    pads = scene.tick.offsets.shape[1]
    aside[0] = aside[1] = 0.0
    way = slip[0] ** 2 + slip[1] ** 2
    pushed = 0.0
    for i in range(points):
        force = state.forces[t * points + i]
        if force == 0.0:
            continue
        aside[0] += force * state.slopes[t, i, 0]
        aside[1] += force * state.slopes[t, i, 1]
        if way > _STILL**2:
            dx, dy = scene.tick.offsets[t, i // pads] - middle[0], scene.tick.offsets[t, i % pads] - middle[1]
            now = height_of(state.tick, t, i) - state.depths[t, i] - state.rises[t] - middle[2]
            pushed += force * (underside_or_side(spread, dx + slip[0], dy + slip[1]) - now)
    if way > _STILL**2:
        share = (pushed - aside[0] * slip[0] - aside[1] * slip[1]) / way
        aside[0] += share * slip[0]
        aside[1] += share * slip[1]


@njit(cache=True)
def _let_go(state: SceneState, t: int, points: int) -> None:  # pragma: no cover - compiled
    state.flags[t, _GRIPPING] = 0.0
    state.flags[t, _NORMAL] = 0.0
    state.drag[t, 0] = state.drag[t, 1] = state.aside[t, 0] = state.aside[t, 1] = 0.0
    state.leaning[t, 0] = state.leaning[t, 1] = 0.0
    for i in range(t * points, (t + 1) * points):
        state.holding[i] = False
        state.touching[i] = False
        state.forces[i] = 0.0


@njit(cache=True)
def _grip(
    scene: Scene, state: SceneState, t: int, jaw: float, points: int
) -> None:  # pragma: no cover - compiled
    """Take hold of what the tip touches when its jaw closes; let go when it opens or the tissue is pulled out of it."""
    flags = state.flags[t]
    if flags[_GRIPPING] != 0.0:
        pull = sqrt(flags[_NORMAL] ** 2 + state.drag[t, 0] ** 2 + state.drag[t, 1] ** 2)
        if jaw > OPEN or pull > GRIP:
            flags[_GRIPPING] = 0.0
            for i in range(t * points, (t + 1) * points):
                state.holding[i] = False
    elif scene.holds[t] != 0.0 and jaw < CLOSED and flags[_JAW] >= CLOSED:
        for i in range(t * points, (t + 1) * points):
            state.holding[i] = state.touching[i]
            if state.touching[i]:
                flags[_GRIPPING] = 1.0
    flags[_JAW] = jaw


@njit(cache=True)
def _answer(
    scene: Scene, state: SceneState, records: FloatArray, t: int, points: int
) -> None:  # pragma: no cover - compiled
    """Bring the surface's forces to the tip and to the hand."""
    flags, record = state.flags[t], records[t]
    if flags[_IN_HAND] == 0.0:
        return
    normal = 0.0
    pads = scene.tick.offsets.shape[1]
    arm_x = arm_y = 0.0  # of the normal force about the lowest point [N m]
    touched = False
    for i in range(points):
        force = state.forces[t * points + i]
        normal += force
        arm_x += force * scene.tick.offsets[t, i // pads]
        arm_y += force * scene.tick.offsets[t, i % pads]
        touched = touched or force != 0.0
    flags[_NORMAL] = normal
    held = flags[_GRIPPING] != 0.0
    _push_aside(scene, state, t, points)
    along, aside, leaning = state.drag[t], state.aside[t], state.leaning[t]
    if not touched:  # what was drawn along springs back, unfelt
        for i in range(2):
            along[i] = leaning[i] = 0.0
    rubbing = sqrt((along[0] - leaning[0]) ** 2 + (along[1] - leaning[1]) ** 2)
    most = inf if held else scene.friction * max(normal, 0.0)
    if rubbing > most:
        for i in range(2):
            along[i] = leaning[i] + (along[i] - leaning[i]) * most / rubbing
    force, hand, direction = state.vectors[2], state.vectors[3], state.vectors[4]
    # The spring along the surface, and what slopes push aside as far as the tip slides: one that sticks works on the
    # spring alone.
    for i in range(2):
        force[i] = -along[i] - state.sliding[t] * (aside[i] - leaning[i])
    force[2] = normal
    frame = state.frames[t]
    turn_out(frame, force)
    # Moment about the tip's end: the resultant acts at the lowest point, the normal force a little beside it.
    rx = state.lowest[t, 0] - record[TIP]
    ry = state.lowest[t, 1] - record[TIP + 1]
    rz = state.lowest[t, 2] - record[TIP + 2]
    moment = state.vectors[5]
    moment[0], moment[1], moment[2] = arm_y, -arm_x, 0.0
    turn_out(frame, moment)
    moment[0] += ry * force[2] - rz * force[1]
    moment[1] += rz * force[0] - rx * force[2]
    moment[2] += rx * force[1] - ry * force[0]
    for i in range(3):
        direction[i] = record[DIRECTION + i]
        record[FORCE + i] = force[i]
        record[MOMENT + i] = moment[i]
    record[TWIST] = bring_to_hand(force, moment, direction, record[OUTSIDE], scene.lengths[t], hand)
    for i in range(3):
        record[HANDLE_FORCE + i] = hand[i]
    record[DRAG] = along[0] * frame[1, 0] + along[1] * frame[2, 0]
    record[DRAG + 1] = along[0] * frame[1, 1] + along[1] * frame[2, 1]
    touch = TOUCH_PRESENT + (TOUCH_TOUCHING if touched else 0) + (TOUCH_HOLDING if held else 0)
    record[TOUCH] = touch
