"""A grade pressed in one laboratory is put beside the same grade pulled in another."""

from __future__ import annotations

import numpy as np
import pytest

from measured_sets import measured_folder, rough_platens, write_disc, write_pull
from trocar.study.measured import pressed
from trocar.study.measured.elastomer import FOLDER, read_pulls
from trocar.study.measured.grades import compare_grades
from trocar.study.measured.pressed import foretell_phantoms
from trocar.study.measured.sets import read_sets

STRAIN = np.linspace(0, 0.667, 80)
STRETCH = np.linspace(1.0, 4.0, 60)
AREA = np.pi * 0.025**2


def test_both_moduli_of_a_grade_are_found(tmp_path, monkeypatch):
    monkeypatch.setattr(pressed, "platens", rough_platens)
    load = 1.6e4 * AREA * ((1 - STRAIN) ** -2 - (1 - STRAIN))
    for specimen in "AB":
        write_disc(tmp_path, f"EF10_0T_{specimen}1", strain=STRAIN, load=load)
        write_disc(tmp_path, f"EF10_50T_{specimen}1", strain=STRAIN, load=load)
    write_pull(tmp_path, "Ecoflex 00-10", STRETCH, 8e-3 * (STRETCH - STRETCH**-2))
    write_pull(tmp_path, "Ecoflex 00-30", STRETCH, 8e-3 * (STRETCH - STRETCH**-2))
    sets = read_sets(tmp_path)
    (grade,) = compare_grades(
        foretell_phantoms(sets.phantoms), sets.pulls
    )  # no other is in both without thinner
    assert grade.name == "Ecoflex 00-10"
    # six decimals of a millimetre and of a newton were written
    assert grade.free == pytest.approx(1.6e4, rel=1e-4)
    assert grade.bonded == pytest.approx(
        1.6e4 / 1.3, rel=1e-3
    )  # the rough table: a third above faces that slide
    assert grade.pulled == pytest.approx(8e3, rel=1e-4)


def test_real_silicones_in_tension_are_read_to_where_they_fail():
    pulls = {pull.material: pull for pull in read_pulls(measured_folder() / FOLDER)}
    assert len(pulls) == 19
    assert 5 < pulls["Ecoflex 00-30"].stretch.max() < 25
    assert 0.5e6 < pulls["Ecoflex 00-30"].stress.max() < 3e6
