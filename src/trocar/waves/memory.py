"""Tissue that remembers: Prony series as extra states, split into the same 2 x 2 blocks.

With a Prony series per layer (see `tissues.layer`) the amplitudes q of one wavenumber obey

    M q'' + C q' + K q + sum over times G_d (q - z_d) = P f,   tau_d z_d' = q - z_d,   G_d = sum over layers g_ld K_l.

Layers that share a relaxation time share its states, and G_d = K^(1/2) b_d b_d^T K^(1/2) needs only as many of them,
w_d = b_d^T z_d, as it has rank. In modes with K = 1, M = Z^2 and C = T, and with x = (a, Z a', w), the inverse of
the first-order form and the form itself are

    A^-1 = [[-T, -Z, -b tau], [Z, 0, 0], [-b^T T, -b^T Z, -(1 + b^T b) tau]],
    A = [[0, 1/Z, 0], [-(1 + b b^T)/Z, -T/Z^2, b/Z], [b^T/tau, 0, -1/tau]].

Relaxation takes minutes where vibration takes milliseconds, and eigenvalues come out to the rounding of the largest.
So the slow poles are taken from A^-1 and the fast ones from A, parted where that costs least: at the geometric mean
of the two ends, half the digits that one of them alone would lose. What a force does to a slow pole is found from what
it holds in place, -A times that, because its own entry is a small difference.

Between its relaxed answer and the sudden one a system is asked at the real s = 1/tau of a few times, where a branch of
time tau_d resists with the share s tau_d/(1 + s tau_d) of its stiffness.

Without inertia and damping the poles are those of the symmetric tau^(1/2) (1 + b^T b) tau^(1/2): every one real and
negative, whatever the series (Biot 1954, J Appl Phys 25:1385).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.fft import dct

from trocar.errors import SolverError
from trocar.model import FloatArray
from trocar.waves.decouple import Blocks, congruent, paired, split, symmetric

_EVEN = 1e-12  # relative spread of weights that counts as none
_PLACES = 3  # relaxation times whose answer is kept at most
_RANK = 1e-13  # eigenvalue of G_d relative to the largest: below it is rounding
_DIAGONAL = 1e-11  # entry off the diagonal relative to the largest on it: below it is rounding of the modes
_APART = 1.01  # ratio of two poles between which slow and fast may be parted
_RESIDUAL = 1e-9  # of A^-1 rebuilt relative to itself
_ROUNDING = (
    2e-14  # of an eigenvalue relative to the largest, with a condition of 100: times what parting costs
)


@dataclass(frozen=True)
class Memory:
    """What J systems of n amplitudes remember.

    Attributes:
        times: tau_d, ascending [s], shape (D,).
        stiffness: G_d, shape (D, J, n, n).
    """

    times: FloatArray
    stiffness: FloatArray


@dataclass(frozen=True)
class _Modal:
    """Systems in modes with K = 1, and the way there.

    Attributes:
        slowness: Z [s], shape (J, n).
        damping: T [s], shape (J, n, n).
        branches: b, all times side by side, shape (J, n, N).
        times: tau of each column of b [s], shape (N,).
        shapes: from a to q, shape (J, n, n).
        projector: from q to a, shape (J, n, n).
    """

    slowness: FloatArray
    damping: FloatArray
    branches: FloatArray
    times: FloatArray
    shapes: FloatArray
    projector: FloatArray


def decouple_remembering(
    mass: FloatArray, damping: FloatArray, stiffness: FloatArray, memory: Memory
) -> Blocks:
    """Split J coupled second-order systems that remember into 2 x 2 blocks.

    Args:
        mass: symmetric positive definite, shape (J, n, n).
        damping: symmetric, shape (J, n, n).
        stiffness: long-term, symmetric positive definite, shape (J, n, n).
        memory: of the same systems.

    Raises:
        SolverError: a matrix is not positive definite, or the blocks do not rebuild the system.
    """
    modal = _modes(stiffness, memory, mass, damping)
    order = modal.slowness.shape[1]
    if _diagonal(modal.damping) and all(_diagonal(part) for part in _by_time(modal)):
        matrices, exit_, entry = _each_by_itself(modal)
    else:
        matrices, exit_, entry = _blocks(modal.slowness, modal.damping, modal.branches, modal.times)
    from_rates = modal.slowness[..., :, None] * modal.projector
    return Blocks(
        matrices=matrices,
        exit=np.einsum("jam,jmsi->jasi", modal.shapes, exit_),
        entry=np.concatenate(
            [
                np.einsum("jsim,jma->jsia", entry[..., :order], modal.projector),
                np.einsum("jsim,jma->jsia", entry[..., order:], from_rates),
            ],
            axis=-1,
        ),
    )


def creeping(stiffness: FloatArray, memory: Memory) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the modes of a system without inertia and damping.

    Each is one real pole: x' = -rate (x - equilibrium), equilibrium = from_amplitudes K^-1 P f, and the amplitudes are
    q = K^-1 P f + to_amplitudes (x - equilibrium).

    Args:
        stiffness: long-term, symmetric positive definite, shape (J, n, n).
        memory: of the same systems.

    Returns:
        Rates [1/s], shape (J, N), from_amplitudes, shape (J, N, n), and to_amplitudes, shape (J, n, N).
    """
    modal = _modes(stiffness, memory)
    root = np.sqrt(modal.times)
    gram = np.swapaxes(modal.branches, -1, -2) @ modal.branches
    retarded = root[:, None] * (np.eye(len(root)) + gram) * root
    times, vectors = np.linalg.eigh(0.5 * (retarded + np.swapaxes(retarded, -1, -2)))
    seen = np.swapaxes(modal.branches * root @ vectors, -1, -2)
    to_amplitudes = modal.shapes @ np.swapaxes(seen / times[..., None], -1, -2)
    return 1 / times, seen @ modal.projector, to_amplitudes


