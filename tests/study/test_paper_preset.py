"""The paper's formula to its printed digits, what the corrected one gives, and the files that say so."""

import json
from math import pi, sqrt

import numpy as np
import pytest
import xarray as xr

from small_study import LEDGER
from trocar.study.paper_preset import run_paper_study
from trocar.study.report.paper_page import paper_table
from trocar.study.writing.folder import is_study
from trocar.study.writing.paper_results import write_paper_study


@pytest.fixture(scope="module")
def paper_study():
    return run_paper_study()


def test_the_printed_digits(paper_study):
    printed = paper_study.printed
    assert f"{printed.lambda11:.3f}" == "0.686"
    assert printed.b11 == pytest.approx(6.11e-6, rel=1e-3)  # 6.105e-6: half a unit of the last printed digit
    assert paper_study.b11_with_factor == pytest.approx(6.784e-3, rel=1e-4)
    assert printed.modes == 1
    assert printed.centre == pytest.approx(printed.b11 * np.cos(printed.lambda11 * printed.time), abs=1e-12)


def test_the_corrected_numbers_follow_from_stress_thickness_and_density(paper_study):
    corrected = paper_study.corrected
    assert (corrected.tension_along, corrected.tension_across) == pytest.approx((24.0, 9.3))
    expected = pi / 0.06 * sqrt((24.0 + 9.3) / corrected.areal_density)
    assert corrected.lambda11 == pytest.approx(expected)
    assert corrected.peak == pytest.approx(5 * 0.03**4, rel=1e-4)  # 40 odd modes of a smooth bump
    # Coefficients of x (a - x) are 8 a^2/(pi m)^3 for odd m; both directions and the factor 5 give B11.
    assert corrected.b11 == pytest.approx(5 * (8 * 0.06**2 / pi**3) ** 2, rel=1e-9)


def test_the_table_names_what_is_different(paper_study):
    table = paper_table(paper_study)
    text = " ".join(cell for row in table.rows for cell in row)
    assert "6.78 mm" in text
    assert "288 rad/s" in text
    assert "8.21 mm" in text  # of the printed shape at the middle of a fixed side


def test_its_folder_holds_the_same_files(paper_study, tmp_path):
    report = write_paper_study(paper_study, tmp_path / "paper", ledger=LEDGER, command="trocar study")
    assert is_study(report.parent)
    text = report.read_text(encoding="utf-8")
    assert "3 entries" in text
    assert "http" not in text.replace('http-equiv="Content-Security-Policy"', "")
    said = json.loads((report.parent / "statistics.json").read_text())
    assert said["printed"]["lambda11"] == paper_study.printed.lambda11
    with xr.open_dataset(report.parent / "results.nc", engine="h5netcdf") as data:
        assert data["centre_corrected"].attrs["units"] == "m"
        assert data["centre_corrected"].values == pytest.approx(paper_study.corrected.centre)
