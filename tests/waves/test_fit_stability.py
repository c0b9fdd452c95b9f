"""A fitted membrane never grows."""

import numpy as np
import pytest

from trocar.model import Support
from trocar.tissues.catalogue import tissue
from trocar.waves.membrane import WaveMembrane


@pytest.mark.parametrize("support", list(Support))
@pytest.mark.parametrize("name", ["skin", "liver", "stomach-wall", "uterus", "silicone-pad"])
def test_every_mode_of_a_fitted_preset_decays(name, support):
    layers = tissue(name)
    model = WaveMembrane.fitted(layers, size=(0.06, 0.06), support=support, modes=(24, 24))
    assert np.linalg.eigvals(model.oscillators.matrices).real.max() < 0
    slowest = max(layer.retardation_time for layer in layers.layers)
    times = [part.retardation_time for part in (*model.stack.sheets, *model.stack.couplings)]
    assert max(times) <= 10 * slowest * (1 + 1e-9)  # the fit's bound, rounding of the scaling
