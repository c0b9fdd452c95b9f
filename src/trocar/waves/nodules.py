"""Nodules under waves: a stiffer ball answers what it feels of a load like springs that hold on to the surface.

Where a ball of the layer is replaced by one that is stiffer by dC, strained by e, a stress tau = dC e comes up beside
the layer's own, and eases it (`easing`):

    tau/dC = e0 - Gamma tau,   e0 being what it would feel of the load if it were like the layer.

By reciprocity it takes e0(x) (1/dC + Gamma)^-1 e0(y) from the compliance between places x and y of the surface. With
tau a polynomial of the place this is a bound from below that a few degrees bring near (Hashin and Shtrikman 1962,
J Mech Phys Solids 10:335). Springs S that feel e = B u of the surface do the same if 1/S = 1/dC + Gamma - B C B, C
being what the waves yield: the last is how much of Gamma goes by way of the surface. Gamma is that of an endless body
(`easing`) and what the layers' faces change of it (`image`). Left out: sides that are near, and how nodules ease each
other but for what goes by way of the surface. `bench/nodule.py` says how far this is from finite elements.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations
from math import dist, pi

import numpy as np
from scipy.linalg import block_diag

from trocar.errors import InputError
from trocar.model import FloatArray
from trocar.tissues.layer import Layer
from trocar.tissues.nodule import MOST_NODULES, Nodule
from trocar.tissues.tissue import Tissue
from trocar.waves.buried import strains
from trocar.waves.easing import ball_points, ball_polynomials, ease_in_ball
from trocar.waves.image import image_in_layers
from trocar.waves.springs import NO_SPRINGS, Springs
from trocar.waves.tick import LiveWaves, Tick

_DEGREE = 2  # of the stress in a ball; the next adds 1 % to what a ball with half its radius above it does
_POINTS = (8, 5, 12)  # of a ball, for what it feels
_PASSED = 0.1  # of a wave, by the window: what a ball feels of shorter ones cannot be found again in them
_LEAST = 1e-4  # of what it feels most
_WEAKEST = 0.01  # of the spring that takes most: weaker ones are left out
_GRID = 2.5e-4  # [m] of the table, at most
_QUIET = 1e-4  # of a point's own compliance, as `tick.FAR`


def springs_under(
    nodules: Sequence[Nodule], waves: LiveWaves, tissue: Tissue, tick: Tick, *, window: float
) -> Springs:
    """Return the springs that some nodules are to a tick's waves.

    Args:
        nodules: none, or a few.
        waves: the tissue as the tick has it.
        tissue: its layers.
        tick: made of the waves.
        window: of the tick [m].

    Raises:
        InputError: two overlap; one is not wholly in one layer of the block, not stiffer than that, or so near the
            surface that the waves cannot carry what it does; or there are too many.
    """
    if not nodules:
        return NO_SPRINGS
    if len(nodules) > MOST_NODULES:
        raise InputError("nodules", f"at most {MOST_NODULES}", len(nodules))
    for one, other in combinations(nodules, 2):
        apart = dist((one.x, one.y, one.depth), (other.x, other.y, other.depth))
        if apart < one.radius + other.radius:
            raise InputError(
                "nodules",
                f"each beside the others, these two {1e3 * (one.radius + other.radius):.3g} mm apart at least",
                f"{1e3 * apart:.3g} mm",
            )
    hosts = [nodule.host(tissue, waves.size) for nodule in nodules]
    columns = waves.surface_modes[1]
    m, n = np.divmod(tick.kept, columns)
    kx, ky = pi / waves.size[0] * (m + 1.0), pi / waves.size[1] * (n + 1.0)
    felt = np.concatenate([_felt(tissue, nodule, waves.size, kx, ky) for nodule in nodules], axis=1)
    compliant = block_diag(
        *(_easing(nodule, host, tissue) for nodule, host in zip(nodules, hosts, strict=True))
    )
    passed = np.exp(-0.25 * window**2 * (kx**2 + ky**2))
    loud = np.abs(felt).max(axis=1) > _LEAST * np.abs(felt).max()
    m, n, felt, passed = (each[loud & (passed > _PASSED)] for each in (m, n, felt, passed))
    live = waves.surface_oscillators.yielding[m * columns + n, 0, 0]
    feel = felt / (live * passed)[:, None]
    compliant -= feel.T @ (live[:, None] * feel)
    if np.linalg.eigvalsh(compliant)[0] <= 0:
        shallow = min(nodules, key=lambda nodule: nodule.depth - nodule.radius)
        raise InputError(
            "nodule: depth",
            "one so deep that a live tissue's waves can carry what it does to the surface",
            f"{1e3 * shallow.depth:g} mm with a radius of {1e3 * shallow.radius:g} mm",
            "put it deeper, or make it smaller",
        )
    return _laid_out(
        m, n, _strongest(feel @ np.linalg.cholesky(np.linalg.inv(compliant)), live), passed, tick
    )


def _felt(
    tissue: Tissue, nodule: Nodule, size: tuple[float, float], kx: FloatArray, ky: FloatArray
) -> FloatArray:
    """Return what a nodule's polynomials feel of a modal force [1/N], shape (J, 6 n)."""
    points, shares = ball_points(*_POINTS)
    places = np.array([nodule.x, nodule.y, -nodule.depth]) + nodule.radius * points
    strained = strains(tissue, places, size, kx, ky)
    weights = shares[:, None] * ball_polynomials(points, _DEGREE)
    found: FloatArray = np.einsum("qn,jqa->jna", weights, strained, optimize=True).reshape(len(kx), -1)
    return found


