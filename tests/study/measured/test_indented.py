"""Limbs made of layers are foretold by layers; what only the site knows is left to the regression."""

from __future__ import annotations

import numpy as np
import pytest

from measured_sets import measured_folder
from trocar.study.measured.indented import POISSON, PUBLISHED, foretell_limbs
from trocar.study.measured.limbs import FOLDER, Indentations, read_limbs
from trocar.study.measured.stacked import punch_compliance

MODULI = np.array([3e4, 3e3, 8e3])


def made(*, steepness: float = 0.0, spread: float = 0.0) -> Indentations:
    random = np.random.default_rng(5)
    count = 96
    thickness = np.exp(random.normal(np.log([1.5e-3, 6e-3, 2.5e-2]), 0.3, (count, 3)))
    indentation = random.uniform(0.1, 0.3, count) * thickness.sum(axis=1)
    area = np.where(random.random(count) < 0.5, 360e-6, 675e-6)
    bent = steepness * indentation / thickness.sum(axis=1)
    bend = np.expm1(bent) / bent if steepness else 1.0
    force = indentation / punch_compliance(thickness, MODULI, POISSON, np.sqrt(area / np.pi)) * bend
    return Indentations(
        subjects=tuple(f"{row // 8:03}" for row in range(count)),
        sites=tuple(f"S{row % 8}" for row in range(count)),
        force=force * np.exp(spread * random.normal(size=count)),
        area=area,
        thickness=thickness,
        indentation=indentation,
        incomplete=0,
    )


def test_linear_layers_are_found() -> None:
    found = foretell_limbs(made())
    # exact forces: what is left is where the search stops
    assert found.linear.median < 1e-3
    assert found.shear_moduli == pytest.approx(tuple(MODULI), rel=1e-2)
    assert abs(found.steepness) < 0.05
    assert found.people == (6, 6)
    assert len({person for person, kept in zip(found.limbs.subjects, found.judged, strict=True) if kept}) == 6


def test_layers_that_stiffen_are_found() -> None:
    found = foretell_limbs(made(steepness=4.0))
    assert found.steepness == pytest.approx(4.0, rel=0.02)
    assert found.exponential.median < 5e-3
    assert found.linear.median > 5 * found.exponential.median


def test_noise_is_what_is_left() -> None:
    found = foretell_limbs(made(spread=0.3))
    # the median of |exp(0.3 n) - 1| of a standard normal n is about 0.2; of 48 trials it is known to a quarter
    assert found.linear.median == pytest.approx(0.2, rel=0.4)


def test_real_limbs_are_foretold_as_documented() -> None:
    found = foretell_limbs(read_limbs(measured_folder() / FOLDER))
    by_name = {way.name: way.median for way in found.baselines}
    assert found.people == (48, 47)
    assert 0.25 < found.linear.median < 0.35
    assert found.exponential.median < found.linear.median
    assert (
        by_name["regression that knows site and person"] > PUBLISHED / 2
    )  # out of reach for what knows less
