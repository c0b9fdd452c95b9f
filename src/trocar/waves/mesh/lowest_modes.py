"""The lowest modes of K phi = omega^2 M phi, by block Lanczos on K^-1 M (Golub and Underwood 1977).

Blocks, because a factor is read once for all vectors of a block, and because symmetric shapes have equal frequencies.
Every new block is made upright on all before, in the scalar product of M, twice.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import scipy.sparse as sp

from trocar.errors import SolverError
from trocar.model import FloatArray

_BLOCK = 16  # vectors
_MOST_BLOCKS = 40  # beyond four times as many vectors as modes
_RESIDUAL = 1e-8  # of a mode, relative; a frequency's error is its square
_GONE = 1e-12  # relative: the directions of a block that it does not really have


def lowest_modes(
    solve: Callable[[FloatArray], FloatArray],
    mass: sp.csr_array,
    count: int,
    *,
    progress: Callable[[int, int], None] | None = None,
) -> tuple[FloatArray, FloatArray]:
    """Return squared angular frequencies [1/s^2], ascending, and modes of unit mass, shape (count,) and (n, count).

    Args:
        solve: K^-1 of vectors, shape (n, k).
        mass: shape (n, n).
        count: how many.
        progress: told after every block how many of them have settled, and of how many.

    Raises:
        SolverError: they do not settle.
    """
    size = mass.shape[0]
    block, _ = _upright(np.random.default_rng(0).normal(size=(size, min(_BLOCK, size))), mass)
    basis = [block]
    projected = np.zeros((0, 0))
    for _ in range(_MOST_BLOCKS + 4 * count // _BLOCK):
        new = solve(mass @ block)
        old, width = projected.shape[0], block.shape[1]
        shares = np.zeros((old + width, width))
        for _ in range(2):
            heavy = mass @ new
            share = [one.T @ heavy for one in basis]
            for one, part in zip(basis, share, strict=True):
                new -= one @ part
            shares += np.concatenate(share)
        grown = np.zeros((old + width, old + width))
        grown[:old, :old] = projected
        grown[:, old:], grown[old:, :] = shares, shares.T
        projected = 0.5 * (grown + grown.T)
        values, vectors = np.linalg.eigh(projected)
        values, vectors = values[::-1], vectors[:, ::-1]
        new, factor = _upright(new, mass)
        settled = np.linalg.norm(factor @ vectors[old:, :count], axis=0) <= _RESIDUAL * values[:count]
        if progress is not None:
            progress(int(settled.sum()), count)
        if len(values) >= count and settled.all():
            modes, begin = np.zeros((size, count)), 0
            for one in basis:
                modes += one @ vectors[begin : begin + one.shape[1], :count]
                begin += one.shape[1]
            return 1.0 / values[:count], modes
        if new.shape[1] == 0:
            break
        block = new
        basis.append(block)
    raise SolverError(f"the mesh's lowest {count} modes did not settle; ask for fewer")


def _upright(block: FloatArray, mass: sp.csr_array) -> tuple[FloatArray, FloatArray]:
    """Return vectors of unit mass upright on each other, Q, and the factor R of block = Q R."""
    total = np.eye(block.shape[1])
    for _ in range(2):
        gram = block.T @ (mass @ block)
        squares, turn = np.linalg.eigh(0.5 * (gram + gram.T))
        kept = squares > _GONE * max(squares[-1], 1e-300)
        root = np.sqrt(squares[kept])
        block = (block @ turn[:, kept]) / root
        total = (root[:, None] * turn[:, kept].T) @ total
    return block, total
