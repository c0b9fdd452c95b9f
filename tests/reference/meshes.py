"""Meshes of whole blocks for CalculiX, made here and not by the mesh generator under test."""

from __future__ import annotations

from math import pi, sqrt

import numpy as np

from reference.calculix import LOCAL_NODES


def extruded(quads: np.ndarray, places: np.ndarray, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Extrude 8-node quadrilaterals to 20-node bricks.

    Args:
        quads: numbers of the nodes, shape (m, 8): 4 corners anticlockwise, then the middles of the edges
            after them.
        places: of these nodes [m], shape (n, 2).
        z: heights of the element faces [m], ascending.

    Returns:
        Nodes [m], shape (n, 3), and elements, shape (m * (len(z) - 1), 20), slab by slab from below.
    """
    levels = np.sort(np.concatenate([z, 0.5 * (z[1:] + z[:-1])]))
    flat = len(places)
    elements = []
    for slab in range(len(z) - 1):
        low, middle, high = (quads + (2 * slab + k) * flat for k in range(3))
        elements.append(np.hstack([low[:, :4], high[:, :4], low[:, 4:], high[:, 4:], middle[:, :4]]))
    nodes = np.hstack([np.tile(places, (len(levels), 1)), np.repeat(levels, flat)[:, None]])
    used, compact = np.unique(np.concatenate(elements), return_inverse=True)
    return nodes[used], compact.reshape(-1, 20)


def uniform(
    size: tuple[float, float], counts: tuple[int, int], z: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return nodes and elements of a block cut evenly along x and y."""
    x, y = (np.linspace(0.0, side, 2 * count + 1) for side, count in zip(size, counts, strict=True))
    places = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
    ring = [0, 1, 2, 3, 8, 9, 10, 11]  # the lower face of a brick
    quads = [
        [(2 * i + p) * len(y) + 2 * j + q for p, q, _ in LOCAL_NODES[ring]]
        for i in range(counts[0])
        for j in range(counts[1])
    ]
    return extruded(np.array(quads), places, z)


def around_disc(
    size: tuple[float, float], radius: float, z: np.ndarray, *, sectors: int, rings: int, outside: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return nodes, elements and which columns lie within a disc in the middle, whose rim the elements
    follow.

    Four-sided patches: a square core of sectors/4 elements a side, rings up to the rim, and rings from the
    rim to the sides of the block, growing outwards.
    """
    centre = np.array(size) / 2
    side = sectors // 4
    quads: list[list[tuple[float, float]]] = []
    inner: list[bool] = []

    def add(at: object, rows: int, columns: int, *, in_disc: bool) -> None:
        ring = [0, 1, 2, 3, 8, 9, 10, 11]
        for i in range(rows):
            for j in range(columns):
                quads.append(
                    [
                        at((2 * i + p) / (2 * rows), (2 * j + q) / (2 * columns))
                        for p, q, _ in LOCAL_NODES[ring]
                    ]
                )
                inner.append(in_disc)

    core = 0.5 * radius
    add(lambda s, t: (core * (2 * s - 1), core * (2 * t - 1)), side, side, in_disc=True)
    for quarter in range(4):
        turn = np.array([[0, -1], [1, 0]])
        rotation = np.linalg.matrix_power(turn, quarter)

        def blend(s: float, t: float, *, outer: bool, rotation: np.ndarray = rotation) -> tuple[float, float]:
            angle = pi / 4 * (2 * t - 1)
            rim = radius * np.array([np.cos(angle), np.sin(angle)])
            square = np.array([1.0, 2 * t - 1])
            if outer:
                half = abs(rotation) @ np.array(size) / 2
                s = s * (0.25 + 0.75 * s)  # elements grow outwards
                point = (1 - s) * rim + s * half * square
            else:
                point = (1 - s) * core * square + s * rim
            return tuple(rotation @ point)

        add(lambda s, t, b=blend: b(s, t, outer=False), rings, side, in_disc=True)
        add(lambda s, t, b=blend: b(s, t, outer=True), outside, side, in_disc=False)
    places = np.array(quads).reshape(-1, 2) + centre
    _, first, number = np.unique(
        np.round(places / (1e-9 * sqrt(size[0] * size[1]))), axis=0, return_index=True, return_inverse=True
    )
    columns = number.reshape(-1, 8)
    nodes, elements = extruded(columns, places[first], z)
    return nodes, elements, np.array(inner)
