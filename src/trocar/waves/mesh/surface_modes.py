"""Modes of a mesh that answer every site of a surface: its lowest ones, and those that the sites themselves excite.

The lowest modes alone miss most of a dent. What they leave of the static answer to all sites, V = K^-1 P less the
modes' share, is a space of its own, upright on the modes in the scalar products of K and M (attachment modes: Craig and
Chang 1977, AIAA 77-405; MacNeal 1971, Comput. Struct. 1:581). From every second column and row of the sites,

    R_cc = Vc^T K Vc = Pc^T Vc,   Vc^T M Vc a = mu R_cc a,

come modes of frequency mu^-1/2 with the shapes R_.c a at the sites. They carry inertia and damping. Together with the
lowest modes they give the static answer at those sites exactly, and its second order of frequency. What is
left at the sites between, R - R_.c R_cc^-1 R_c., is not negative (a Schur complement) and follows at once.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from trocar.errors import InputError
from trocar.model import FloatArray
from trocar.waves.mesh.press_grid import PressGrid
from trocar.waves.mesh.solid_mesh import IntArray
from trocar.waves.mesh.wave_mesh import WaveMesh

_CHUNK = 64  # sites solved for at once: the factor is read once for all
_NEW = 1e-7  # of the largest: combinations of sites that answer less than that answer at once

Progress = Callable[[int, int], None]


@dataclass(frozen=True, eq=False)
class SurfaceModes:
    """How a surface answers at its sites.

    Attributes:
        squares: of the angular frequencies, without damping [1/s^2], shape (r,).
        shapes: displacement into the surface at the sites, of modes of unit mass [kg^-1/2], shape (N, r).
        rest: static answer of what is left out, from every site to every other [m/N], shape (N, N).
        retardation_time: tau of the damping C = tau K [s].
    """

    squares: FloatArray
    shapes: FloatArray
    rest: FloatArray
    retardation_time: float

    @property
    def static(self) -> FloatArray:
        """How far every site sinks per newton held on each [m/N], shape (N, N)."""
        return np.asarray((self.shapes / self.squares) @ self.shapes.T + self.rest)


def surface_modes(model: WaveMesh, grid: PressGrid, *, progress: Progress | None = None) -> SurfaceModes:
    """Find the modes that answer every site; they are looked for and kept in the model's cache.

    Args:
        model: of the mesh; its modes are the lowest ones.
        grid: the sites, on the model's first surface.
        progress: told after every part how many sites have been solved for, and of how many.

    Raises:
        InputError: materials damp differently.
        SolverError: the mesh is not held.
    """
    materials = model.mesh.materials
    times = sorted({material.retardation_time for material in materials})
    taut = any(material.prestress_x or material.prestress_y for material in materials)
    if len(times) > 1 or (taut and times[0] > 0):
        raise InputError(
            "surface modes: materials",
            "one loss for all of them, and none with prestress: their modes then move each for itself",
            times,
            "WaveMesh itself steps such a tissue",
        )
    found = model.kept(lambda: _made(model, grid, progress), "surface modes", grid.window, grid.spacing)
    squares, shapes, rest = found
    return SurfaceModes(squares, shapes, rest, times[0])


def _made(
    model: WaveMesh, grid: PressGrid, progress: Progress | None
) -> tuple[FloatArray, FloatArray, FloatArray]:
    squares, modes = model.lowest
    forces = grid.forces
    count = forces.shape[1]
    lowest = np.asarray(forces.T @ modes)
    chosen = _every_second(grid.number)
    place = np.full(count, -1)
    place[chosen] = np.arange(len(chosen))
    answers, compliance = np.empty((len(modes), len(chosen))), np.empty((count, count))
    for begin in range(0, count, _CHUNK):
        own = slice(begin, begin + _CHUNK)
        answer = model.matrices.answer(forces[:, own].toarray())
        compliance[:, own] = forces.T @ answer
        here = np.flatnonzero(place[own] >= 0)
        answers[:, place[own][here]] = answer[:, here] - modes @ (lowest[begin + here] / squares).T
        if progress is not None:
            progress(min(begin + _CHUNK, count), count)
    left = compliance - (lowest / squares) @ lowest.T
    left = 0.5 * (left + left.T)
    values, vectors = np.linalg.eigh(left[np.ix_(chosen, chosen)])
    new = values > _NEW * max(values[-1], 0.0)
    onto = vectors[:, new] / np.sqrt(values[new])
    heavy = onto.T @ (answers.T @ (model.matrices.mass @ answers)) @ onto
    masses, turn = np.linalg.eigh(0.5 * (heavy + heavy.T))
    excited = (left[:, chosen] @ onto) @ turn  # of unit stiffness
    slowest_first = np.argsort(-masses)
    masses, excited = masses[slowest_first], excited[:, slowest_first]
    return (
        np.append(squares, 1.0 / masses),
        np.concatenate([lowest, excited / np.sqrt(masses)], axis=1),
        left - excited @ excited.T,
    )


def _every_second(number: IntArray) -> IntArray:
    """Return the sites of every second column and row."""
    half = number[::2, ::2].ravel()
    return np.asarray(half[half >= 0], dtype=np.int64)
