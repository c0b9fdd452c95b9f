"""Instruments apart from their motion: the lever from both ends, the default pair, and what is refused."""

import pickle
from itertools import product
from math import acos, degrees, dist, inf, nan

import numpy as np
import pytest

from trocar.contact.instrument import (
    LARGEST_BLOCK,
    SMALLEST_BLOCK,
    THICKEST_BLOCK,
    Instrument,
    TipKind,
    default_instruments,
)
from trocar.errors import InputError

USUAL = {
    "name": "left",
    "port": (-0.05, -0.01, 0.1),
    "length": 0.31,
    "shaft_radius": 2.5e-3,
    "tip": "grasper",
    "handle": (-0.15, -0.08, 0.24),
}


def made(**changes):
    return Instrument(**{**USUAL, **changes})


def test_handle_and_tip_are_two_ends_of_one_lever():
    instrument = made()
    rng = np.random.default_rng(2)
    for tip in rng.uniform([0.0, 0.0, -0.01], [0.06, 0.06, 0.03], (50, 3)):
        handle = instrument.handle_for(tip)
        back = instrument.reach_of(handle)
        assert back.tip == pytest.approx(tip, abs=1e-15)  # rounding of coordinates of 0.3 m
        assert back.outside + dist(tip, instrument.port) == pytest.approx(instrument.length, rel=1e-14)
        assert np.cross(back.direction, np.subtract(tip, instrument.port)) == pytest.approx(
            np.zeros(3), abs=1e-15
        )


def test_it_travels_to_another_process_and_names_its_tip():
    instrument = pickle.loads(pickle.dumps(made()))
    assert instrument == made()
    assert instrument.tip is TipKind.GRASPER
    assert [kind.value for kind in TipKind if kind.has_jaw] == ["grasper", "needle-holder"]


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"name": "middle"}, "name: expected left or right"),
        ({"port": (0.0, nan, 0.1)}, "port: expected three finite coordinates"),
        ({"port": (0.0, 0.1)}, "port: expected three finite coordinates"),
        ({"length": 0.0}, "length"),
        ({"length": inf}, "length"),
        ({"shaft_radius": -1e-3}, "shaft_radius"),
        ({"shaft_radius": 0.011}, "at most 0.01 m"),
        ({"tip": "laser"}, "one of probe, grasper, needle-holder, hook"),
        ({"handle": USUAL["port"]}, "handle"),
        ({"handle": (-0.05, -0.01, 0.42)}, "it is 0.32 m away"),
        ({"handle": (0.0, 0.0, inf)}, "handle: expected three finite coordinates"),
    ],
)
def test_what_cannot_be_is_refused(changes, said):
    with pytest.raises(InputError, match=said):
        made(**changes)


@pytest.mark.parametrize("tip", [(-0.05, -0.01, 0.1), (0.3, 0.0, 0.0), (nan, 0.0, 0.0)])
def test_a_tip_that_the_shaft_cannot_bring_anywhere_is_refused(tip):
    with pytest.raises(InputError, match="left instrument: tip"):
        made().handle_for(tip)


@pytest.mark.parametrize("size", list(product((SMALLEST_BLOCK, 0.06, LARGEST_BLOCK), repeat=2)))
def test_the_default_pair_reaches_every_corner_of_the_block(size):
    for instrument in default_instruments(size):
        for x, y, z in product((0.0, size[0]), (0.0, size[1]), (0.0, -THICKEST_BLOCK)):
            handle = instrument.handle_for((x, y, z))
            assert instrument.reach_of(handle).outside > 0.02  # the handle itself has room outside


def test_the_default_pair_on_the_usual_block():
    left, right = default_instruments((0.06, 0.06), thickness=0.0136)
    assert (left.name, left.tip, right.name, right.tip) == ("left", "grasper", "right", "probe")
    assert left.port == pytest.approx((-0.05, -0.01, 0.1))
    assert right.port == pytest.approx((0.11, -0.01, 0.1))
    assert left.reach_of(left.handle).tip == pytest.approx((0.018, 0.03, 0.008))
    assert right.reach_of(right.handle).tip == pytest.approx((0.042, 0.03, 0.008))


def test_the_default_shafts_meet_over_the_middle_under_a_working_angle():
    left, right = default_instruments((0.06, 0.06))
    one, other = (np.subtract(i.port, (0.03, 0.03, 0.0)) for i in (left, right))
    angle = degrees(acos(one @ other / np.linalg.norm(one) / np.linalg.norm(other)))
    assert 45 <= angle <= 75  # the range that Hanna and others (1997) recommend


@pytest.mark.parametrize(
    ("size", "thickness", "said"),
    [
        ((0.019, 0.06), 0.0136, "size"),
        ((0.06, 0.21), 0.0136, "size"),
        ((0.06, nan), 0.0136, "size"),
        ((0.06, 0.06), 0.0, "thickness"),
        ((0.06, 0.06), 0.06, "thickness"),
    ],
)
def test_the_default_pair_says_which_blocks_it_is_for(size, thickness, said):
    with pytest.raises(InputError, match=f"default instruments: {said}"):
        default_instruments(size, thickness)
