"""A layered block as a mesh of hexahedra between grid lines, finer where tools are."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from trocar.errors import InputError
from trocar.model import FloatArray, Load, Support
from trocar.tissues.tissue import Tissue
from trocar.waves.mesh.solid_mesh import Held, IntArray, SolidMesh

_SAME = 1e-9  # of a side
_PER_RADIUS = 2.0  # elements along a tool's radius
_GROWTH = 0.5  # of an element's length per distance from the tool
_AT_SIDE = 0.2  # length of an element at a clamped side, in radii: tractions there grow without bound
_TOP = 0.5  # height of an element at the top face, in radii
_DEEPENING = 0.6  # of an element's height per depth


def block_mesh(
    tissue: Tissue, lines: Sequence[FloatArray], *, support: Support | str = Support.BASE
) -> SolidMesh:
    """Return a block of layers between grid lines.

    Args:
        tissue: the layers; each one's lower face must be a line.
        lines: ascending places along x and y from 0, and along z up to 0 [m].
        support: how it is held.

    Raises:
        InputError: a layer's face is no line, or the support is unknown.
    """
    x, y, z = (np.asarray(line, dtype=np.float64) for line in lines)
    held_how = Support(support)
    nodes = np.arange(len(x) * len(y) * len(z)).reshape(len(x), len(y), len(z))
    corners = np.stack(np.meshgrid(x, y, z, indexing="ij"), axis=-1).reshape(-1, 3)
    low, high = slice(None, -1), slice(1, None)
    ring = ((low, low), (high, low), (high, high), (low, high))
    cells = np.stack([nodes[i, j, k].ravel() for k in (low, high) for i, j in ring], axis=1)
    edges = -np.cumsum([0.0, *(layer.thickness for layer in tissue.layers)])
    upper = [_line(z, face, tissue) for face in edges]
    middle = 0.5 * (z[1:] + z[:-1])
    slab = np.searchsorted(-edges, -middle) - 1
    return SolidMesh(
        corners=corners,
        cells=cells.astype(np.int64),
        region=np.tile(slab, (len(x) - 1) * (len(y) - 1)).astype(np.int64),
        materials=tissue.layers,
        held=_held(nodes, held_how),
        surfaces={
            layer.name: _quads(nodes[:, :, line])
            for layer, line in zip(tissue.layers, upper[:-1], strict=True)
        },
        support=held_how,
    )


def lines_around(
    tissue: Tissue,
    size: tuple[float, float],
    around: Load,
    *,
    support: Support | str = Support.BASE,
    coarser: float = 1.0,
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return grid lines for `block_mesh` that are close where tools press, at clamped sides and at the layers' faces.

    Args:
        tissue: the layers.
        size: sides of the block [m].
        around: presses whose footprints are resolved; at least one.
        support: how the block is held.
        coarser: what every element's length is multiplied by [1].
    """
    radius = min(press.radius for press in around)
    at_side = _AT_SIDE * radius if Support(support).sides_clamped else max(size)

    def spacing(side: float, axis: int) -> Callable[[float], float]:
        def at(place: float) -> float:
            near = [
                press.radius / _PER_RADIUS
                + _GROWTH * max(abs(place - (press.x, press.y)[axis]) - press.radius, 0.0)
                for press in around
            ]
            return coarser * min(*near, at_side + _GROWTH * min(place, side - place))

        return at

    z, upper = [np.zeros(1)], 0.0
    for layer in tissue.layers:
        lower = upper - layer.thickness
        through = _graded(lower, upper, lambda place: coarser * (_TOP * radius - _DEEPENING * place))
        z.append(through[::-1][1:])
        upper = lower
    across = [_graded(0.0, side, spacing(side, axis)) for axis, side in enumerate(size)]
    return across[0], across[1], np.concatenate(z)[::-1].copy()


def _graded(start: float, stop: float, spacing: Callable[[float], float]) -> FloatArray:
    """Return lines about `spacing` apart: images of even places of the integral of its inverse."""
    places = np.linspace(start, stop, 1001)
    density = 1.0 / np.array([spacing(place) for place in places])
    travelled = np.concatenate([[0.0], np.cumsum(0.5 * (density[1:] + density[:-1]) * np.diff(places))])
    count = max(1, int(np.ceil(travelled[-1] - 1e-9)))
    lines = np.interp(np.linspace(0.0, travelled[-1], count + 1), travelled, places)
    lines[0], lines[-1] = start, stop
    return np.asarray(lines)


def _line(z: FloatArray, face: float, tissue: Tissue) -> int:
    nearest = int(np.argmin(np.abs(z - face)))
    if abs(z[nearest] - face) > _SAME * tissue.thickness:
        raise InputError("block mesh: lines along z", f"one at {face:g} m, a layer's face", float(z[nearest]))
    return nearest


def _held(nodes: np.ndarray, support: Support) -> tuple[Held, ...]:
    found = []
    if support.base_held:
        found.append(Held(faces=_quads(nodes[:, :, 0])))
    for axis in (0, 1):
        along = tuple(support.sides_clamped or component != axis for component in range(3))
        faces = np.concatenate([_quads(np.take(nodes, end, axis=axis)) for end in (0, -1)])
        found.append(Held(faces=faces, along=(along[0], along[1], along[2])))
    return tuple(found)


def _quads(sheet: np.ndarray) -> IntArray:
    ring = (sheet[:-1, :-1], sheet[1:, :-1], sheet[1:, 1:], sheet[:-1, 1:])
    return np.stack([corner.ravel() for corner in ring], axis=1).astype(np.int64)
