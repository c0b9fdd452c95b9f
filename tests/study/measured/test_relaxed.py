"""Holds made with a series are foretold by it, whatever the ramp and the size."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from measured_sets import measured_folder
from trocar.study.measured.relaxation import FOLDER, Hold, read_holds
from trocar.study.measured.relaxed import FITTED, JUDGED, foretell_holds, responses

WEIGHTS, TIMES, POWER = np.array([2.0, 0.8]), np.array([0.3, 4.0]), 1.6


def hold(session: str, *, ramp: float, size: float) -> Hold:
    time = np.arange(0.0, ramp + 10.0, 0.1)
    bare = Hold(
        session=session, name="FF1", time=time, force=time, indentation=size * np.minimum(time / ramp, 1.0)
    )
    (force,) = responses([bare], WEIGHTS, TIMES, POWER)
    return Hold(session=session, name="FF1", time=time, force=force, indentation=bare.indentation)


def test_a_step_relaxes_as_the_series_says() -> None:
    time = np.array([0.0, 1e-6, 1.0, 3.0])
    step = Hold(session="", name="", time=time, force=time, indentation=np.array([0.0, 1.0, 1.0, 1.0]))
    (force,) = responses([step], WEIGHTS, TIMES, POWER)
    expected = [1 + WEIGHTS @ np.exp(-after / TIMES) for after in (0.0, 1.0, 3.0)]
    np.testing.assert_allclose(force[1:], expected, rtol=1e-5)  # the step takes a microsecond


def test_a_ramp_of_power_one_is_the_integral_of_the_series() -> None:
    time = np.linspace(0.0, 2.0, 9)
    ramp = Hold(session="", name="", time=time, force=time, indentation=time)
    (force,) = responses([ramp], WEIGHTS, TIMES, 1.0)
    expected = time + ((WEIGHTS * TIMES) * -np.expm1(-time[:, None] / TIMES)).sum(axis=1)
    np.testing.assert_allclose(force, expected, rtol=1e-12)


def test_the_other_session_is_foretold() -> None:
    holds = [
        *(hold(FITTED, ramp=ramp, size=size) for ramp, size in ((2.0, 1e-3), (4.0, 3e-3))),
        hold(JUDGED, ramp=7.0, size=2e-3),
    ]
    found = foretell_holds(holds)
    assert found is not None
    # three terms fitted to a curve made with two, long-term share and power hardly told apart in ten seconds
    assert found.judged < 5e-3
    assert found.counts == (2, 1)
    assert foretell_holds(holds[:2]) is None
    brief = replace(
        holds[2], **{key: getattr(holds[2], key)[:120] for key in ("time", "force", "indentation")}
    )
    assert foretell_holds([*holds[:2], brief]) is None  # it was let go five seconds after its peak


def test_real_holds_are_foretold_within_their_spread() -> None:
    found = foretell_holds(read_holds(measured_folder() / FOLDER))
    assert found is not None
    assert (np.abs(found.foretold - found.measured) < found.spread).all()
    assert found.judged < found.mean_curve
