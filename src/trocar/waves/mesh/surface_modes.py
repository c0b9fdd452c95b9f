"""Modes of a mesh that answer every site of a surface: its lowest ones, and those that the sites themselves excite.

The lowest modes alone miss most of a dent. What they leave of the static answer to the sites, and what the inertia of
that moves,

    V1 = K^-1 P,   V2 = K^-1 M V1,   both less the modes' share,

span a space of its own, upright on the modes in the scalar products of K and M (attachment modes: MacNeal 1971, Comput.
Struct. 1:581; Craig and Chang 1977, AIAA 77-405). V1 is taken of every second column and row of the sites, V2, which is
smoother, of every fourth. The modes of this space carry inertia and damping as the lowest do. All together they give
the static answer at those sites exactly, and that to slow forces nearly so. What is left at the sites between,
R - S S^T with S the static shapes, is not negative (what a projection leaves) and follows at once.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from trocar.errors import InputError
from trocar.model import FloatArray
from trocar.tissues.layer import Layer, relaxation_times
from trocar.waves.mesh.press_grid import PressGrid
from trocar.waves.mesh.solid_mesh import IntArray
from trocar.waves.mesh.wave_mesh import WaveMesh

_CHUNK = 64  # right-hand sides solved for at once: the factor is read once for all
_NEW = 1e-7  # of the largest: combinations of vectors that are nearer to the others than that answer at once

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
        progress: told after every part how many systems of equations are solved, and of how many.

    Raises:
        InputError: materials damp differently, or remember.
        SolverError: the mesh is not held.
    """
    time = _retardation_time(model.mesh.materials)
    found = model.kept(
        lambda: _made(model, grid, progress), "surface modes", grid.surface, grid.window, grid.spacing
    )
    squares, shapes, rest = found
    return SurfaceModes(squares, shapes, rest, time)


def _retardation_time(materials: tuple[Layer, ...]) -> float:
    """Return tau of the damping C = tau K [s], where every mode moves for itself.

    Raises:
        InputError: modes would move each other.
    """
    remembering = [material.name for material in materials if relaxation_times((material,), "mesh")]
    if remembering:
        raise InputError(
            "materials of an organ that tools move on",
            "none that remembers",
            f"a Prony series of {' and '.join(remembering)}",
            "take the [layer.memory] table out of the tissue file (WaveMesh itself steps such a tissue)",
        )
    times = sorted({material.retardation_time for material in materials})
    taut = any(material.prestress_x or material.prestress_y for material in materials)
    if len(times) > 1 or (taut and times[0] > 0):
        raise InputError(
            "materials of an organ that tools move on",
            "one loss for all of them, and no prestress beside it",
            f"{', '.join(f'{1e3 * time:.3g}' for time in times)} ms of retardation"
            + (", prestress" if taut else ""),
            "give all layers the same loss_factor and loss_frequency, and none beside prestress "
            "(WaveMesh itself steps such a tissue)",
        )
    return times[0]


def _made(
    model: WaveMesh, grid: PressGrid, progress: Progress | None
) -> tuple[FloatArray, FloatArray, FloatArray]:
    squares, modes = model.lowest
    forces, mass = grid.forces, model.matrices.mass
    count = forces.shape[1]
    lowest = np.asarray(forces.T @ modes)
    chosen, fewer = _every(2, grid.number), _every(4, grid.number)
    place = np.full(count, -1)
    place[chosen] = np.arange(len(chosen))
    first, second = np.empty((len(modes), len(chosen))), np.empty((len(modes), len(fewer)))
    compliance, total = np.empty((count, count)), count + len(fewer)
    for begin in range(0, count, _CHUNK):
        own = slice(begin, begin + _CHUNK)
        answer = model.matrices.answer(forces[:, own].toarray())
        compliance[:, own] = forces.T @ answer
        here = np.flatnonzero(place[own] >= 0)
        first[:, place[own][here]] = answer[:, here] - modes @ (lowest[begin + here] / squares).T
        _tell(progress, begin + _CHUNK, count, total)
    for begin in range(0, len(fewer), _CHUNK):
        moved = mass @ first[:, place[fewer[begin : begin + _CHUNK]]]
        moved -= mass @ (modes @ (modes.T @ moved))
        second[:, begin : begin + _CHUNK] = model.matrices.answer(moved)
        _tell(progress, count + begin + _CHUNK, total, total)
    left = compliance - (lowest / squares) @ lowest.T
    left = 0.5 * (left + left.T)
    own_squares, excited = _modes_of(model, first, second)
    seen = np.asarray(forces.T @ excited)
    return (
        np.append(squares, own_squares),
        np.concatenate([lowest, seen], axis=1),
        left - (seen / own_squares) @ seen.T,
    )


def _modes_of(model: WaveMesh, *generations: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return squared angular frequencies [1/s^2], ascending, and modes of unit mass, of what all vectors span."""
    # Of one size, whatever their unit: a small vector is then one of a site that hardly moves.
    vectors = np.concatenate(
        [one / np.linalg.norm(one, axis=0).max() for one in generations if one.shape[1]], axis=1
    )
    stiff = vectors.T @ (model.matrices.stiffness @ vectors)
    energy = np.diag(stiff)
    size = np.zeros(len(energy))
    moves = energy > _NEW * energy.max()
    size[moves] = 1.0 / np.sqrt(energy[moves])
    values, onto = np.linalg.eigh(0.5 * (stiff + stiff.T) * size[:, None] * size)
    new = values > _NEW * values[-1]
    onto = size[:, None] * onto[:, new] / np.sqrt(values[new])
    heavy = onto.T @ (vectors.T @ (model.matrices.mass @ vectors)) @ onto
    masses, turn = np.linalg.eigh(-0.5 * (heavy + heavy.T))  # of unit stiffness; the slowest first
    return -1.0 / masses, vectors @ ((onto @ turn) / np.sqrt(-masses))


def _tell(progress: Progress | None, done: int, most: int, total: int) -> None:
    if progress is not None:
        progress(min(done, most), total)


def _every(nth: int, number: IntArray) -> IntArray:
    """Return the sites of every nth column and row."""
    part = number[::nth, ::nth].ravel()
    return np.asarray(part[part >= 0], dtype=np.int64)
