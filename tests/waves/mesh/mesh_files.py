"""Mesh files, written by meshio, which nobody here wrote."""

from __future__ import annotations

import meshio
import numpy as np

from waves.mesh.meshes import BLOCK, tetrahedra


def block_file(path, *, kind="hexahedron", points=None, cells=None, extra=(), **options):
    """Write the block of `meshes`, in mm, with its layers as regions and its base as a group of faces."""
    mesh = BLOCK if kind == "hexahedron" else tetrahedra(BLOCK)
    faces = mesh.held[0].faces
    flat = "quad" if kind == "hexahedron" else "triangle"
    cells = mesh.cells if cells is None else cells
    blocks = [(kind, cells), (flat, faces), *extra]
    tags = [mesh.region + 1, np.full(len(faces), 9), *(np.full(len(one), 7) for _, one in extra)]
    meshio.Mesh(
        1e3 * mesh.corners if points is None else points,
        blocks,
        cell_data={"gmsh:physical": tags, "gmsh:geometrical": tags},
        field_data={name: np.array([i + 1, 3]) for i, name in enumerate(("cover", "middle", "fat"))}
        | {"base": np.array([9, 2])},
    ).write(path, **options)
    return path


def ball(rings=12, radius=20.0):
    """Return corners and triangles of a sphere about (0, 0, 0), each triangle with corners of its own as in STL."""
    theta, phi = np.linspace(0, np.pi, rings + 1), np.linspace(0, 2 * np.pi, 2 * rings, endpoint=False)
    grid = radius * np.stack(
        [
            np.outer(np.sin(theta), np.cos(phi)),
            np.outer(np.sin(theta), np.sin(phi)),
            np.outer(np.cos(theta), np.ones_like(phi)),
        ],
        axis=-1,
    )
    grid[0], grid[-1] = (0, 0, radius), (0, 0, -radius)
    a, b = grid[:-1], grid[1:]
    c, d = np.roll(b, -1, axis=1), np.roll(a, -1, axis=1)
    three = np.concatenate([np.stack([a, b, c], axis=2)[:-1], np.stack([a, c, d], axis=2)[1:]]).reshape(-1, 3)
    return three, np.arange(len(three)).reshape(-1, 3)
