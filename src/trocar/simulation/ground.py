"""What a scene asks of the tissue under it: a flat block's waves, or a mesh's modes at the sites of its surface.

Both have calls of the same names; the compiler chooses by the type of the tick or of its state. The functions that
stand here are empty: they are for compiled code alone, and `_either` says what it takes for each.

On a mesh a patch lies in the tangent plane of the place under the tip, and the tip's lowest point is that along the
normal there.
"""

from __future__ import annotations

from inspect import signature
from math import sqrt
from types import FunctionType
from typing import Any

from numba import njit
from numba.extending import overload

from trocar.contact.tips import lowest
from trocar.model import FloatArray
from trocar.waves import patch, springs
from trocar.waves.mesh import mesh_patch
from trocar.waves.mesh.mesh_tick import MeshTick, MeshTickState
from trocar.waves.springs import Springs, SpringState
from trocar.waves.tick import FAR, Tick, TickState

AnyTick = Tick | MeshTick
AnyState = TickState | MeshTickState

_FEET = 4  # times the place under a tip is looked for; each takes what is left to its share of curvature times depth
_HIGH = 0.02  # [m] a tip higher above the surface than this is not looked at more closely
_BETWEEN = 1.5  # of two patches' widths, from which on they do not meet on a flat block


def go_on(tick: AnyTick, state: AnyState) -> None:
    """Advance by one tick under the forces held."""


def read_patches(tick: AnyTick, state: AnyState, sunk: FloatArray) -> None:
    """Write how deep the surface lies at every patch's points without the next forces [m], shape (tools, P P)."""


def push_each_other(tick: AnyTick, state: AnyState, one: int, other: int, out: FloatArray) -> None:
    """Write how far each point of a patch sinks within a tick per newton on each of another [m/N], (P P, P P)."""


def hold(tick: AnyTick, state: AnyState, forces: FloatArray) -> None:
    """Set the forces of every point into the surface that are held through this tick [N], shape (tools, P P)."""


def let_go(state: AnyState) -> None:
    """Hold no forces through this tick."""


def show(tick: AnyTick, state: AnyState, out: FloatArray) -> None:
    """Write what a picture is made of, shape (layers, M, N)."""


def feel_waves(springs: Springs, state: SpringState, tick: AnyState) -> None:
    """Read what nodules' springs would feel without the next forces; a mesh has its nodules in its elements."""


def hold_springs(springs: Springs, state: SpringState, tick: AnyState, forces: FloatArray) -> None:
    """Add the springs' forces to those held."""


def stand_under(
    tick: AnyTick, state: AnyState, centre: FloatArray, spread: FloatArray, low: FloatArray, frame: FloatArray
) -> bool:
    """Find the place under a tip.

    Args:
        tick: parameters.
        state: scratch in it is overwritten.
        centre: of the tip's ellipsoid [m], shape (3,).
        spread: S of `contact.tips` [m^2], shape (3, 3).
        low: overwritten with its lowest point along the surface's normal [m], shape (3,).
        frame: overwritten with the place, both tangents and the normal, shape (4, 3).

    Returns:
        Whether the surface is there and looks up.
    """
    raise NotImplementedError


def place_patch(tick: AnyTick, state: AnyState, tool: int, x: float, y: float, frame: FloatArray) -> bool:
    """Put a patch on the surface at x, y [m]; its axes are written to `frame`. Return whether the surface is there."""
    raise NotImplementedError


def is_there(tick: AnyTick, state: AnyState, tool: int, point: int, x: float, y: float) -> bool:
    """Return whether a point of the patch at x, y [m] lies on the surface."""
    raise NotImplementedError


def height_of(state: AnyState, tool: int, point: int) -> float:
    """Return how high the rest surface lies at a patch's point over the plane of the patch [m]."""
    raise NotImplementedError


def keeps_its_answer(tick: AnyTick, tool: int, x: float, y: float) -> bool:
    """Return whether a patch at x, y [m] pushes itself in as every other far from the sides does."""
    raise NotImplementedError


def meets_within_a_tick(tick: AnyTick, state: AnyState, low: FloatArray, own: FloatArray) -> bool:
    """Return whether what one patch does reaches the other within a tick.

    Args:
        tick: parameters.
        state: of the tissue.
        low: lowest points of both tips [m], shape (2, 3).
        own: how far the points of each patch push each other in [m/N], shape (2, P P, P P).
    """
    raise NotImplementedError


def _nothing_felt(
    springs: Springs, state: SpringState, tick: AnyState
) -> None:  # pragma: no cover - compiled
    pass


def _nothing_held(
    springs: Springs, state: SpringState, tick: AnyState, forces: FloatArray
) -> None:  # pragma: no cover - compiled
    pass


def _under_on_block(
    tick: Tick, state: TickState, centre: FloatArray, spread: FloatArray, low: FloatArray, frame: FloatArray
) -> bool:  # pragma: no cover - compiled
    lowest(centre, spread, low)
    _level(frame, low[0], low[1])
    return bool(0.0 < low[0] < tick.size[0] and 0.0 < low[1] < tick.size[1])


