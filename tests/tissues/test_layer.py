from math import inf, nan

import pytest

from trocar import Layer, Tissue
from trocar.errors import InputError

GOOD = {"name": "dermis", "thickness": 1e-3, "young_modulus": 1e5, "poisson_ratio": 0.48, "density": 1100.0}


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("name", ""),
        ("thickness", 0.0),
        ("thickness", -1e-3),
        ("thickness", nan),
        ("thickness", inf),
        ("young_modulus", 0.0),
        ("young_modulus", nan),
        ("poisson_ratio", 0.5),
        ("poisson_ratio", -0.1),
        ("poisson_ratio", nan),
        ("density", 0.0),
        ("density", inf),
        ("prestress_x", -1.0),
        ("prestress_y", nan),
        ("loss_factor", -0.1),
        ("loss_frequency", 0.0),
        ("tensile_strength", 0.0),
        ("tensile_strength", nan),
    ],
)
def test_an_impossible_value_is_refused_with_its_key(key: str, value: object) -> None:
    with pytest.raises(InputError, match=key):
        Layer(**{**GOOD, key: value})


def test_a_poisson_ratio_of_a_half_is_refused_with_advice() -> None:
    with pytest.raises(InputError, match=r"layer 'dermis': poisson_ratio.*below 0\.5, got 0\.5; use 0\.499"):
        Layer(**{**GOOD, "poisson_ratio": 0.5})


def test_elastic_constants_follow_from_modulus_and_poisson_ratio() -> None:
    layer = Layer(**{**GOOD, "poisson_ratio": 0.25})
    assert layer.shear_modulus == pytest.approx(4e4, rel=1e-14)  # E/2.5; tolerance: rounding of one division
    assert layer.lame_lambda == pytest.approx(4e4, rel=1e-14)  # equal to the shear modulus at nu = 1/4


def test_retardation_time_is_the_loss_factor_over_the_angular_frequency() -> None:
    layer = Layer(**GOOD, loss_factor=0.14, loss_frequency=50.0)
    assert layer.retardation_time == pytest.approx(4.4563384e-4, rel=1e-7)  # tolerance: digits written here


def test_a_tissue_needs_a_layer() -> None:
    with pytest.raises(InputError, match="at least one layer"):
        Tissue(layers=())


def test_layers_of_a_tissue_have_different_names() -> None:
    with pytest.raises(InputError, match="every name once"):
        Tissue(layers=(Layer(**GOOD), Layer(**GOOD)))


def test_layers_are_found_by_name_and_the_top_one_without() -> None:
    tissue = Tissue(layers=(Layer(**{**GOOD, "name": "epidermis"}), Layer(**GOOD)))
    assert tissue.index(None) == 0
    assert tissue.index("dermis") == 1
    assert tissue.thickness == pytest.approx(2e-3, rel=1e-14)  # tolerance: rounding of one sum
    with pytest.raises(InputError, match="one of epidermis, dermis, got 'fat'"):
        tissue.index("fat")
