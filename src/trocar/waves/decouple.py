"""From coupled equations of motion to independent 2 x 2 blocks.

At each wavenumber a stack of n coupled amplitudes q obeys M q'' + C q' + K q = P f. Where the damping is
proportional (it is diagonal in the undamped modes: Caughey and O'Kelly 1965, J Appl Mech 32:583) the blocks are
the undamped modes. Else they are pairs of poles of the first-order form: complex conjugates together, real poles by
neighbours. Two real poles that (almost) coincide share eigenvectors; their block is then taken from an ordered real
Schur form, which stays accurate (Bavely and Stewart 1979, SIAM J Numer Anal 16:359).

Eigenvalues come out to the rounding of the largest. Where something decays faster than anything vibrates, as a stiff
and viscous bed between two layers does, that would drown the slow motion, which is the one that lasts (of the skin
preset's, nine digits of sixteen were lost). There the inverse of the first-order form is split, whose largest
eigenvalues are the slowest.
In modes with K = 1, M = Z^2 and C = T, and with x = (a, Z a') for the modal amplitudes a, it is

    A^-1 = [[-T, -Z], [Z, 0]],

to which nothing large needs to be known.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import schur, solve_sylvester

from trocar.errors import SolverError
from trocar.model import FloatArray

_PROPORTIONAL = (
    1e-11  # off-diagonal damping relative to the diagonal: below it is rounding of the eigenvectors
)
_ILL_CONDITIONED = 1e2  # eigenvalue condition c: inverting the eigenvectors loses c^2, 1e-12 here
_RESIDUAL = 1e-9  # of the rebuilt system matrix; more means poles that met in a way not foreseen here


@dataclass(frozen=True)
class Blocks:
    """Independent blocks x' = A x + entry [0; M^-1 P f] of J systems of n amplitudes: s = n, or more with memory.

    Attributes:
        matrices: A [1/s], shape (J, s, 2, 2).
        entry: from (q, q') to x, shape (J, s, 2, 2n); what remembers has been held at q for ever.
        exit: from x to q, shape (J, n, s, 2): amplitude, block, component are axes 1, 2, 3.
    """

    matrices: FloatArray
    entry: FloatArray
    exit: FloatArray


def decouple(mass: FloatArray, damping: FloatArray, stiffness: FloatArray) -> Blocks:
    """Split J coupled second-order systems into 2 x 2 blocks.

    Args:
        mass: symmetric positive definite, shape (J, n, n).
        damping: symmetric, shape (J, n, n).
        stiffness: symmetric positive definite, shape (J, n, n).

    Raises:
        SolverError: a matrix is not positive definite, or the blocks do not rebuild the system.
    """
    try:
        lower = np.linalg.cholesky(mass)
    except np.linalg.LinAlgError as error:
        raise SolverError(
            "mass matrix: expected positive definite; check densities and thicknesses"
        ) from error
    inverse = np.linalg.inv(lower)
    squares, vectors = np.linalg.eigh(congruent(inverse, stiffness))
    if not (squares > 0).all():
        raise SolverError(
            f"stiffness matrix: expected positive definite, got a squared frequency of {squares.min():.3g}; "
            "give some tension, bending or foundation"
        )
    shapes = np.swapaxes(inverse, -1, -2) @ vectors  # M-orthonormal undamped modes
    frequency = np.sqrt(squares)
    modal_damping = np.swapaxes(shapes, -1, -2) @ damping @ shapes

    count, order = frequency.shape
    blocks = Blocks(
        matrices=np.zeros((count, order, 2, 2)),
        entry=np.zeros((count, order, 2, 2 * order)),
        exit=np.zeros((count, order, order, 2)),
    )
    projector = np.swapaxes(shapes, -1, -2) @ mass
    proportional = _is_diagonal(modal_damping)
    _fill_undamped_modes(blocks, proportional, frequency, modal_damping)
    fast = np.abs(modal_damping).max(axis=(-2, -1), initial=0.0) > frequency.max(axis=-1, initial=0.0)
    overdamped, swinging = ~proportional & fast, ~proportional & ~fast
    if swinging.any():
        _fill_complex_modes(blocks, swinging, frequency, modal_damping)
    result = _in_amplitudes(blocks, shapes, projector, frequency)
    if overdamped.any():
        _fill_overdamped(result, overdamped, mass, damping, stiffness)
    return result


def congruent(inverse: FloatArray, matrix: FloatArray) -> FloatArray:
    """Return inverse matrix inverse^T, symmetric to the last bit; both of shape (..., n, n)."""
    return symmetric(inverse @ matrix @ np.swapaxes(inverse, -1, -2))


def symmetric(matrices: FloatArray) -> FloatArray:
    """Return the symmetric part of matrices, shape (..., n, n)."""
    result: FloatArray = 0.5 * (matrices + np.swapaxes(matrices, -1, -2))
    return result


def _is_diagonal(matrices: FloatArray) -> np.ndarray:
    size = np.sqrt(np.abs(np.diagonal(matrices, axis1=-2, axis2=-1)))
    bound = _PROPORTIONAL * np.maximum(size[..., :, None] * size[..., None, :], 1e-300)
    # The largest entry sets the rounding level of all: they come out of one product.
    bound = np.maximum(bound, 1e-14 * np.abs(matrices).max(axis=(-2, -1), keepdims=True))
    off = np.abs(matrices) * (1 - np.eye(matrices.shape[-1]))
    result: np.ndarray = (off <= bound).all(axis=(-2, -1))
    return result


def _fill_undamped_modes(
    blocks: Blocks, where: np.ndarray, frequency: FloatArray, damping: FloatArray
) -> None:
    """X = (w q, q'): A = [[0, w], [-w, -c]], so that an undamped step is a rotation."""
    w = frequency[where]
    order = w.shape[-1]
    blocks.matrices[where, :, 0, 1] = w
    blocks.matrices[where, :, 1, 0] = -w
    blocks.matrices[where, :, 1, 1] = -np.diagonal(damping[where], axis1=-2, axis2=-1)
    modes = np.arange(order)
    entry = np.zeros((*w.shape, 2, 2 * order))
    entry[:, modes, 0, modes] = 1.0
    entry[:, modes, 1, order + modes] = 1.0
    leave = np.zeros((w.shape[0], order, order, 2))
    leave[:, modes, modes, 0] = 1.0
    blocks.entry[where] = entry
    blocks.exit[where] = leave


def _fill_complex_modes(
    blocks: Blocks, where: np.ndarray, frequency: FloatArray, damping: FloatArray
) -> None:
    w = frequency[where]
    order = w.shape[-1]
    system = np.zeros((w.shape[0], 2 * order, 2 * order))
    modes = np.arange(order)
    system[:, modes, order + modes] = w
    system[:, order + modes, modes] = -w
    system[:, order:, order:] = -damping[where]
    matrices, columns, rows = split(system)
    blocks.matrices[where], blocks.entry[where], blocks.exit[where] = matrices, rows, columns[:, :order]


def _fill_overdamped(
    blocks: Blocks, where: np.ndarray, mass: FloatArray, damping: FloatArray, stiffness: FloatArray
) -> None:
    """Split the inverse; entry and exit are those of amplitudes at once."""
    scale = 1 / np.sqrt(np.diagonal(stiffness[where], axis1=-2, axis2=-1))  # equilibrated: van der Sluis 1969
    factor = np.linalg.cholesky(scale[..., :, None] * stiffness[where] * scale[..., None, :])
    inverse = np.linalg.inv(factor) * scale[..., None, :]
    squares, vectors = np.linalg.eigh(congruent(inverse, mass[where]))
    slowness = np.sqrt(squares)  # Z
    modes = np.swapaxes(inverse, -1, -2) @ vectors
    from_amplitudes = np.swapaxes(vectors, -1, -2) @ np.swapaxes(factor, -1, -2) / scale[..., None, :]
    count, order = slowness.shape
    system = np.zeros((count, 2 * order, 2 * order))
    at = np.arange(order)
    system[:, :order, :order] = -np.swapaxes(modes, -1, -2) @ damping[where] @ modes
    system[:, at, order + at] = -slowness
    system[:, order + at, at] = slowness
    matrices, columns, rows = split(system)
    blocks.matrices[where] = np.linalg.inv(matrices)
    blocks.exit[where] = np.einsum("jam,jmsi->jasi", modes, columns[:, :order])
    blocks.entry[where] = np.concatenate(
        [
            np.einsum("jsim,jma->jsia", rows[..., :order], from_amplitudes),
            np.einsum("jsim,jm,jma->jsia", rows[..., order:], slowness, from_amplitudes),
        ],
        axis=-1,
    )


def split(system: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return real blocks of J matrices of even size a: sum over blocks of columns block rows = system.

    Returns:
        Blocks (J, a/2, 2, 2), columns (J, a, a/2, 2) and rows (J, a/2, 2, a).
    """
    systems, order = len(system), system.shape[-1] // 2
    poles, right = np.linalg.eig(system)
    left = np.linalg.inv(right)
    poles, right, left = poles.astype(complex), right.astype(complex), left.astype(complex)
    condition = (np.linalg.norm(right, axis=-2) * np.linalg.norm(left, axis=-1)).max(axis=-1)
    matrices = np.zeros((systems, order, 2, 2))
    columns, rows = np.zeros((systems, 2 * order, order, 2)), np.zeros((systems, order, 2, 2 * order))
    real = (poles.imag == 0).sum(axis=-1)
    for count in np.unique(real):
        alike = real == count
        matrices[alike], columns[alike], rows[alike] = paired(poles[alike], right[alike], left[alike], count)
    for row in np.flatnonzero(condition > _ILL_CONDITIONED):
        found = _pair_with_double_pole(system[row], poles[row], left[row], right[row])
        if found is not None:
            matrices[row], columns[row], rows[row] = found
    rebuilt = np.einsum("jasi,jsik,jskb->jab", columns, matrices, rows)
    residual = (np.abs(rebuilt - system).max(axis=(-2, -1)) / np.abs(system).max(axis=(-2, -1))).max()
    if residual > _RESIDUAL:
        raise SolverError(
            f"damped modes: expected a residual below {_RESIDUAL:g}, got {residual:.2g}: more than two poles "
            "coincide; change a layer's damping by a part in a thousand"
        )
    return matrices, columns, rows


def paired(
    poles: np.ndarray, right: np.ndarray, left: np.ndarray, real: int
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return real blocks of J systems with `real` real poles each: sum over blocks of columns A rows = system.

    A conjugate pair w' = s w, u = 2 Re(right w) is the block of x = (Re w, Im w); two neighbouring real poles are one
    diagonal block.

    Args:
        poles: shape (J, p), p even.
        right: eigenvectors as columns, shape (J, a, p).
        left: the inverse's rows, shape (J, p, b).
        real: number of real poles of each system.

    Returns:
        Blocks (J, p/2, 2, 2), columns (J, a, p/2, 2) and rows (J, p/2, 2, b).
    """
    systems, size = poles.shape
    pairs = (size - real) // 2
    # Upper half plane first, then the real axis in ascending order, then the conjugates nobody needs.
    kind = np.where(poles.imag > 0, 0, np.where(poles.imag == 0, 1, 2))
    order = np.lexsort((poles.real, kind), axis=-1)
    poles = np.take_along_axis(poles, order, axis=-1)
    right = np.take_along_axis(right, order[:, None, :], axis=2)
    left = np.take_along_axis(left, order[:, :, None], axis=1)
    matrices = np.zeros((systems, size // 2, 2, 2))
    columns = np.zeros((systems, right.shape[1], size // 2, 2))
    rows = np.zeros((systems, size // 2, 2, left.shape[2]))
    upper = poles[:, :pairs]
    matrices[:, :pairs, 0, 0] = matrices[:, :pairs, 1, 1] = upper.real
    matrices[:, :pairs, 0, 1], matrices[:, :pairs, 1, 0] = -upper.imag, upper.imag
    columns[:, :, :pairs, 0], columns[:, :, :pairs, 1] = (
        2 * right[..., :pairs].real,
        -2 * right[..., :pairs].imag,
    )
    rows[:, :pairs, 0], rows[:, :pairs, 1] = left[:, :pairs].real, left[:, :pairs].imag
    for component in (0, 1):
        one = slice(pairs + component, pairs + real, 2)
        matrices[:, pairs:, component, component] = poles[:, one].real
        columns[:, :, pairs:, component] = right[..., one].real
        rows[:, pairs:, component] = left[:, one].real
    return matrices, columns, rows


def _pair_with_double_pole(
    system: FloatArray, poles: np.ndarray, left: np.ndarray, right: np.ndarray
) -> tuple[FloatArray, FloatArray, FloatArray] | None:
    """Take the two worst-conditioned poles of one system out by an ordered real Schur form, and pair the others.

    Returns None where those two are not alone near the real axis.
    """
    condition = np.linalg.norm(right, axis=-2) * np.linalg.norm(left, axis=-1)
    pair = poles[np.argsort(condition)[-2:]]
    centre = pair.mean().real
    reach = 2 * np.abs(pair - centre).max() + 1e-6 * abs(centre)
    triangle, basis, inside = schur(system, sort=lambda re, im: bool(abs(complex(re, im) - centre) <= reach))
    if inside != 2:
        return None
    coupling = solve_sylvester(triangle[:2, :2], -triangle[2:, 2:], -triangle[:2, 2:])
    block_columns = basis[:, :2]
    block_rows = basis[:, :2].T - coupling @ basis[:, 2:].T
    rest_columns = basis[:, 2:] + basis[:, :2] @ coupling
    rest_poles, rest_right = np.linalg.eig(triangle[2:, 2:])
    rest_left = np.linalg.inv(rest_right) @ basis[:, 2:].T
    real = int((rest_poles.imag == 0).sum())
    vectors = (rest_columns @ rest_right).astype(complex)
    matrices, columns, rows = paired(
        rest_poles[None].astype(complex), vectors[None], rest_left[None].astype(complex), real
    )
    return (
        np.concatenate([triangle[None, :2, :2], matrices[0]]),
        np.concatenate([block_columns[:, None, :], columns[0]], axis=1),
        np.concatenate([block_rows[None], rows[0]]),
    )


def _in_amplitudes(
    blocks: Blocks, shapes: FloatArray, projector: FloatArray, frequency: FloatArray
) -> Blocks:
    """Turn entry and exit from energy coordinates (w q, q') into amplitudes."""
    order = shapes.shape[-1]
    scaled = projector * frequency[..., :, None]
    entry = np.concatenate(
        [
            np.einsum("jsim,jma->jsia", blocks.entry[..., :order], scaled),
            np.einsum("jsim,jma->jsia", blocks.entry[..., order:], projector),
        ],
        axis=-1,
    )
    return Blocks(
        matrices=blocks.matrices,
        entry=entry,
        exit=np.einsum("jam,jmsi->jasi", shapes / frequency[..., None, :], blocks.exit),
    )
