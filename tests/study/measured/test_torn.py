"""Strips made with a law are foretold by it; animals that differ by a factor leave just that."""

from __future__ import annotations

import numpy as np
import pytest

from measured_sets import measured_folder
from trocar.study.measured.homogeneous import uniaxial
from trocar.study.measured.strips import FOLDER, Strip, read_strips
from trocar.study.measured.torn import FITTED, JUDGED, foretell_strips
from trocar.tissues.law import Ogden

STRETCH = np.linspace(1.0, 1.4, 60)
SKIN = uniaxial(Ogden(terms=((1.0, 8.0),)), 3e4, STRETCH)


def strip(animal: str, factor: float) -> Strip:
    return Strip(animal=animal, tissue="skin", stretch=STRETCH, stress=factor * SKIN)


def test_the_geometric_mean_of_the_animals_is_fitted_and_the_last_is_judged() -> None:
    strips = [*(strip(animal, factor) for animal, factor in zip(FITTED, (0.5, 2.0, 1.0, 1.0), strict=True))]
    (found,) = foretell_strips([*strips, strip(JUDGED, 1.25)])
    assert found.limit == pytest.approx(1.4)
    # made with the law that is fitted: the difference is the judged animal's own factor, 1 - 1/1.25
    assert found.errors["Ogden"] == pytest.approx(0.2, rel=1e-3)
    assert found.errors["mean of the others"] == pytest.approx(0.2, rel=1e-3)
    assert found.errors["fibre"] < 0.3
    assert foretell_strips(strips) == ()


def test_real_strips_are_foretold_as_well_as_their_mean() -> None:
    found = foretell_strips(read_strips(measured_folder() / FOLDER))
    assert len(found) == 5
    for tissue in found:
        # a law of two or three numbers follows the mean; what is left is the animal
        assert tissue.errors["Ogden"] < tissue.errors["mean of the others"] + 0.03
