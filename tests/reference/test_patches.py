"""Patches of uneven bricks under large deformation: a homogeneous state is found exactly, for every law."""

from __future__ import annotations

from math import exp, sqrt

import numpy as np
import pytest
from scipy.optimize import brentq, root

from reference.closed_forms import BULK, LAWS, MU, principal
from trocar.reference.deformed import DeformedBricks
from trocar.reference.mesh import Bricks
from trocar.reference.newton import Directions, balance
from trocar.reference.stress import deformations, largest_cauchy_mises
from trocar.tissues import Fibre, Law, Layer, Ogden


def by_name(law: Law) -> str:
    return type(law).__name__


def patch(law: Law) -> tuple[Bricks, tuple[Layer, ...]]:
    """Bricks of 3 x 2 x 4 mm; the layer has MU and BULK."""
    x, y, z = (np.array(lines) * 1e-3 for lines in ([0, 1.3, 3], [0, 0.8, 2], [-4, -2.5, -1, 0]))
    young = 9 * BULK * MU / (3 * BULK + MU)
    layer = Layer(
        name="pad",
        thickness=4e-3,
        young_modulus=young,
        poisson_ratio=young / (2 * MU) - 1,
        density=1e3,
        law=law,
    )
    return Bricks(x=x, y=y, z=z, slab_layer=np.zeros(3, dtype=np.int64)), (layer,)


class Prescribed:
    """Some components of the displacement given, the others free of force."""

    def __init__(self, deformed: DeformedBricks, given: np.ndarray) -> None:
        self._deformed, self._given = deformed, given

    def field(self, unknowns: np.ndarray) -> np.ndarray:
        flat = self._given.copy().ravel()
        flat[self._deformed.free] = unknowns
        return flat.reshape(self._given.shape)

    def imbalance(self, unknowns: np.ndarray) -> np.ndarray:
        return self._deformed.forces(self.field(unknowns)).ravel()[self._deformed.free]

    def tangent(self, unknowns: np.ndarray) -> object:
        return self._deformed.stiffness(self.field(unknowns))


def solved(law: Law, gradient: np.ndarray, prescribed: np.ndarray) -> tuple[Bricks, np.ndarray, np.ndarray]:
    """Return the patch, its displacement and nodal forces, from a start in which the free nodes are astray."""
    bricks, layers = patch(law)
    exact = (gradient - np.eye(3)) @ bricks.nodes
    free = np.flatnonzero(~prescribed.ravel())
    deformed = DeformedBricks(bricks, layers, free)
    equations = Prescribed(deformed, np.where(prescribed, exact, 0.0))
    astray = exact.ravel()[free] + 3e-6 * np.random.default_rng(3).normal(size=len(free))
    found = balance(
        equations, astray, scale=MU * 1e-6, tolerance=1e-10, directions=Directions("superlu", reuse=False)
    )
    field = equations.field(found.unknowns)
    np.testing.assert_allclose(field, exact, atol=1e-9 * np.abs(exact).max())
    return bricks, field, deformed.forces(field)


def on(bricks: Bricks, axis: int, upper: bool) -> np.ndarray:
    lines = (bricks.x, bricks.y, bricks.z)[axis]
    return np.isclose(bricks.nodes[axis], lines[-1 if upper else 0], rtol=0, atol=1e-9)


def rollers(bricks: Bricks) -> np.ndarray:
    """No way out through the three lower faces."""
    held = np.zeros(bricks.nodes.shape, dtype=bool)
    for axis in range(3):
        held[axis] = on(bricks, axis, False)
    return held


@pytest.mark.parametrize("law", LAWS, ids=by_name)
@pytest.mark.parametrize("stretch", [0.6, 1.6])
def test_uniaxial_patch(law: Law, stretch: float) -> None:
    """Pulled along z, its sides free: they draw in as the closed form has it, and the pull is its stress."""

    found = root(
        lambda sides: principal(law, np.array([*sides, stretch]))[:2] / MU, [stretch**-0.5] * 2, tol=1e-14
    )
    stretches = np.array([*found.x, stretch])
    bricks, _ = patch(law)
    prescribed = rollers(bricks)
    top = on(bricks, 2, True)
    prescribed[2] |= top
    bricks, field, forces = solved(law, np.diag(stretches), prescribed)
    expected = principal(law, stretches)
    assert forces[2, top].sum() == pytest.approx(expected[2] * 3e-3 * 2e-3, rel=1e-8)
    cauchy = expected * stretches / stretches.prod()
    mises = np.sqrt(1.5) * np.linalg.norm(cauchy - cauchy.mean())
    (found,) = largest_cauchy_mises(bricks, patch(law)[1], [field], prestress=False)
    assert found == pytest.approx(mises, rel=1e-8)
    (extent,) = deformations(bricks, patch(law)[1], [field])
    assert extent.stretch == pytest.approx((stretches.min(), stretches.max()), rel=1e-8)
    assert extent.volume_ratio == pytest.approx((stretches.prod(),) * 2, rel=1e-8)


@pytest.mark.parametrize("law", LAWS, ids=by_name)
def test_equibiaxial_patch(law: Law) -> None:
    thin = brentq(lambda s: principal(law, np.array([1.4, 1.4, s]))[2], 0.2, 1.0, xtol=1e-15)
    stretches = np.array([1.4, 1.4, thin])
    bricks, _ = patch(law)
    prescribed = rollers(bricks)
    for axis in (0, 1):
        prescribed[axis] |= on(bricks, axis, True)
    bricks, _, forces = solved(law, np.diag(stretches), prescribed)
    for axis, area in ((0, 8e-6), (1, 12e-6)):
        total = forces[axis, on(bricks, axis, True)].sum()
        assert total == pytest.approx(principal(law, stretches)[axis] * area, rel=1e-8)


@pytest.mark.parametrize("law", LAWS, ids=by_name)
def test_sheared_patch(law: Law) -> None:
    """Sheared by g = 0.8 in the plane y-z, where J = 1: the shear stress is dW/dg, from the laws' formulas."""
    amount, gradient = 0.8, np.eye(3)
    gradient[1, 2] = amount
    bricks, _ = patch(law)
    outer = np.any([on(bricks, axis, upper) for axis in range(3) for upper in (False, True)], axis=0)
    bricks, _, forces = solved(law, gradient, np.tile(outer, (3, 1)))
    terms = law.terms if isinstance(law, Ogden) else ((1.0, 2.0),)
    stretch = (amount + sqrt(amount**2 + 4)) / 2  # the principal stretches are it, 1 and 1 over it
    expected = sum(2 * share * MU / alpha * (stretch**alpha - stretch**-alpha) for share, alpha in terms)
    expected /= stretch + 1 / stretch
    if isinstance(law, Fibre):  # across the fibres: I4 = 1, I1 = 3 + g^2
        spread = law.dispersion**2
        expected += 4 * law.k1 * spread * amount**3 * exp(law.k2 * spread * amount**4)
    assert np.abs(forces.sum(axis=1)).max() < 1e-10 * np.abs(forces).max()
    virial = float((forces[1] * bricks.nodes[2]).sum())  # stress times volume, whichever face bears it
    assert virial == pytest.approx(expected * 24e-9, rel=1e-9)
