"""Through-thickness response against closed forms of elasticity."""

import numpy as np
import pytest

from trocar.tissues import Layer, Tissue
from trocar.waves.banded import surface_compliance
from trocar.waves.thin_layer import Wavenumbers, horizontal_shear, vertical_and_along


def layer(name="pad", *, thickness=0.01, young_modulus=1e4, poisson_ratio=0.48, **more):
    return Layer(
        name=name,
        thickness=thickness,
        young_modulus=young_modulus,
        poisson_ratio=poisson_ratio,
        density=1000.0,
        **more,
    )


def at(*k):
    k = np.array(k, dtype=float)
    return Wavenumbers(k, k**2 / 2, k**2 / 2)


SKIN = Tissue(
    layers=(
        layer("epidermis", thickness=1e-4, young_modulus=1e6),
        layer("dermis", thickness=1e-3, young_modulus=2e5),
        layer("fat", thickness=1e-2, young_modulus=5e3, poisson_ratio=0.49),
    )
)


def test_a_uniform_pressure_squeezes_each_layer_by_its_constrained_modulus():
    compliance = surface_compliance(vertical_and_along(SKIN, base_held=True), at(1e-3))
    below = np.cumsum([h.thickness / (h.lame_lambda + 2 * h.shear_modulus) for h in SKIN.layers[::-1]])[::-1]
    # Terms in (k h)^2 are left: 1e-10 times the ratio of constrained to shear modulus, 50.
    assert compliance[0, :, 0, 0] == pytest.approx(below, rel=1e-7)


def test_a_short_wave_sees_a_half_space():
    tissue = Tissue(layers=(layer(poisson_ratio=0.3),))
    k = 2000.0  # k h = 20: the base is e^-20 away
    compliance = surface_compliance(vertical_and_along(tissue, base_held=True, refinement=4), at(k))[0, 0]
    mu, nu = tissue.layers[0].shear_modulus, 0.3
    # Johnson 1985, section 2.2 in Fourier space: w = (1 - nu)/(mu k) p, and the cross term (1 - 2 nu)/(2 mu k).
    assert compliance[0, 0] == pytest.approx(
        (1 - nu) / (mu * k), rel=1e-4
    )  # quadratic elements, k h_e = 0.25
    assert compliance[1, 1] == pytest.approx((1 - nu) / (mu * k), rel=1e-4)
    assert abs(compliance[1, 0]) == pytest.approx((1 - 2 * nu) / (2 * mu * k), rel=1e-3)


def test_horizontal_shear_of_a_held_layer_is_a_hyperbolic_tangent():
    tissue = Tissue(layers=(layer(),))
    k = np.array([1.0, 50.0, 300.0])
    compliance = surface_compliance(horizontal_shear(tissue, base_held=True), at(*k))[:, 0, 0, 0]
    mu, h = tissue.layers[0].shear_modulus, tissue.thickness
    # mu (S'' - k^2 S) = 0, S(0) = 0, mu S'(h) = 1: S(h) = tanh(k h)/(mu k). Elements of a fifth of h: 1e-5 at k h = 3.
    assert compliance == pytest.approx(np.tanh(k * h) / (mu * k), rel=3e-5)


def test_prestress_adds_a_tension_to_a_free_sheet():
    sheet = Tissue(layers=(layer(thickness=1e-4, prestress_x=3e4, prestress_y=3e4),))
    bare = Tissue(layers=(layer(thickness=1e-4),))
    k = 300.0
    with_, without = (
        surface_compliance(vertical_and_along(t, base_held=False), at(k))[0, 0, 0, 0] for t in (sheet, bare)
    )
    # Stiffnesses add: 1/with - 1/without = sigma h k^2, but for terms in (k h)^2 = 1e-3.
    assert 1 / with_ - 1 / without == pytest.approx(3e4 * 1e-4 * k**2, rel=2e-3)
    plate = bare.layers[0].young_modulus * 1e-12 / (12 * (1 - 0.48**2)) * k**4
    assert 1 / without == pytest.approx(plate, rel=2e-3)  # Kirchhoff's plate, again but for (k h)^2


@pytest.mark.parametrize("base_held", [True, False])
@pytest.mark.parametrize("family", [vertical_and_along, horizontal_shear])
def test_the_banded_solution_equals_a_dense_one_and_is_symmetric(family, base_held):
    layers = family(SKIN, base_held=base_held)
    where = at(80.0, 700.0, 4000.0)
    top = np.eye(layers.size)[None, :, -layers.components :].repeat(3, axis=0)
    dense = np.linalg.solve(layers.stiffness(where), top)
    banded = surface_compliance(layers, where)
    for face in range(3):
        for component in range(layers.components):
            row = dense[:, layers.unknown(face, component)]
            # Both solutions carry the condition number of the stack, 1e6, times rounding.
            assert banded[:, face, component] == pytest.approx(row, rel=1e-6, abs=1e-9 * np.abs(dense).max())
    assert banded[:, 0] == pytest.approx(np.swapaxes(banded[:, 0], 1, 2), rel=1e-6, abs=1e-20)


def test_elements_are_fine_enough_for_tools():
    where = at(*np.geomspace(74, 3400, 12))  # up to the 64th mode of 60 mm
    coarse = surface_compliance(vertical_and_along(SKIN, base_held=True), where)
    fine = surface_compliance(vertical_and_along(SKIN, base_held=True, refinement=4), where)
    # 1e-3 at wavelengths of 2 mm, whose share under a 5 mm tool is a few per cent: 1e-4 of its deflection.
    assert coarse[:, 0, 0, 0] == pytest.approx(fine[:, 0, 0, 0], rel=1e-3)
