"""Latency is measured on real frames and adds up; how long it is, is for bench/ to say."""

import numpy as np
import pytest

from trocar.errors import TrocarError
from trocar.web import latency
from trocar.web.latency import TimedSource, stream_latency
from web.scripted_source import ScriptedSource


def test_a_measurement_on_loopback_adds_up(monkeypatch):
    monkeypatch.setattr(latency, "_WARM_UP", 0.1)
    found = stream_latency(ScriptedSource(grid=(8, 8)), seconds=0.5)
    assert found.total.size > 10
    for part in (found.inward, found.wait, found.outward):
        assert part.shape == found.total.shape
        assert np.all(part > 0)
    # Differences of times that differ by far less than a day: float64 resolves them to 1e-11 s.
    np.testing.assert_allclose(found.inward + found.wait + found.outward, found.total, atol=1e-9)


def test_a_pose_that_no_frame_shows_counts_with_the_next_that_is_shown():
    timed = TimedSource(ScriptedSource())
    timed.taken = {1: 2.1, 2: 2.2, 3: 2.3, 4: 9.9}
    timed.shown = {0: 1.0, 2: 2.25, 3: 2.4}
    found = latency._evaluated(
        timed, {0: 0.5, 1: 2.0, 2: 2.15, 3: 2.2, 4: 9.8}, {0: 1.1, 2: 2.5, 3: 2.6}, frame_period=0.01
    )
    np.testing.assert_allclose(found.total, [0.5, 0.35, 0.4], atol=1e-12)
    np.testing.assert_allclose(found.wait, [0.15, 0.05, 0.1], atol=1e-12)


def test_a_stream_that_shows_no_pose_is_said_so():
    with pytest.raises(TrocarError, match="no pose came back"):
        latency._evaluated(TimedSource(ScriptedSource()), {}, {}, frame_period=0.01)
