"""Cases made in code: the load history, when to look, and what is refused."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest

from trocar.errors import InputError
from trocar.model import Support
from trocar.study.cases.reading import Case, Sampling, Tool, case_from_tissue
from trocar.tissues import Layer, Tissue

TISSUE = Tissue(
    layers=(Layer(name="pad", thickness=0.01, young_modulus=1e4, poisson_ratio=0.45, density=1000.0),),
    name="pad",
)
SLOW = Tool(diameter=0.008, position=(0.02, 0.02), peak=1.0, rate=0.5, hold=1.0)
FAST = Tool(diameter=0.006, position=(0.04, 0.03), peak=0.3, rate=0.1)


def pair(**changes: object) -> Case:
    return replace(case_from_tissue(tissue=TISSUE, size=(0.06, 0.05), tools=(SLOW, FAST)), **changes)


@pytest.mark.parametrize(
    ("time", "forces"),
    [
        (-1, (0, 0)),
        (0, (0, 0)),
        (1, (0.5, 0.1)),
        (2, (1, 0.2)),
        (2.5, (1, 0.25)),
        (3, (1, 0.3)),
        (4, (0.5, 0.2)),
        (5, (0, 0.1)),
        (6, (0, 0)),
        (1e9, (0, 0)),
    ],
)
def test_force_goes_up_holds_comes_down_and_stays_away(time, forces):
    load = pair().load_at(time)
    # three roundings: of the rate, the product and the difference
    assert [press.force for press in load] == pytest.approx(forces, rel=1e-15, abs=1e-15)
    assert [press.x for press in load] == [0.02, 0.04]


def test_corners_of_both_tools_once():
    assert pair().corners() == pytest.approx([0, 2, 3, 5, 6], rel=1e-15)  # 0.3 / 0.1 is one rounding below 3


def test_samples_are_multiples_corners_and_the_end():
    case = pair(sampling=Sampling(period=1.5))
    assert case.sample_times() == pytest.approx([0, 1.5, 2, 3, 4.5, 5, 6], rel=1e-15)
    assert np.all(np.isin(case.corners(), case.sample_times()))
    assert case.sample_times()[-1] == case.duration


def test_period_longer_than_the_load_leaves_the_corners():
    case = pair(sampling=Sampling(period=100.0))
    assert np.array_equal(case.sample_times(), case.corners())


def test_load_at_refuses_no_time():
    with pytest.raises(InputError, match="finite"):
        pair().load_at(float("nan"))


def test_tilted_footprint_reaches_further_along_its_azimuth():
    tool = replace(SLOW, tilt=pi / 3, azimuth=0.0)
    assert tool.half_extent == pytest.approx((0.008, 0.004), rel=1e-14)  # cos(pi/3) is 0.5 to one rounding
    turned = replace(tool, azimuth=pi / 2)
    assert turned.half_extent == pytest.approx((0.004, 0.008), rel=1e-14)


def test_case_from_tissue_takes_its_title_from_the_tissue():
    case = case_from_tissue(tissue=TISSUE, size=(0.06, 0.05), tools=(SLOW,), support="edges")
    assert case.title == "pad"
    assert case.support is Support.EDGES
    assert case.sampling == Sampling()


@pytest.mark.parametrize(
    ("changes", "where"),
    [
        ({"support": "side"}, "block.support"),
        ({"size": (0.06, 2.0)}, "block.size"),
        ({"tools": ()}, "tool"),
        ({"tools": (SLOW,) * 3}, "tool"),
        ({"tools": (SLOW, replace(FAST, position=(0.059, 0.02)))}, "tool[1].position"),
        ({"period": 1e-5}, "sampling.period"),
        ({"period": float("nan")}, "sampling: period"),
        ({"tissue": Tissue(layers=(replace(TISSUE.layers[0], density=1e5),))}, "layer[0].density"),
        ({"tissue": Tissue(layers=(replace(TISSUE.layers[0], prestress_y=1e12),))}, "layer[0].prestress"),
        (
            {
                "tissue": Tissue(
                    layers=(TISSUE.layers[0], replace(TISSUE.layers[0], name="film", thickness=1e-8))
                )
            },
            "layer[1].thickness",
        ),
    ],
    ids=str,
)
def test_impossible_cases_are_refused_in_code_too(changes, where):
    arguments = {"tissue": TISSUE, "size": (0.06, 0.05), "tools": (SLOW,)} | changes
    with pytest.raises(InputError) as caught:
        case_from_tissue(**arguments)
    assert caught.value.where == where


@pytest.mark.parametrize(
    ("changes", "where"),
    [
        ({"peak": 0.0}, "tool: peak"),
        ({"diameter": float("inf")}, "tool: diameter"),
        ({"tilt": pi / 2}, "tool: tilt"),
        ({"position": (-0.01, 0.0)}, "tool: position"),
        ({"rate": 1e-7}, "tool: rate"),
    ],
    ids=str,
)
def test_impossible_tools_are_refused_in_code_too(changes, where):
    with pytest.raises(InputError) as caught:
        replace(SLOW, **changes)
    assert caught.value.where == where
