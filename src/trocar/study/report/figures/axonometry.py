"""A parallel projection of blocks and surfaces onto paper: lengths along each axis can be compared across a picture.

x runs to the right and a little down, y to the back, z up. No perspective and no hidden scale: the one number a
picture must state is by how much displacements are enlarged.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import Colormap, Normalize

from trocar.model import FloatArray

LIGHT = np.array([-0.45, -0.35, 0.82])  # towards the lamp, from the left and the front
SHADE = 0.55  # how much darker a face turned away is


@dataclass(frozen=True, kw_only=True)
class View:
    """Where one looks from.

    Args:
        turn: of the block about z [rad].
        rise: of the eye above the horizon [rad].
    """

    turn: float = np.radians(-24)
    rise: float = np.radians(27)

    def project(self, points: FloatArray) -> FloatArray:
        """Return the place on paper of points (x, y, z), shape (..., 3), as (right, up), shape (..., 2)."""
        c, s = np.cos(self.turn), np.sin(self.turn)
        x, y, z = np.moveaxis(points, -1, 0)
        right, away = c * x - s * y, s * x + c * y
        return np.stack([right, away * np.sin(self.rise) + z * np.cos(self.rise)], axis=-1)

    def at(self, *point: float) -> tuple[float, float]:
        """Return the place on paper of one point x, y, z."""
        right, up = self.project(np.array(point))
        return float(right), float(up)

    def distance(self, points: FloatArray) -> FloatArray:
        """Return how far points lie from the eye, up to a constant, shape (...)."""
        c, s = np.cos(self.turn), np.sin(self.turn)
        x, y, z = np.moveaxis(points, -1, 0)
        result: FloatArray = (s * x + c * y) * np.cos(self.rise) - z * np.sin(self.rise)
        return result


def quads(x: FloatArray, y: FloatArray, z: FloatArray) -> FloatArray:
    """Return the four corners of every cell of a grid, shape (cells, 4, 3).

    Args:
        x: of the grid lines across x, shape (n,).
        y: of the grid lines across y, shape (m,).
        z: heights, shape (n, m).
    """
    grid_x, grid_y = np.meshgrid(x, y, indexing="ij")
    points = np.stack([grid_x, grid_y, z], axis=-1)
    corners = (points[:-1, :-1], points[1:, :-1], points[1:, 1:], points[:-1, 1:])
    return np.stack(corners, axis=2).reshape(-1, 4, 3)


def shading(faces: FloatArray) -> FloatArray:
    """Return the brightness of each face, shape (cells,), 1 at most; `faces` as `quads` returns them."""
    normal = np.cross(faces[:, 2] - faces[:, 0], faces[:, 3] - faces[:, 1])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    lamp = LIGHT / np.linalg.norm(LIGHT)
    result: FloatArray = np.clip(1 - SHADE * (lamp[2] - normal @ lamp), 0.35, 1.0)
    return result


def colours(faces: FloatArray, values: FloatArray, scale: Normalize, cmap: Colormap) -> FloatArray:
    """Return the shaded colour of each face, shape (cells, 4); `values` of the grid's points, shape (n, m)."""
    middle = 0.25 * (values[:-1, :-1] + values[1:, :-1] + values[1:, 1:] + values[:-1, 1:])
    rgba = np.array(cmap(scale(middle.ravel())))
    rgba[:, :3] *= shading(faces)[:, None]
    return rgba


def draw_surface(
    axes: Axes,
    view: View,
    faces: FloatArray,
    rgba: FloatArray,
) -> PolyCollection:
    """Draw faces, the farthest first, and return them."""
    order = np.argsort(-view.distance(faces.mean(axis=1)))
    flat = view.project(faces[order])
    drawn = PolyCollection(list(flat), facecolors=rgba[order], edgecolors="face", linewidths=0.3)
    drawn.set_rasterized(True)  # thousands of faces would make a vector file of megabytes
    axes.add_collection(drawn)
    return drawn


def draw_polygon(axes: Axes, view: View, points: FloatArray, **style: Any) -> None:
    """Draw one polygon through points (x, y, z), shape (n, 3)."""
    axes.add_collection(PolyCollection([view.project(points)], **style))


def draw_rim(axes: Axes, view: View, x: FloatArray, y: FloatArray, z: FloatArray) -> None:
    """Draw the outline of a surface; arguments as in `quads`."""
    sides = (
        np.stack([x, np.full_like(x, y[0]), z[:, 0]], 1),
        np.stack([np.full_like(y, x[-1]), y, z[-1]], 1),
        np.stack([x, np.full_like(x, y[-1]), z[:, -1]], 1)[::-1],
        np.stack([np.full_like(y, x[0]), y, z[0]], 1)[::-1],
    )
    draw_polygon(axes, view, np.concatenate(sides), facecolor="none", edgecolor="#9aa0a6", linewidth=0.6)


def fit(axes: Axes, view: View, corners: FloatArray, margin: float = 0.03) -> None:
    """Set the limits of axes to hold all `corners`, shape (n, 3), and a margin of the larger side."""
    flat = view.project(corners)
    low, high = flat.min(axis=0), flat.max(axis=0)
    rim = margin * float(np.max(high - low))
    axes.set_xlim(low[0] - rim, high[0] + rim)
    axes.set_ylim(low[1] - rim, high[1] + rim)
    axes.set_aspect("equal")
    axes.set_axis_off()
