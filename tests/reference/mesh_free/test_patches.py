"""Linear patches: a field of constant stress leaves no node inside out of balance."""

import numpy as np
import pytest

from trocar.model import Press, Support
from trocar.reference.block import MeshSize
from trocar.reference.mesh_free.body import Body
from trocar.reference.mesh_free.cloud import scatter
from trocar.reference.solver import Factorisation
from trocar.tissues import Layer, Linear, NeoHookean, Tissue

SIZE = (0.03, 0.024)
AROUND = (Press(x=0.013, y=0.012, radius=4e-3, force=1.0),)
SPACING = MeshSize(per_radius=1.5, growth=0.8, top=0.6, deepening=0.8)
SLOPE = np.array([[0.02, 0.03, -0.01], [0.01, -0.04, 0.02], [0.05, -0.02, 0.03]])


def body(law=None, moduli=(1e4,)):
    layers = tuple(
        Layer(
            name=f"layer {i}",
            thickness=4e-3,
            young_modulus=E,
            poisson_ratio=0.48,
            density=1e3,
            law=law or Linear(),
        )
        for i, E in enumerate(moduli)
    )
    tissue = Tissue(layers=layers)
    return Body(scatter(tissue, SIZE, Support.BASE, AROUND, SPACING), tissue, Support.BASE, "superlu")


def on_the_surface(places):
    low, high = places.min(axis=0), places.max(axis=0)
    return ((places == low) | (places == high)).any(axis=1)


@pytest.mark.parametrize("law", [Linear(), NeoHookean()])
def test_constant_strain_is_in_balance_inside(law):
    one = body(law)
    places = one.cloud.places
    forces = one.internal(places @ SLOPE.T, np.zeros_like(places))
    inside = ~on_the_surface(places)
    assert inside.sum() > 30
    assert np.abs(forces[inside]).max() < 1e-12 * np.abs(forces).max()  # rounding


def test_a_patch_driven_from_its_surface_strains_evenly():
    one = body()
    places = one.cloud.places
    exact = (places @ SLOPE.T).ravel()
    given = np.repeat(on_the_surface(places), 3)
    matrix = one.stiffness
    solved = exact.copy()
    inner = Factorisation(matrix[~given][:, ~given], "superlu")
    solved[~given] = inner.solve(-(matrix[~given][:, given] @ exact[given]))
    assert np.abs(solved - exact).max() < 1e-10 * np.abs(exact).max()  # condition 1e4 times rounding


def test_stacked_layers_each_strain_evenly_under_one_pressure():
    """Squeezed between held sides, each layer by p / (lambda + 2 mu): a slope that jumps at the interface."""
    one = body(moduli=(1e4, 2e3))
    places, z = one.cloud.places, one.cloud.places[:, 2]
    constrained = [layer.lame_lambda + 2 * layer.shear_modulus for layer in one.tissue.layers]
    strain = [-1e3 / modulus for modulus in constrained]
    field = np.zeros_like(places)
    field[:, 2] = np.where(z > -4e-3, strain[1] * 4e-3 + strain[0] * (z + 4e-3), strain[1] * (z + 8e-3))
    forces = one.internal(field, np.zeros_like(places))
    inside = ~on_the_surface(places)
    assert np.abs(forces[inside]).max() < 1e-12 * np.abs(forces).max()  # rounding
    assert forces[z == 0, 2].sum() == pytest.approx(-1e3 * SIZE[0] * SIZE[1], rel=1e-12)


def test_forces_of_small_displacements_are_the_stiffness_times_them():
    one = body(moduli=(1e4, 2e3))
    field = one.spread(np.random.default_rng(0).standard_normal(len(one.free)))
    forces = one.internal(field, np.zeros_like(field)).ravel()
    np.testing.assert_allclose(forces, one.stiffness @ field.ravel(), atol=1e-12 * np.abs(forces).max())
