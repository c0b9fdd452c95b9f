"""Faces on the outside of a solid: which there are, where they look, and which to hold or touch."""

from __future__ import annotations

from math import cos, pi

import numpy as np

from trocar.model import FloatArray
from trocar.waves.mesh.solid_mesh import FACES, IntArray


def outer_faces(cells: IntArray) -> tuple[IntArray, IntArray]:
    """Return the faces that one element alone has, shape (k, 3) or (k, 4), and the element, shape (k,)."""
    kinds = FACES[cells.shape[1]]
    faces = np.concatenate([cells[:, list(face)] for face in kinds])
    _, first, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    alone = np.sort(first[count == 1])
    return np.asarray(faces[alone], dtype=np.int64), np.asarray(alone % len(cells), dtype=np.int64)


def looking(
    corners: FloatArray, cells: IntArray, along: tuple[float, float, float], within: float
) -> IntArray:
    """Return the outer faces whose outward normal is within an angle of a direction.

    Args:
        corners: [m], shape (n, 3).
        cells: shape (m, 4) or (m, 8).
        along: the direction, of length 1.
        within: [rad].
    """
    faces, normals = outward_faces(corners, cells)
    size = np.linalg.norm(normals, axis=1)
    return np.asarray(faces[normals @ np.asarray(along) > cos(within) * size])


def outward_faces(corners: FloatArray, cells: IntArray) -> tuple[IntArray, FloatArray]:
    """Return the outer faces, their corners counter-clockwise as seen from outside, and normals twice their area.

    Args:
        corners: [m], shape (n, 3).
        cells: shape (m, 4) or (m, 8).

    Returns:
        Faces, shape (k, 3) or (k, 4), and outward normals [m^2], shape (k, 3).
    """
    faces, owner = outer_faces(cells)
    places = corners[faces]
    normals = np.cross(places[:, 1] - places[:, 0], places[:, 2] - places[:, 0])
    if faces.shape[1] == 4:
        normals = np.cross(places[:, 2] - places[:, 0], places[:, 3] - places[:, 1])
    outward = places.mean(axis=1) - corners[cells[owner]].mean(axis=1)
    turned = np.einsum("kc,kc->k", normals, outward) < 0
    faces, normals = faces.copy(), normals.copy()
    faces[turned] = faces[turned, ::-1]
    normals[turned] *= -1
    return faces, normals


def among(faces: IntArray, others: IntArray) -> np.ndarray:
    """Return which faces are among others, in whatever order their corners are; (k, 3 or 4) to (k,)."""
    known = {tuple(face) for face in np.sort(others, axis=1).tolist()}
    return np.array([tuple(face) in known for face in np.sort(faces, axis=1).tolist()])


ABOVE = pi / 2 - 0.05  # [rad] from straight up: seen from above
BELOW = pi / 4  # [rad] from straight down: lies on a bed


def above(corners: FloatArray, cells: IntArray) -> IntArray:
    """Return the outer faces that are seen from above."""
    return looking(corners, cells, (0.0, 0.0, 1.0), ABOVE)


def below(corners: FloatArray, cells: IntArray) -> IntArray:
    """Return the outer faces that a bed below carries: those within 45 degrees of looking straight down."""
    return looking(corners, cells, (0.0, 0.0, -1.0), BELOW)
