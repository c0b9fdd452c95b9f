"""How near to a line a snip goes, by hand."""

from math import isnan

import numpy as np
import pytest

from trocar.simulation import CUT, RECORD, TOUCH
from trocar.training.line import Line
from trocar.training.metrics.attempt import Attempt
from trocar.training.metrics.cuts import cut_deviation, cut_deviation_most, cut_share, snips

STRAIGHT = Line(points=tuple((1e-3 * k, 0.0) for k in range(11)), width=5e-4)


def test_a_snip_passes_what_lies_beside_it():
    snip = ((2.1e-3, 4e-4), (4.8e-3, -4e-4))
    assert [n for n in range(11) if STRAIGHT.passes(snip, n)] == [3, 4]  # 2.6 mm to 4.3 mm
    assert not any(STRAIGHT.passes(((2e-3, 6e-4), (5e-3, 6e-4)), n) for n in range(11))
    assert not any(STRAIGHT.passes(((3e-3, 0.0), (3e-3, 0.0)), n) for n in range(11))


def test_snips_that_pass_all_points_leave_no_gap():
    together = set()
    for end, begin in np.random.default_rng(5).uniform(2e-3, 8e-3, (400, 2)):
        cut = [((-1e-3, 0.0), (end, 0.0)), ((begin, 0.0), (11e-3, 0.0))]
        if all(any(STRAIGHT.passes(snip, n) for snip in cut) for n in range(11)):
            together.add(begin < end)
    assert together == {True}


def test_distances_are_those_of_a_slant():
    away = STRAIGHT.distances(((0.0, 0.0), (4e-3, 3e-3)))
    assert away == pytest.approx(np.linspace(0, 3e-3, len(away)), abs=1e-12)
    assert STRAIGHT.farthest(((0.0, 0.0), (4e-3, 3e-3))) == pytest.approx(3e-3)
    assert STRAIGHT.farthest(((-4e-3, 3e-3), (-4e-3, 3e-3))) == pytest.approx(5e-3)


def attempt(*told, line=STRAIGHT):
    """Return an attempt whose right hand's records tell these, 100 ticks each."""
    records = np.zeros((100 * len(told), 2, RECORD))
    records[:, :, TOUCH] = 1
    records[:, 1, CUT : CUT + 5] = np.repeat(told, 100, axis=0)
    return Attempt(times=1e-3 * np.arange(1, len(records) + 1), records=records, line=line)


def test_what_was_cut_is_told_once_and_air_is_not():
    first, second = (3, 0.0, 1e-4, 5e-3, 1e-4), (2, 5e-3, 0.0, 7e-3, 3e-4)
    again = (0, 5e-3, 4e-3, 7e-3, 4e-3)  # blades that found only what was cut before
    found = attempt((0,) * 5, first, (0,) * 5, second, again)
    assert snips(found) == [((0.0, 1e-4), (5e-3, 1e-4)), ((5e-3, 0.0), (7e-3, 3e-4))]
    assert cut_deviation_most(found) == pytest.approx(3e-4)
    assert 1e-4 < cut_deviation(found) < 1.5e-4
    assert cut_share(found) == pytest.approx(5 / 11)


def test_where_nothing_is_to_be_cut_there_is_no_deviation():
    for found in (attempt((0,) * 5, line=None), attempt((0,) * 5)):
        assert np.isnan([cut_deviation(found), cut_deviation_most(found)]).all()
    assert cut_share(attempt((0,) * 5)) == 0.0
    assert isnan(cut_share(attempt((0,) * 5, line=None)))
