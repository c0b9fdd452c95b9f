"""A fitted tissue as a file."""

import pytest

from pressed_pads import blank, filled, pad, softer, triangle
from trocar.errors import InputError
from trocar.study.calibration.calibration import calibrate
from trocar.study.calibration.tissue_file import check_tissue_file, write_tissue_file
from trocar.tissues import catalogue
from trocar.tissues.record import Setting, Status

NAMES = ("body.young_modulus",)


def fitted(case, names=NAMES):
    record = filled(blank(*triangle(rows=81)), case, softer(case, 1.3), noise=2e-6)
    return calibrate(record, case, names)


def test_it_is_a_tissue_that_says_where_each_value_is_from(tmp_path):
    done = fitted(pad(prestress_x=2e3, prestress_y=1e3))
    write_tissue_file(tmp_path / "mine.toml", done, Setting.EX_VIVO)
    write_tissue_file(tmp_path / "mine.toml", done, Setting.EX_VIVO)  # an earlier one is replaced
    record = catalogue.record(str(tmp_path / "mine.toml"))
    modulus = record.layer("body")["young_modulus"]
    estimate = done.known.estimates[0]
    assert modulus.si == pytest.approx(estimate.value, rel=1e-5)  # six digits are written
    assert modulus.spread == pytest.approx((estimate.low / 1e3, estimate.high / 1e3), rel=1e-5)
    assert (modulus.status, modulus.method.setting) == (Status.DERIVED, Setting.EX_VIVO)
    assert "pad.csv" in modulus.source
    kept = record.layer("skin")["young_modulus"]
    assert (kept.status, kept.si) == (Status.CHOSEN, 6e4)
    made = record.tissue().layers
    assert (made[0].prestress_x, made[0].prestress_y) == (2e3, 1e3)
    assert made[1].loss_factor == 0.2
    assert "The data tell body.young_modulus" in record.why


def test_what_it_remembers_is_read_back(tmp_path):
    case = pad(prony=((0.5, 0.4), (0.2, 3.0)))
    done = fitted(case, ("body.young_modulus", "body.prony[0].g"))
    write_tissue_file(tmp_path / "mine.toml", done, Setting.MATERIAL)
    read = catalogue.record(str(tmp_path / "mine.toml")).layer("body").memory
    (g, tau), second = read.prony
    assert g == pytest.approx(done.known.estimates[1].value, rel=1e-4)  # five digits are written
    assert (tau, second) == (0.4, (0.2, 3.0))
    assert read.status is Status.DERIVED
    assert "prony[0].g: within" in read.reason


def test_what_is_no_place_for_it_is_refused(tmp_path):
    other = tmp_path / "case.toml"
    other.write_text("title = 'a case'")
    for place, names, words in (
        (tmp_path / "mine.txt", NAMES, "ends with .toml"),
        (other, NAMES, "another file"),
        (tmp_path / "new.toml", ("skin.tension",), "parameters of layers"),
    ):
        with pytest.raises(InputError, match=words):
            check_tissue_file(place, names)
    assert other.read_text() == "title = 'a case'"
