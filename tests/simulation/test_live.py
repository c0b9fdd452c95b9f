"""The tissues of live scenes: what is kept of a fit is what the fit finds."""

from dataclasses import replace

import numpy as np
import pytest

from trocar.model import Support
from trocar.simulation.live import LIVE_SIZE, live_model
from trocar.simulation.live_fits import FITS
from trocar.tissues.catalogue import tissue
from trocar.training.tasks.catalogue import TASKS, task
from trocar.waves.membrane import WaveMembrane

AGREED = 1e-6  # a fit ends where rounding says, to about 1e-7 of a force; processors round differently


def test_every_task_is_done_on_a_tissue_whose_coefficients_are_kept():
    tasks = [task(name, level) for name in TASKS for level in (1, 2, 3)]
    assert {one.tissue for one in tasks if one.sheet is None and one.organ is None} <= set(FITS)


@pytest.mark.parametrize("name", FITS)
def test_what_is_kept_moves_as_what_is_fitted(name):
    """After an edit of a preset this fails: bench/live_fits.py prints the new coefficients."""
    kept = live_model(tissue(name))
    fitted = WaveMembrane.fitted(tissue(name), size=LIVE_SIZE, support=Support.BASE, modes=kept.modes)
    found = fitted.wave_compliance  # of many waves; a press feels their sum, so the largest is the measure
    np.testing.assert_allclose(kept.wave_compliance, found, rtol=AGREED, atol=AGREED * np.abs(found).max())
    for one, other in zip(kept.stack.sheets, fitted.stack.sheets, strict=True):
        assert one.areal_density == pytest.approx(other.areal_density, rel=AGREED)
        assert one.retardation_time == pytest.approx(other.retardation_time, rel=AGREED)
    for one, other in zip(kept.stack.couplings, fitted.stack.couplings, strict=True):
        assert one.retardation_time == pytest.approx(other.retardation_time, rel=AGREED)


def test_another_tissue_of_that_name_or_another_block_is_fitted():
    skin = tissue("skin")
    softer = replace(
        skin, layers=(*skin.layers[:-1], replace(skin.layers[-1], thickness=1.5 * skin.layers[-1].thickness))
    )
    assert live_model(skin).stack == FITS["skin"].stack
    assert live_model(softer).stack != FITS["skin"].stack
    assert live_model(skin, size=(0.05, 0.06)).stack != FITS["skin"].stack
