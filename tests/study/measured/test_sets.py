"""A folder of sets is read in SI; what is missing is told, what is broken is refused."""

from __future__ import annotations

import numpy as np
import pytest

from measured_sets import measured_folder, write_disc, write_holds, write_limbs, write_strip
from trocar.errors import InputError
from trocar.study.measured.phantom import thinner
from trocar.study.measured.sets import read_sets

STRAIN = np.linspace(0, 0.667, 20)
LIMB = {
    "probe_area_mm2": 360, "SubID": "006", "Location": "LA_A", "BMI": 27, "MaxForce": 4, "TotalStrain": 0.2,
    "Thickness": 20, "Skin": 2, "Fat": 4, "Muscle": 14,
}  # fmt: skip


def test_discs_are_read_in_si_and_in_order(tmp_path):
    for name in ("EF30_0T_A1", "EF10_100T_A1", "EF10_12_5T_B1", "EF10_12_5T_A1"):
        write_disc(tmp_path, name, strain=STRAIN, load=100 * STRAIN)
    sets = read_sets(tmp_path)
    names = [(disc.composition, disc.specimen) for disc in sets.phantoms]
    assert names == [("EF10_12_5T", "A"), ("EF10_12_5T", "B"), ("EF10_100T", "A"), ("EF30_0T", "A")]
    assert thinner("EF10_12_5T") == 12.5
    disc = sets.phantoms[0]
    assert (disc.diameter, disc.height) == (0.05, 0.03)
    np.testing.assert_allclose(disc.strain, STRAIN, atol=1e-7)  # six decimals of a millimetre
    assert disc.area == pytest.approx(np.pi * 0.025**2)
    assert len(sets.missing) == 5
    assert "Limbs are left out: there is no folder multis_limb_indentation_mit in" in sets.missing[0]


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("Cylinder Height: 30mm", "Cylinder Height: 3omm", r"line 3, Cylinder Height: expected a length above 0 mm"),
        ("Cylinder Height: 30mm", "Height: 30mm", r"expected a line 'Cylinder Height: ... mm' above the head"),
        ("0.100,", "0.000,", r"A1.csv, line 6, Time \(s\): expected a number above 0.000"),
    ],
)  # fmt: skip
def test_a_broken_disc_is_refused(tmp_path, old, new, said):
    path = write_disc(tmp_path, "EF10_0T_A1", strain=STRAIN, load=STRAIN)
    path.write_text(path.read_text().replace(old, new))
    with pytest.raises(InputError, match=said):
        read_sets(tmp_path)


def test_a_disc_without_a_name_is_refused(tmp_path):
    write_disc(tmp_path, "disc7", strain=STRAIN, load=STRAIN)
    with pytest.raises(InputError, match=r"disc7.csv: expected a name such as EF10_50T_A1.csv"):
        read_sets(tmp_path)


def test_a_disc_that_is_hardly_pressed_is_refused(tmp_path):
    write_disc(tmp_path, "EF10_0T_A1", strain=0.5 * STRAIN, load=STRAIN)
    with pytest.raises(
        InputError, match=r"expected a compression that reaches 66 % of the height, got '33.4 %'"
    ):
        read_sets(tmp_path)


def test_what_never_pulls_or_presses_is_refused(tmp_path):
    stretch = np.linspace(1, 2, 21)
    write_strip(tmp_path / "strips", "pig04_skin", stretch, 1 - stretch)
    with pytest.raises(InputError, match=r"10 rows or more up to the largest stress"):
        read_sets(tmp_path / "strips")
    table = np.column_stack([np.arange(12.0), -np.ones(12), np.ones(12)])
    write_holds(tmp_path / "holds", {("230407", "FF1"): table})
    with pytest.raises(InputError, match=r"line 2, test FF1: expected a force above 0 somewhere, got -1.0"):
        read_sets(tmp_path / "holds")


def test_limbs_are_read_in_si_and_gaps_are_counted(tmp_path):
    write_limbs(tmp_path, [LIMB, {**LIMB, "SubID": "007", "Skin": ""}, {**LIMB, "SubID": "008"}])
    limbs = read_sets(tmp_path).limbs
    assert limbs is not None
    assert (limbs.subjects, limbs.incomplete) == (("006", "008"), 1)
    np.testing.assert_allclose(limbs.thickness[0], [2e-3, 4e-3, 14e-3])
    np.testing.assert_allclose([limbs.indentation[0], limbs.area[0], limbs.strain[0]], [4e-3, 360e-6, 0.2])
    write_limbs(tmp_path, [LIMB, {**LIMB, "MaxForce": -1}])
    with pytest.raises(InputError, match=r"line 3, MaxForce: expected a number above 0, got '-1'"):
        read_sets(tmp_path)


def test_a_strip_ends_at_its_largest_force(tmp_path):
    stretch = np.linspace(1, 2, 21)
    write_strip(tmp_path, "pig04_vaginal_mucosa", stretch, np.minimum(stretch - 1, 1.5 * (2 - stretch)))
    (strip,) = read_sets(tmp_path).strips
    assert (strip.animal, strip.tissue) == ("pig04", "vaginal mucosa")
    assert strip.stretch[-1] == pytest.approx(1.6)
    assert strip.stress.max() == pytest.approx(600.0)


def test_holds_are_told_apart_and_time_rises_in_each(tmp_path):
    table = np.column_stack([np.arange(6.0), np.ones(6), np.ones(6)])
    path = write_holds(tmp_path, {("230407", "FF1"): table, ("230411", "FF1"): table})
    holds = read_sets(tmp_path).holds
    assert [(hold.session, hold.name, len(hold.time)) for hold in holds] == [
        ("230407", "FF1", 6), ("230411", "FF1", 6),
    ]  # fmt: skip
    path.write_text(path.read_text().replace("230411,FF1,3.0000", "230411,FF1,2.0000"))
    with pytest.raises(InputError, match=r"line 11, time_s: expected a time above 2 s"):
        read_sets(tmp_path)


def test_a_folder_without_a_set_is_refused(tmp_path):
    with pytest.raises(InputError, match=r"expected at least one sub-folder such as ecoflex"):
        read_sets(tmp_path)
    with pytest.raises(InputError, match=r"expected a folder of measured sets, got 'no such folder'"):
        read_sets(tmp_path / "nowhere")


def test_the_real_sets_are_read_whole():
    sets = read_sets(measured_folder())
    assert sets.missing == ()
    assert sets.limbs is not None
    assert sets.rubber is not None
    counts = (
        len(sets.phantoms),
        len(sets.limbs.force),
        sets.limbs.incomplete,
        len(sets.strips),
        len(sets.holds),
    )
    assert counts == (38, 752, 8, 25, 149)
    assert (len(sets.pulls), len(sets.rubber.stretch), len(sets.rubber.stretches)) == (19, 24, 117)
    assert all(disc.load.max() > 50 for disc in sets.phantoms)