def alike(weights: FloatArray) -> bool:
    """Whether all layers have one series, so that shapes stay while they relax; weights g of shape (D, layers)."""
    spread = np.ptp(weights, axis=1).max(initial=0.0)
    return bool(spread <= _EVEN * weights.max(initial=0.0))


def between(times: FloatArray) -> list[FloatArray]:
    """Return the share of its stiffness with which each branch resists at 1/tau of a few times, the slowest first.

    Args:
        times: of the branches, ascending [s], shape (D,).

    Returns:
        At most three arrays of shape (D,).
    """
    few = np.unique(np.linspace(0, len(times) - 1, min(len(times), _PLACES)).round().astype(int))
    return [times / (times[i] + times) for i in few[::-1]]


def _modes(
    stiffness: FloatArray, memory: Memory, mass: FloatArray | None = None, damping: FloatArray | None = None
) -> _Modal:
    scale = 1 / np.sqrt(np.diagonal(stiffness, axis1=-2, axis2=-1))  # equilibrated: van der Sluis 1969
    try:
        factor = np.linalg.cholesky(scale[..., :, None] * stiffness * scale[..., None, :])
    except np.linalg.LinAlgError as error:
        raise SolverError(
            "stiffness matrix: expected positive definite; give some tension, bending or foundation"
        ) from error
    inverse = np.linalg.inv(factor) * scale[..., None, :]
    squares, vectors = np.linalg.eigh(congruent(inverse, np.zeros_like(stiffness) if mass is None else mass))
    if mass is not None and not (squares > 0).all():
        raise SolverError("mass matrix: expected positive definite; check densities and thicknesses")
    shapes = np.swapaxes(inverse, -1, -2) @ vectors
    turned = np.swapaxes(shapes, -1, -2)
    columns, times = [], []
    for time, part in zip(memory.times, memory.stiffness, strict=True):
        values, directions = np.linalg.eigh(symmetric(turned @ part @ shapes))
        values = np.where(values > _RANK * values[..., -1:], values, 0.0)
        needed = int((values > 0).sum(axis=-1).max(initial=0))
        columns.append((directions * np.sqrt(values)[..., None, :])[..., values.shape[-1] - needed :])
        times.append(np.full(needed, time))
    return _Modal(
        slowness=np.sqrt(np.maximum(squares, 0.0)),
        damping=np.zeros_like(stiffness) if damping is None else symmetric(turned @ damping @ shapes),
        branches=np.concatenate(columns, axis=-1),
        times=np.concatenate(times),
        shapes=shapes,
        projector=np.swapaxes(vectors, -1, -2) @ np.swapaxes(factor, -1, -2) / scale[..., None, :],
    )


