"""Matrices on bricks: patch test, rigid motions, prestress, mass, a column squeezed between walls."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse.linalg as sla

from trocar.reference.assembly import damping, mass, stiffness
from trocar.reference.mesh import Bricks, graded_lines
from trocar.tissues import Layer

UNEVEN = Bricks(
    x=np.array([0.0, 0.7, 1.0, 2.4]),
    y=np.array([0.0, 1.1, 1.3]),
    z=np.array([-1.5, -0.4, -0.1, 0.0]),
    slab_layer=np.array([1, 0, 0]),
)


def layer(name: str = "wall", **change: float) -> Layer:
    base = {"thickness": 1.0, "young_modulus": 3.0, "poisson_ratio": 0.49, "density": 2.0}
    return Layer(name=name, **(base | change))


PAIR = (layer("upper"), layer("lower", thickness=1.1))


def boundary(bricks: Bricks) -> np.ndarray:
    low, high = bricks.nodes.min(axis=1, keepdims=True), bricks.nodes.max(axis=1, keepdims=True)
    return np.any((bricks.nodes == low) | (bricks.nodes == high), axis=0)


def test_patch() -> None:
    """A linear displacement given on the boundary holds inside: constant strain on unequal elements."""
    gradient = np.array([[0.1, -0.3, 0.2], [0.4, 0.05, -0.1], [-0.2, 0.3, 0.15]])
    exact = gradient @ UNEVEN.nodes + np.array([[1.0], [2.0], [3.0]])
    held = np.tile(boundary(UNEVEN), 3)
    matrix = stiffness(UNEVEN, PAIR)
    found = np.where(held, exact.ravel(), 0.0)
    inner = np.flatnonzero(~held)
    assert len(inner) > 20
    found[inner] = sla.spsolve(matrix[inner][:, inner].tocsc(), -(matrix @ found)[inner])
    np.testing.assert_allclose(
        found, exact.ravel(), atol=1e-11
    )  # rounding times the condition number, about 1e4


def test_energy_of_constant_strain() -> None:
    """u K u = V (lambda tr(e)^2 + 2 mu e:e), to rounding."""
    gradient = np.array([[0.1, -0.3, 0.2], [0.4, 0.05, -0.1], [-0.2, 0.3, 0.15]])
    u = (gradient @ UNEVEN.nodes).ravel()
    strain, volume = 0.5 * (gradient + gradient.T), 2.4 * 1.3 * 1.5
    expected = volume * (
        PAIR[0].lame_lambda * np.trace(strain) ** 2 + 2 * PAIR[0].shear_modulus * (strain**2).sum()
    )
    assert u @ (stiffness(UNEVEN, PAIR) @ u) == pytest.approx(expected, rel=1e-12)


def test_rigid_motions_cost_nothing() -> None:
    matrix = stiffness(UNEVEN, PAIR)
    x, y, z = UNEVEN.nodes
    nothing, one = np.zeros_like(x), np.ones_like(x)
    motions = [(one, nothing, nothing), (nothing, one, nothing), (nothing, nothing, one)]
    motions += [(-y, x, nothing), (nothing, -z, y), (z, nothing, -x)]
    for motion in motions:
        assert np.abs(matrix @ np.concatenate(motion)).max() < 1e-12 * np.abs(matrix).max()
    others = np.linalg.eigvalsh(matrix.toarray())[6:]
    assert others.min() > 1e-6 * others.max()  # nothing else does: no element mode without energy


def test_prestress_stiffens_slopes() -> None:
    """u_z = s x + t y against tension: energy V (sigma_x s^2 + sigma_y t^2) beside the elastic one."""
    tense = tuple(
        layer(part.name, thickness=part.thickness, prestress_x=0.7, prestress_y=0.2) for part in PAIR
    )
    extra = stiffness(UNEVEN, tense) - stiffness(UNEVEN, PAIR)
    slope = np.array([[0.3, 0.1, 0.0], [0.0, 0.2, 0.5], [0.4, -0.6, 0.7]])
    u = (slope @ UNEVEN.nodes).ravel()
    expected = 2.4 * 1.3 * 1.5 * (0.7 * (slope[:, 0] ** 2).sum() + 0.2 * (slope[:, 1] ** 2).sum())
    assert u @ (extra @ u) == pytest.approx(expected, rel=1e-11)


def test_mass_and_damping() -> None:
    total = mass(UNEVEN, PAIR)
    u = np.concatenate([np.ones(2 * UNEVEN.nodes.shape[1]), UNEVEN.nodes[0]])
    volume = 2.4 * 1.3 * 1.5
    assert u @ (total @ u) == pytest.approx(2.0 * volume * (2 + 2.4**2 / 3), rel=1e-12)
    lossy = tuple(layer(p.name, thickness=p.thickness, loss_factor=0.3, prestress_x=1.0) for p in PAIR)
    difference = damping(UNEVEN, lossy) - lossy[0].retardation_time * stiffness(UNEVEN, PAIR)
    assert np.abs(difference).max() < 1e-14  # C = tau K, without the prestress; entries of C are about 1e-2


@pytest.mark.parametrize("poisson_ratio", [0.0, 0.3, 0.49])
def test_column_between_walls(poisson_ratio: float) -> None:
    """A column that cannot widen shortens by p sum of h / E_oed, E_oed = lambda + 2 mu."""
    parts = (
        layer("upper", poisson_ratio=poisson_ratio),
        layer("lower", poisson_ratio=0.2, young_modulus=0.5),
    )
    matrix = stiffness(UNEVEN, parts)
    x, _, z = UNEVEN.nodes
    held = np.stack([np.ones_like(x), np.ones_like(x), z == z.min()]).astype(bool).ravel()
    force = np.zeros(held.size)
    pressure = 0.01
    gauss, weight = np.polynomial.legendre.leggauss(3)
    for x0, x1 in zip(UNEVEN.x[:-1], UNEVEN.x[1:], strict=True):
        for y0, y1 in zip(UNEVEN.y[:-1], UNEVEN.y[1:], strict=True):
            points = np.array([(x0 + 0.5 * (1 + a) * (x1 - x0), y0 + 0.5 * (1 + b) * (y1 - y0))
                               for a in gauss for b in gauss])  # fmt: skip
            nodes, shapes = UNEVEN.interpolation(points, 3)
            area = 0.25 * (x1 - x0) * (y1 - y0) * np.outer(weight, weight).ravel()
            np.add.at(force, 2 * x.size + nodes, -pressure * shapes * area)
    free = np.flatnonzero(~held)
    u = np.zeros(held.size)
    u[free] = sla.spsolve(matrix[free][:, free].tocsc(), force[free])
    oedometric = [part.lame_lambda + 2 * part.shear_modulus for part in parts]
    expected = -pressure * (0.4 / oedometric[0] + 1.1 / oedometric[1])
    np.testing.assert_allclose(u[2 * x.size :][z == 0.0], expected, rtol=1e-10)


def test_lines_are_nested_when_refined() -> None:
    def spacing(places: np.ndarray) -> np.ndarray:
        return 0.1 + 0.3 * np.abs(places - 0.4)

    coarse, fine = (graded_lines(0.0, 2.0, spacing, refinement) for refinement in (0, 2))
    np.testing.assert_allclose(fine[::4], coarse, atol=1e-14)
    assert np.all(np.diff(coarse) < 1.3 * spacing(0.5 * (coarse[1:] + coarse[:-1])))


def test_one_element_has_no_modes_without_energy() -> None:
    """Reduced integration throughout would leave 12 motions without energy, not 6, and a singular mass."""
    brick = Bricks(
        x=np.array([0.0, 1.0]), y=np.array([0.0, 2.0]), z=np.array([-0.5, 0.0]), slab_layer=np.array([0])
    )
    energies = np.linalg.eigvalsh(stiffness(brick, (layer(),)).toarray())
    assert np.count_nonzero(energies < 1e-10 * energies.max()) == 6
    masses = np.linalg.eigvalsh(mass(brick, (layer(),)).toarray())
    assert masses.min() > 1e-3 * masses.max()