def _under_on_mesh(
    tick: MeshTick,
    state: MeshTickState,
    centre: FloatArray,
    spread: FloatArray,
    low: FloatArray,
    frame: FloatArray,
) -> bool:  # pragma: no cover - compiled
    lowest(centre, spread, low)
    x, y = low[0], low[1]
    normal = frame[3]
    for turn in range(_FEET + 1):
        if not mesh_patch.stand(tick, x, y, state.cubics[0], frame):
            lowest(centre, spread, low)
            _level(frame, low[0], low[1])
            return False
        if turn == _FEET:
            break
        reach = 0.0
        for i in range(3):
            low[i] = 0.0
            for k in range(3):
                low[i] += spread[i, k] * normal[k]
            reach += normal[i] * low[i]
        rise = 0.0
        for i in range(3):
            low[i] = centre[i] - low[i] / sqrt(reach)
            rise += normal[i] * (low[i] - frame[0, i])
        if rise > _HIGH:
            break
        x, y = low[0] - rise * normal[0], low[1] - rise * normal[1]
    return True


@njit(cache=True)
def _level(frame: FloatArray, x: float, y: float) -> None:  # pragma: no cover - compiled
    frame[:] = 0.0
    frame[0, 0], frame[0, 1] = x, y
    frame[1, 0] = frame[2, 1] = frame[3, 2] = 1.0


def _placed_on_block(
    tick: Tick, state: TickState, tool: int, x: float, y: float, frame: FloatArray
) -> bool:  # pragma: no cover - compiled
    patch.place_patch(tick, state, tool, x, y)
    return True


def _placed_on_mesh(
    tick: MeshTick, state: MeshTickState, tool: int, x: float, y: float, frame: FloatArray
) -> bool:  # pragma: no cover - compiled
    there = mesh_patch.place_patch(tick, state, tool, x, y)
    if there:
        frame[:] = state.frames[tool]
    return bool(there)


def _there_on_block(
    tick: Tick, state: TickState, tool: int, point: int, x: float, y: float
) -> bool:  # pragma: no cover - compiled
    each = tick.offsets.shape[1]
    dx, dy = tick.offsets[tool, point // each], tick.offsets[tool, point % each]
    return bool(0.0 < x + dx < tick.size[0] and 0.0 < y + dy < tick.size[1])


def _there_on_mesh(
    tick: MeshTick, state: MeshTickState, tool: int, point: int, x: float, y: float
) -> bool:  # pragma: no cover - compiled
    return bool(state.on[tool, point])


def _height_on_block(state: TickState, tool: int, point: int) -> float:  # pragma: no cover - compiled
    return 0.0


def _height_on_mesh(state: MeshTickState, tool: int, point: int) -> float:  # pragma: no cover - compiled
    return float(state.heights[tool, point])


def _never_keeps(tick: MeshTick, tool: int, x: float, y: float) -> bool:  # pragma: no cover - compiled
    return False


def _keeps_far_from_sides(tick: Tick, tool: int, x: float, y: float) -> bool:  # pragma: no cover - compiled
    # Farther away than where its mirror images in the sides matter.
    margin = 0.5 * tick.apart + tick.offsets[tool, -1] + 1e-3
    return bool(margin < x < tick.size[0] - margin and margin < y < tick.size[1] - margin)


def _meets_on_block(
    tick: Tick, state: TickState, low: FloatArray, own: FloatArray
) -> bool:  # pragma: no cover - compiled
    widths = tick.offsets[0, -1] + tick.offsets[1, -1]
    x, y = low[0, 0] - low[1, 0], low[0, 1] - low[1, 1]
    return bool(sqrt(x * x + y * y) < tick.apart + _BETWEEN * widths)


def _meets_on_mesh(
    tick: MeshTick, state: MeshTickState, low: FloatArray, own: FloatArray
) -> bool:  # pragma: no cover - compiled
    return bool(mesh_patch.between(tick, state, 0, 1) > FAR * min(own[0, 0, 0], own[1, 0, 0]))


def _either(call: Any, on_block: Any, on_mesh: Any) -> None:
    """Let compiled code call one function for flat blocks, and another for meshes; all three name arguments alike."""
    # The compiler compares whole signatures, so none may say what it takes.
    block, mesh = (FunctionType(one.__code__, one.__globals__, one.__name__) for one in (on_block, on_mesh))

    def chosen(*kinds: Any) -> FunctionType:
        named = {getattr(kind, "instance_class", None) for kind in kinds}
        return mesh if named & {MeshTick, MeshTickState} else block

    chosen.__signature__ = signature(block)  # type: ignore[attr-defined]
    overload(call)(chosen)


for _call, _on_block, _on_mesh in (
    (go_on, patch.go_on.py_func, mesh_patch.go_on.py_func),
    (read_patches, patch.read_patches.py_func, mesh_patch.read_patches.py_func),
    (push_each_other, patch.push_each_other.py_func, mesh_patch.push_each_other.py_func),
    (hold, patch.hold.py_func, mesh_patch.hold.py_func),
    (let_go, patch.let_go.py_func, mesh_patch.let_go.py_func),
    (show, patch.read_layers.py_func, mesh_patch.write_picture.py_func),
    (feel_waves, springs.feel_waves.py_func, _nothing_felt),
    (hold_springs, springs.hold_springs.py_func, _nothing_held),
    (stand_under, _under_on_block, _under_on_mesh),
    (place_patch, _placed_on_block, _placed_on_mesh),
    (is_there, _there_on_block, _there_on_mesh),
    (height_of, _height_on_block, _height_on_mesh),
    (keeps_its_answer, _keeps_far_from_sides, _never_keeps),
    (meets_within_a_tick, _meets_on_block, _meets_on_mesh),
):
    _either(_call, _on_block, _on_mesh)
