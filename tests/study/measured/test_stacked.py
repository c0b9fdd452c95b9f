"""Compliance of stacks: the half-space, the wave model's layers, and a punch's known answer."""

from __future__ import annotations

import numpy as np
import pytest

from trocar.study.measured.stacked import pressure_compliance, punch_compliance
from trocar.tissues import Layer, Tissue
from trocar.waves.near_field import layered_compliance

THICKNESS, MODULI, NU = np.array([[1.5e-3, 5e-3, 3e-2]]), np.array([3e4, 3e3, 7e3]), 0.49


def test_it_is_the_static_compliance_of_the_wave_models() -> None:
    layers = tuple(
        Layer(name=name, thickness=thickness, young_modulus=2 * mu * (1 + NU), poisson_ratio=NU, density=1000)
        for name, thickness, mu in zip(("skin", "fat", "muscle"), THICKNESS[0], MODULI, strict=True)
    )
    k = np.array([20.0, 100.0, 300.0])
    waves = layered_compliance(Tissue(name="limb", layers=layers), k, base_held=True, finest=1e-3)[:, 0]
    # the wave model's thin layers of quadratic elements, 0.4 mm at the top
    np.testing.assert_allclose(pressure_compliance(THICKNESS, MODULI, NU, k[None])[0], waves, rtol=2e-4)


@pytest.mark.parametrize("nu", [0.3, 0.49, 0.5])
def test_a_deep_stack_of_one_material_is_a_half_space(nu: float) -> None:
    deep = np.full((1, 3), 10.0)
    found = punch_compliance(deep, np.full(3, 1e4), nu, np.array([0.01]))
    # J. Boussinesq: (1 - nu)/(4 mu a); the base 30 m down takes a/h of it, the tail is right to 1e-4
    assert found[0] == pytest.approx((1 - nu) / (4 * 1e4 * 0.01), rel=1e-3)


def test_a_stack_thinner_than_the_punch_is_stiffer_and_each_layer_counts_alike_where_all_are_one() -> None:
    thin, thick = (
        punch_compliance(np.array([[depth, depth]]), np.full(2, 1e4), NU, np.array([0.01]))[0]
        for depth in (2e-3, 2e-2)
    )
    assert thin < 0.3 * thick
    split = punch_compliance(np.array([[0.5e-3, 3.5e-3]]), np.full(2, 1e4), NU, np.array([0.01]))[0]
    assert split == pytest.approx(thin, rel=1e-9)  # where it is cut makes no difference but rounding
