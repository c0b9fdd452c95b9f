"""What a layer and a tissue accept as Prony series."""

import pytest

from trocar.errors import InputError
from trocar.tissues import Layer, Tissue

FAT = {"name": "fat", "thickness": 0.01, "young_modulus": 1e4, "poisson_ratio": 0.48, "density": 950.0}


def test_a_series_is_relative_to_the_long_term_modulus():
    layer = Layer(**FAT, prony=[[0.5, 2], (1.5, 0.01)])
    assert layer.prony == ((0.5, 2.0), (1.5, 0.01))
    assert layer.instantaneous_modulus == pytest.approx(3e4)
    assert layer.relaxing(2.0) == 0.5
    assert layer.relaxing(3.0) == 0


@pytest.mark.parametrize(
    ("prony", "message"),
    [
        (
            [(-0.1, 1.0)],
            "g: expected a number from 0 to 1000, got -0.1; g is relative to the long-term modulus",
        ),
        ([(float("nan"), 1.0)], "got nan"),
        ([(0.1, 0.0)], "tau: expected a time from 1e-05 to 100000 s, got 0.0"),
        ([(0.1, float("inf"))], "got inf"),
        ([(0.1, 1.0), (0.2, 1.0)], "every tau once"),
        ([(0.1, 1.0 + i) for i in range(9)], "at most 8 terms, got 9"),
        ([0.1, 1.0], "pairs of numbers"),
        ([(0.1, "slow")], "pairs of numbers"),
        (3, "pairs of numbers"),
    ],
)
def test_what_no_series_can_be_is_refused(prony, message):
    with pytest.raises(InputError, match=f"layer 'fat': prony.*{message}"):
        Layer(**FAT, prony=prony)


def test_layers_share_their_times_or_are_too_many():
    def layers(*series):
        return tuple(Layer(**(FAT | {"name": f"layer {i}"}), prony=own) for i, own in enumerate(series))

    shared = Tissue(layers=layers([(0.1, 3.0), (0.0, 7.0)], [(0.4, 3.0), (0.2, 0.1)]))
    assert shared.relaxation_times == (0.1, 3.0)
    with pytest.raises(InputError, match=r"at most 8 different times .* got 10; let layers share"):
        Tissue(layers=layers([(0.1, 1.0 + i) for i in range(5)], [(0.1, 1.5 + i) for i in range(5)]))
