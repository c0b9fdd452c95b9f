"""Forces and stiffness of the springs, at rest and far from it."""

import numpy as np
import pytest

from trocar.reference.deformed import InversionError
from trocar.reference.solver import submatrix
from trocar.reference.springs.boxes import Boxes
from trocar.reference.springs.lattice import DeformedLattice, Lattice
from trocar.tissues import Layer


def layers(**given):
    base = {"thickness": 1e-3, "density": 1000.0, "loss_factor": 0.2} | given
    return (
        Layer(name="upper", young_modulus=1e4, poisson_ratio=0.48, **base),
        Layer(name="lower", young_modulus=2e4, poisson_ratio=0.3, **base),
    )


def uneven(slab_layer=(1, 0)):
    return Boxes(
        x=1e-3 * np.array([0, 1, 2.5, 3]),
        y=1e-3 * np.array([0, 0.7, 2]),
        z=1e-3 * np.array([-1.5, -0.1, 0]),
        slab_layer=np.array(slab_layer),
    )


def lattice(boxes, **given):
    return DeformedLattice(boxes, layers(**given), np.arange(boxes.nodes.size))


def astray(boxes, size=1e-4, seed=0):
    """Return a displacement [m] that is a few tenths of the boxes' sides: far from any small strain."""
    return size * np.random.default_rng(seed).normal(size=boxes.nodes.shape)


def test_forces_are_the_derivative_of_the_energy_and_stiffness_that_of_the_forces():
    boxes = uneven()
    springs, field, way = lattice(boxes, prestress_x=300.0), astray(boxes, 3e-5), astray(boxes, 1.0, 1)
    ahead, behind = field + 1e-10 * way, field - 1e-10 * way
    work = (springs.energy(ahead) - springs.energy(behind)) / 2e-10
    assert work == pytest.approx(float((springs.forces(field) * way).sum()), rel=1e-6)
    slope = (springs.forces(ahead) - springs.forces(behind)) / 2e-10
    exact = (springs.stiffness(field) @ way.ravel()).reshape(way.shape)
    assert np.abs(slope - exact).max() < 1e-7 * np.abs(exact).max()  # what the difference rounds


def test_turning_the_lattice_stores_nothing_and_turns_its_forces():
    boxes = uneven()
    springs, field = lattice(boxes), astray(boxes, 3e-5)
    turn = np.linalg.qr(np.random.default_rng(2).normal(size=(3, 3)))[0]
    turn *= np.sign(np.linalg.det(turn))
    away = turn @ boxes.nodes - boxes.nodes
    scale = springs.energy(field)
    assert springs.energy(away) < 1e-24 * scale / 1e-10  # a square of rounding
    turned = turn @ (boxes.nodes + field) - boxes.nodes
    assert springs.energy(turned) == pytest.approx(scale, rel=1e-9)
    expected = turn @ springs.forces(field)
    assert springs.forces(turned) == pytest.approx(expected, abs=1e-9 * np.abs(expected).max())


def test_the_convex_stand_in_is_never_negative_where_the_stiffness_is():
    boxes = uneven()
    springs = lattice(boxes)
    squeezed = np.zeros(boxes.nodes.shape)
    squeezed[0] = -0.4 * boxes.nodes[0]
    squeezed += astray(boxes, 3e-5)
    exact, convex = (matrix.toarray() for matrix in (springs.stiffness(squeezed), springs.convex(squeezed)))
    assert np.linalg.eigvalsh(exact)[0] < -1e-3 * np.abs(exact).max()
    assert np.linalg.eigvalsh(convex)[0] > -1e-12 * np.abs(convex).max()  # rounding
    assert springs.convex(0 * squeezed).toarray() == pytest.approx(
        springs.stiffness(0 * squeezed).toarray(), abs=1e-12 * np.abs(convex).max()
    )


def test_a_box_inside_out_is_refused():
    boxes = uneven()
    flipped = np.zeros(boxes.nodes.shape)
    flipped[2] = -2.5 * boxes.nodes[2]
    with pytest.raises(InversionError, match="inside out"):
        lattice(boxes).forces(flipped)


def test_dashpots_take_energy_from_what_changes_shape_and_none_from_what_turns():
    boxes = uneven()
    springs, field = lattice(boxes), astray(boxes, 3e-5)
    spin = np.cross([1.0, 2.0, 3.0], (boxes.nodes + field).T).T
    moving = springs.damping(field)
    assert np.abs(moving @ spin.ravel()).max() < 1e-12 * abs(moving).max() * np.abs(spin).max()
    velocity = astray(boxes, 1.0, 3)
    force = springs.viscous_forces(field, velocity)
    assert force.ravel() == pytest.approx(moving @ velocity.ravel(), abs=1e-12 * np.abs(force).max())
    assert (force * velocity).sum() > 0
    times = [layer.retardation_time for layer in layers()]
    at_rest = springs.damping(np.zeros_like(field))
    assert abs(at_rest - times[0] * Lattice().stiffness(boxes, layers())).max() < 1e-12 * abs(at_rest).max()


SMALL = np.array([[1.0, 0.4, -0.3], [0.2, -0.8, 0.5], [0.7, -0.1, 0.3]])


def inner_and_outer(boxes):
    places = boxes.nodes
    outer = np.zeros(places.shape[1], dtype=bool)
    for axis in range(3):
        outer |= np.isclose(places[axis], places[axis].min()) | np.isclose(places[axis], places[axis].max())
    assert not outer.all()
    return np.flatnonzero(~np.tile(outer, 3)), np.flatnonzero(np.tile(outer, 3))


def test_patch_a_homogeneous_small_strain_is_exact_on_uneven_boxes():
    boxes = Boxes(
        x=1e-3 * np.array([0, 1, 2.5, 3]),
        y=1e-3 * np.array([0, 0.7, 2, 2.1]),
        z=1e-3 * np.array([-1.5, -1.4, -0.4, 0]),
        slab_layer=np.zeros(3, dtype=int),
    )
    stiffness = Lattice().stiffness(boxes, layers())
    inner, outer = inner_and_outer(boxes)
    exact = (SMALL @ boxes.nodes).ravel()
    right = -(stiffness[inner][:, outer] @ exact[outer])
    found = np.linalg.solve(submatrix(stiffness, inner).toarray(), right)
    assert found == pytest.approx(exact[inner], abs=1e-10 * np.abs(exact).max())  # rounding of flat boxes


def test_patch_a_large_homogeneous_stretch_is_in_balance_on_even_boxes():
    """On uneven ones it is not: what scissors store beyond small strain depends on the shape of their face."""
    line = 1e-3 * np.arange(4.0)
    even = Boxes(x=line, y=0.5 * line, z=0.2 * line - 6e-4, slab_layer=np.zeros(3, dtype=int))
    inner, _ = inner_and_outer(even)
    forces = lattice(even).forces(0.2 * SMALL @ even.nodes).ravel()
    assert np.abs(forces[inner]).max() < 1e-12 * np.abs(forces).max()
