"""Ways of tips as poses of handles."""

import numpy as np
import pytest

from trocar.contact.instrument import default_instruments
from trocar.errors import InputError
from trocar.simulation import HANDLE, JAW, PRESENT, ROLL, line, poses_along

PAIR = default_instruments((0.06, 0.06), 0.011)


def test_handles_are_where_the_tips_ask_for():
    way = line((0.02, 0.03, 0.004), (0.04, 0.02, -0.001), 5)
    poses = poses_along(PAIR, (way, None), jaws=(np.linspace(1, 0, 5), 1.0), rolls=(0.2, 0.0))
    for place, pose in zip(way, poses[:, 0], strict=True):
        assert PAIR[0].reach_of(pose[HANDLE : HANDLE + 3].tolist()).tip == pytest.approx(place, abs=1e-15)
    assert poses[:, 0, JAW].tolist() == [1, 0.75, 0.5, 0.25, 0]
    assert (poses[:, 0, ROLL] == 0.2).all()
    assert poses[:, 0, PRESENT].all()
    assert not poses[:, 1].any()


@pytest.mark.parametrize(
    ("tips", "words"),
    [
        ((None, None), "paths of the same length"),
        ((np.zeros((2, 3)), np.zeros((3, 3))), "paths of the same length"),
        ((np.full((2, 3), 0.5), None), "places within"),
        ((np.full((2, 3), np.nan), None), "places within"),
    ],
)
def test_ways_that_no_tip_can_go_are_refused(tips, words):
    with pytest.raises(InputError, match=words):
        poses_along(PAIR, tips)