def _by_time(modal: _Modal) -> list[FloatArray]:
    parts = [modal.branches[..., modal.times == time] for time in np.unique(modal.times)]
    return [part @ np.swapaxes(part, -1, -2) for part in parts]


def _each_by_itself(modal: _Modal) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Treat every mode as a system of its own: nothing couples them."""
    count, order = modal.slowness.shape
    times = np.unique(modal.times)
    own = [np.sqrt(np.diagonal(part, axis1=-2, axis2=-1)) for part in _by_time(modal)]
    matrices, exit_, entry = _blocks(
        modal.slowness.reshape(-1, 1),
        np.diagonal(modal.damping, axis1=-2, axis2=-1).reshape(-1, 1, 1),
        np.stack(own, axis=-1).reshape(-1, 1, len(times)),
        times,
    )
    blocks = matrices.shape[1]
    modes = np.arange(order)
    apart_exit = np.zeros((count, order, order, blocks, 2))
    apart_exit[:, modes, modes] = exit_.reshape(count, order, blocks, 2)
    apart_entry = np.zeros((count, order, blocks, 2, 2, order))
    shaped = entry.reshape(count, order, blocks, 2, 2)
    for mode in modes:
        apart_entry[:, mode, ..., mode] = shaped[:, mode]
    return (
        matrices.reshape(count, order * blocks, 2, 2),
        apart_exit.reshape(count, order, order * blocks, 2),
        apart_entry.reshape(count, order * blocks, 2, 2 * order),
    )


def _blocks(
    slowness: FloatArray, damping: FloatArray, branches: FloatArray, times: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return blocks (J, s, 2, 2), exit to a (J, n, s, 2) and entry from (a, Z a'), w relaxed, (J, s, 2, 2n)."""
    order = slowness.shape[1]
    inverse, system = _first_order(slowness, damping, branches, times)
    poles, right, left, slow, sound = _poles(inverse, system)
    if not sound.all():
        again = _poles(inverse[~sound], system[~sound], turned=True)
        for kept, found in zip((poles, right, left, slow), again[:4], strict=True):
            kept[~sound] = found
        sound[~sound] = again[4]
    relaxed = left[..., :order] + left[..., 2 * order : 2 * order + len(times)] @ np.swapaxes(
        branches, -1, -2
    )
    rates = np.where(
        slow[..., None], -poles[..., None] * relaxed * slowness[:, None, :], left[..., order : 2 * order]
    )
    left = np.concatenate([relaxed, rates], axis=-1)
    size = inverse.shape[1]
    matrices = np.zeros((len(poles), size // 2, 2, 2))
    exit_ = np.zeros((len(poles), order, size // 2, 2))
    entry = np.zeros((len(poles), size // 2, 2, 2 * order))
    real = (poles.imag == 0).sum(axis=-1)
    for count in np.unique(real[sound]):
        alike = sound & (real == count)
        matrices[alike], exit_[alike], entry[alike] = paired(
            poles[alike], right[alike, :order], left[alike], int(count)
        )
    if not sound.all():  # poles that meet
        matrices[~sound], exit_[~sound], entry[~sound] = _met(
            inverse[~sound], slowness[~sound], branches[~sound]
        )
    return matrices, exit_, entry


def _first_order(
    slowness: FloatArray, damping: FloatArray, branches: FloatArray, times: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return A^-1 and A, one idle state added where their size would be odd; shape (J, p, p)."""
    count, order = slowness.shape
    states = 2 * order + len(times)
    size = states + states % 2
    a, b, w = np.arange(order), np.arange(order, 2 * order), np.arange(2 * order, states)
    turned = np.swapaxes(branches, -1, -2)
    inverse, system = np.zeros((2, count, size, size))
    inverse[:, :order, :order] = -damping
    inverse[:, a, b], inverse[:, b, a] = -slowness, slowness
    inverse[:, :order, 2 * order : states] = -branches * times
    inverse[:, 2 * order : states, :order] = -turned @ damping
    inverse[:, 2 * order : states, order : 2 * order] = -turned * slowness[:, None, :]
    inverse[:, 2 * order : states, 2 * order : states] = -(np.eye(len(times)) + turned @ branches) * times
    swift = 1 / slowness[..., None]
    system[:, a, b] = 1 / slowness
    system[:, order : 2 * order, :order] = -swift * (np.eye(order) + branches @ turned)
    system[:, order : 2 * order, order : 2 * order] = -swift * damping * np.swapaxes(swift, -1, -2)
    system[:, order : 2 * order, 2 * order : states] = swift * branches
    system[:, 2 * order : states, :order] = turned / times[:, None]
    system[:, w, w] = -1 / times
    if states < size:
        inverse[:, -1, -1], system[:, -1, -1] = -times.max(), -1 / times.max()
    return inverse, system


def _poles(
    inverse: FloatArray, system: FloatArray, *, turned: bool = False
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return the poles, ascending in size, their vectors, the vectors' inverse, which poles are slow, which J sound.

    LAPACK scales rows and columns to like size before it looks for eigenvalues. As a rule that saves digits of the
    small ones; where entries differ too much it costs digits of all (Watkins 2006, Electron Trans Numer Anal 23:1).
    `turned` keeps it from doing so: the coordinates are mixed first.
    """
    size = inverse.shape[1]
    basis = dct(np.eye(size), norm="ortho") if turned else np.eye(size)
    mixed = [basis.T @ matrix @ basis if turned else matrix for matrix in (inverse, system)]
    (from_inverse, slow_vectors), (from_system, fast_vectors) = (
        _ordered(*np.linalg.eig(matrix), inverted=i == 0) for i, matrix in enumerate(mixed)
    )
    slow_size, fast_size = np.abs(from_inverse), np.abs(from_system)
    # Cutting before pole i costs the larger of what A^-1 loses at pole i - 1 and what A loses at pole i.
    cost = np.ones((len(inverse), inverse.shape[1] + 1))
    cost[:, 1:] = slow_size / slow_size[:, :1]
    cost[:, :-1] = np.maximum(cost[:, :-1], fast_size[:, -1:] / np.maximum(fast_size, 1e-300))
    together = np.minimum(slow_size[:, 1:] / slow_size[:, :-1], fast_size[:, 1:] / fast_size[:, :-1]) < _APART
    cost[:, 1:-1][together] = np.inf
    cut = cost.argmin(axis=1)
    slow = np.arange(inverse.shape[1]) < cut[:, None]
    poles = np.where(slow, from_inverse, from_system)
    right = basis @ np.where(slow[:, None, :], slow_vectors, fast_vectors)
    try:
        left = np.linalg.inv(right)
    except np.linalg.LinAlgError:  # two poles share a vector; what comes out is not sound
        left = np.linalg.pinv(right)
    off = np.abs((right / poles[:, None, :]) @ left - inverse).max(axis=(-2, -1))
    allowed = np.maximum(_RESIDUAL, _ROUNDING * cost.min(axis=1))
    sound: np.ndarray = off <= allowed * np.abs(inverse).max(axis=(-2, -1))
    return poles, right, left, slow, sound


def _ordered(values: np.ndarray, vectors: np.ndarray, *, inverted: bool) -> tuple[np.ndarray, np.ndarray]:
    poles = 1 / values.astype(complex) if inverted else values.astype(complex)
    order = np.argsort(np.abs(poles), axis=-1, kind="stable")
    ordered = np.take_along_axis(vectors.astype(complex), order[:, None, :], axis=2)
    return np.take_along_axis(poles, order, axis=1), ordered


def _met(
    inverse: FloatArray, slowness: FloatArray, branches: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    order, kept = slowness.shape[1], branches.shape[2]
    matrices, columns, rows = split(inverse)
    matrices = np.asarray(np.linalg.inv(matrices), dtype=np.float64)
    relaxed = rows[..., :order] + np.einsum(
        "jsiw,jaw->jsia", rows[..., 2 * order : 2 * order + kept], branches
    )
    rates = -np.einsum("jsik,jska,ja->jsia", matrices, relaxed, slowness)
    return matrices, columns[:, :order], np.concatenate([relaxed, rates], axis=-1)


def _diagonal(matrices: FloatArray) -> bool:
    off = np.abs(matrices) * (1 - np.eye(matrices.shape[-1]))
    return bool(
        (off.max(axis=(-2, -1)) <= _DIAGONAL * np.abs(matrices).max(axis=(-2, -1), initial=0.0)).all()
    )