def _easing(nodule: Nodule, host: Layer, tissue: Tissue) -> FloatArray:
    """Return 1/dC + Gamma between a nodule's polynomials [1/J], shape (6 n, 6 n)."""
    mean = np.zeros((6, 6))
    mean[:3, :3] = 1 / 3
    softer = mean / (3 * (nodule.bulk_modulus - host.bulk_modulus)) + (np.eye(6) - mean) / (
        2 * (nodule.shear_modulus - host.shear_modulus)
    )
    own = ease_in_ball(host, _DEGREE)
    count = len(own) * 6
    volume = 4 / 3 * pi * nodule.radius**3
    total = (own.reshape(count, count) + np.kron(np.eye(len(own)), softer)) / volume
    result: FloatArray = total + image_in_layers(tissue, nodule, host, _DEGREE).reshape(count, count)
    return 0.5 * (result + result.T)


def _strongest(feel: FloatArray, live: FloatArray) -> FloatArray:
    """Return the few springs of 1 J each that do most of what many do, by what they take from the waves' yielding."""
    taken, turn = np.linalg.eigh(feel.T @ (live[:, None] * feel))
    shares = taken / (1 + taken)
    return np.ascontiguousarray(feel @ turn[:, shares > _WEAKEST * shares[-1]])


def _laid_out(m: FloatArray, n: FloatArray, feel: FloatArray, passed: FloatArray, tick: Tick) -> Springs:
    at_once = tick.at_once[m, n]
    count = feel.shape[1]
    answer = np.linalg.inv(np.eye(count) + feel.T @ (at_once[:, None] * feel))
    x, y = (np.linspace(0.0, side, int(np.ceil(side / _GRID)) + 1) for side in tick.size.tolist())
    along, across = (
        np.sin(np.outer(nodes, pi / side * np.arange(1.0, most + 1)))
        for nodes, side, most in zip((x, y), tick.size.tolist(), tick.shape[2:], strict=True)
    )
    table = np.empty((len(x), len(y), count))
    spread = np.zeros(tick.shape[2:])
    for spring in range(count):
        spread[m, n] = feel[:, spring] * at_once * passed
        table[..., spring] = along @ spread @ across.T
    return Springs(
        row=m.astype(np.int64),
        column=n.astype(np.int64),
        feel=feel,
        answer=0.5 * (answer + answer.T),
        table=table,
        spacing=np.array([x[1], y[1]]),
        quiet=_QUIET * float(tick.inside[:, 0, 0].min()),
    )
