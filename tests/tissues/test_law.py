"""Laws of layers: what they accept, and that a block is linear as a whole or not at all."""

from __future__ import annotations

from dataclasses import replace
from math import inf, nan, pi

import pytest

from trocar.errors import InputError
from trocar.tissues import Fibre, Layer, Linear, NeoHookean, Ogden, Tissue

PAD = Layer(name="pad", thickness=0.01, young_modulus=1e4, poisson_ratio=0.45, density=1e3)


@pytest.mark.parametrize(
    ("terms", "expected"),
    [
        ((), "1 to 6 terms"),
        (((0.1, 2.0),) * 7, "1 to 6 terms"),
        (((0.0, 2.0), (1.0, 3.0)), "share a finite number above 0, got 0.0"),
        (((-0.2, 2.0), (1.2, 3.0)), "share a finite number above 0, got -0.2"),
        (((nan, 2.0),), "got nan"),
        (((1.0, 0.0),), "alpha from 0.01 to 50 in size, either sign, got 0.0"),
        (((1.0, inf),), "got inf"),
        (((1.0, -51.0),), "got -51.0"),
        (((0.5, 2.0), (0.4, 3.0)), "add up to 1, got 0.9; divide each by their sum"),
    ],
)
def test_impossible_ogden_terms_are_refused(terms: tuple[tuple[float, float], ...], expected: str) -> None:
    with pytest.raises(InputError, match=expected):
        Ogden(terms=terms)


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("k1", -1.0),
        ("k1", nan),
        ("k2", -1.0),
        ("k2", inf),
        ("dispersion", 0.34),
        ("dispersion", -0.1),
        ("angle", -0.1),
        ("angle", pi),
    ],
)
def test_impossible_fibres_are_refused(key: str, value: float) -> None:
    with pytest.raises(InputError, match=f"fibre: {key}"):
        Fibre(**({"k1": 1e4, "k2": 1.0} | {key: value}))


def test_a_layer_is_linear_unless_it_says_otherwise() -> None:
    assert Linear() == PAD.law
    assert not Tissue(layers=(PAD,)).large_deformation


def test_linear_layers_do_not_mix_with_others() -> None:
    other = replace(PAD, name="other", law=NeoHookean())
    with pytest.raises(InputError, match=r"every layer linear or none.*linear pad beside others"):
        Tissue(layers=(PAD, other))
    both = Tissue(layers=(other, replace(PAD, law=Ogden(terms=((1.0, 3.0),)))))
    assert both.large_deformation
    assert all(layer.law == Linear() for layer in both.linearised.layers)


def test_the_bulk_modulus_is_the_others() -> None:
    assert PAD.bulk_modulus == pytest.approx(PAD.lame_lambda + 2 / 3 * PAD.shear_modulus)
