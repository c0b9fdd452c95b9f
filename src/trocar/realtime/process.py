"""What runs in the servo's process: set-up in Python, then the compiled loop, then an exit code."""

from __future__ import annotations

import os
from dataclasses import dataclass
from multiprocessing.connection import Connection
from typing import Any

from numba import typeof as untyped_typeof

from trocar.realtime.guard import GuardLimits
from trocar.realtime.loop import Settings, make_work, serve
from trocar.realtime.physics import Physics, Pointer, compiled, with_own_cache
from trocar.realtime.privileges import claim, die_with_parent, ignore_interrupts
from trocar.realtime.shared import FieldShape, Shared, view
from trocar.realtime.tracking import Following

typeof: Any = untyped_typeof
EXIT_COULD_NOT_START = 10
EXIT_OF_LOOP = 20  # plus why the loop ended; 20 is as it should be


@dataclass(frozen=True, kw_only=True)
class Orders:
    """What the process is told.

    Attributes:
        physics: functions.
        scene: their parameters.
        state: where they begin.
        period: of a tick [ns].
        field_shape: layers, M, N.
        following: how poses are followed.
        limits: what a hand may feel.
        scheduled: whether to ask for a real-time class.
        parent: number of the parent.
        tied: whether to be killed with the thread that started this process; it must live as long as the parent.
    """

    physics: Physics
    scene: Any
    state: Any
    period: int
    field_shape: FieldShape
    following: Following
    limits: GuardLimits
    scheduled: bool
    parent: int
    tied: bool


def run(orders: Orders, block: Any, trouble: Connection) -> None:
    """Be the servo, and leave at once when it ends: nothing needs tidying, and the parent may be gone.

    Args:
        orders: what to do.
        block: memory shared with the parent.
        trouble: takes one sentence if the loop cannot be started.
    """
    ignore_interrupts()
    if orders.tied:
        die_with_parent()
    if os.getppid() != orders.parent:  # it ended before the line above took hold
        os._exit(EXIT_OF_LOOP + 1)
    try:
        call = _ready(orders, view(block, orders.field_shape))
    except Exception as error:  # noqa: BLE001 - whatever it is, the parent says it
        trouble.send(f"{type(error).__name__}: {error}")
        os._exit(EXIT_COULD_NOT_START)
    os._exit(EXIT_OF_LOOP + call())


def compiled_loop(orders: Orders, shared: Shared) -> tuple[Any, tuple[Any, ...]]:
    """Compile everything, or load it from numba's caches.

    Args:
        orders: what the loop is for.
        shared: memory it works on.

    Returns:
        The loop and its arguments.
    """
    scene, state = orders.scene, orders.state
    work = make_work(shared, orders.field_shape)
    kinds = tuple(typeof(value) for value in (scene, state, work.poses, work.records, work.amplitudes))
    scene_kind, state_kind, poses_kind, records_kind, field_kind = kinds
    functions = (
        Pointer(orders.physics.advance, (scene_kind, state_kind, poses_kind, records_kind)),
        Pointer(orders.physics.amplitudes, (scene_kind, state_kind, field_kind)),
        Pointer(orders.physics.come_to_rest, (scene_kind, state_kind)),
    )
    settings = Settings(period=orders.period, parent=orders.parent, allowed=0)
    arguments = (*functions, scene, state, shared, work, settings, orders.following, orders.limits)
    loop = with_own_cache(serve, orders.physics)
    compiled(loop, tuple(typeof(argument) for argument in arguments))
    return loop, arguments


def _ready(orders: Orders, shared: Shared) -> Any:
    """Return the loop, ready to be called."""
    shared.trail.rows[:] = 0.0  # every page of it is there before the first tick
    loop, arguments = compiled_loop(orders, shared)
    settings = arguments[7]._replace(allowed=claim(scheduled=orders.scheduled))
    return lambda: loop(*arguments[:7], settings, *arguments[8:])
