"""The ledger: printed digits pinned, verdicts, our own numbers against other ways to them."""

import json
from math import inf, nan, pi

import numpy as np
import pytest

from trocar.errors import InputError
from trocar.study.ledger import Verdict, agrees, ledger, write_ledger
from trocar.study.ledger.entry import half_digit, recomputed_entry
from trocar.study.ledger.membrane import b11_closed_form, b11_integral, disc_share, rayleigh_wavenumber
from trocar.study.ledger.t_tests import (
    amplitude_gap,
    could_print,
    degrees_of_freedom,
    fitting_periods,
    matching_orders,
    triangle,
)
from trocar.study.statistics.published import t_test

ENTRIES = {entry.id: entry for entry in ledger()}


@pytest.mark.parametrize(
    ("printed", "value", "holds"),
    [
        ("1.54e-3", 1.5443e-3, True),
        ("1.54e-3", 1.5451e-3, False),
        ("0.364", 0.3635, True),
        ("0.364", 0.3634, False),
        ("6.11e-6", 6.1054e-6, True),
        ("6.11e-6", 6.1049e-6, False),
        ("-0.912", -0.9118, True),
        ("-0.912", 0.912, False),
        ("3600", 3600.4, True),
        ("3600", 3600.6, False),
        ("0", 1e-14, True),
        ("0", 0.0082, False),
        ("100", inf, False),
        ("100", nan, False),
    ],
)
def test_agreement_is_rounding_to_the_printed_digits(printed, value, holds):
    assert agrees(printed, value) is holds


def test_half_a_digit():
    assert half_digit("1.54") == pytest.approx(0.005, rel=1e-15)
    assert half_digit("1.80e-6") == pytest.approx(5e-9, rel=1e-15)


@pytest.mark.parametrize(
    ("name", "recomputed", "digits", "verdict"),
    [
        # id, our value, relative accuracy of what is written here, verdict
        ("area", 3600, 1e-12, "reproduced"),
        ("volume", 3600, 1e-12, "reproduced"),
        ("weight", 6.48e-5, 1e-12, "reproduced"),
        ("density", 18, 1e-12, "reproduced"),
        ("density_of_skin", 1.1e6, 1e-12, "inconsistent"),
        ("prestress", 0.025739, 2e-5, "reproduced"),
        ("tension", 1544, 3e-4, "inconsistent"),
        ("tension_number", 1.544e-3, 3e-4, "reproduced"),
        ("b11", 6.784e-3, 1e-4, "inconsistent"),
        ("b11_without_factor", 6.105e-6, 1e-4, "reproduced"),
        ("f_boundary", 8.2062e-3, 1e-12, "inconsistent"),
        ("eigenvalue_formula", 2**0.5 * pi / 0.06, 1e-9, "reproduced"),
        ("c", 9.2626e-3, 1e-5, "not specified"),
        ("lambda11", 0.686, 8e-4, "reproduced"),
        ("lambda11_from_printed_tension", 0.685, 8e-4, "inconsistent"),
        ("lambda11_si", 358, 2e-3, "inconsistent"),
        ("period", 9.159, 1e-4, "not specified"),
        ("series_terms", 40, 1e-12, "inconsistent"),
        ("footprint", 40, 1e-12, "inconsistent"),
        ("load_time", 100, 1e-12, "reproduced"),
        ("load_cycle", 200, 1e-12, "inconsistent"),
        ("p_epidermis", 0.363, 1e-3, "inconsistent"),
        ("p_dermis", 0.364, 1e-3, "inconsistent"),
        ("p_fat", 0.395, 1e-3, "inconsistent"),
        ("p_rows_in_place", 0, 1e-12, "inconsistent"),
        ("t_critical", 1.975, 3e-4, "reproduced"),
        ("not_rejected_epidermis", 1, 1e-12, "reproduced"),
        ("not_rejected_dermis", 1, 1e-12, "reproduced"),
        ("not_rejected_fat", 1, 1e-12, "reproduced"),
        ("criterion", 0.025, 1e-3, "inconsistent"),
        ("df", 160, 1e-12, "not specified"),
        ("sample_size", 81, 1e-12, "not specified"),
        ("reference_7_year", 1994, 1e-12, "inconsistent"),
    ],
)
def test_numbers_and_verdicts(name, recomputed, digits, verdict):
    assert ENTRIES[name].recomputed == pytest.approx(recomputed, rel=digits)
    assert ENTRIES[name].verdict == verdict


@pytest.mark.parametrize(
    "name", ["moduli", "damping", "fat_thickness", "peak_shift", "cost_ratio", "t_sign", "fea_mesh"]
)
def test_what_is_not_printed_is_not_specified(name):
    assert ENTRIES[name].verdict is Verdict.NOT_SPECIFIED
    assert ENTRIES[name].recomputed is None


def test_every_entry_is_told_once_with_a_reason():
    entries = ledger()
    assert len({entry.id for entry in entries}) == len(entries)
    assert all(entry.note.endswith(".") for entry in entries)


def test_verdict_follows_the_digits():
    assert recomputed_entry("x", "2.0", 2.04, "1", "").verdict is Verdict.REPRODUCED
    assert recomputed_entry("x", "2.0", 2.06, "1", "").verdict is Verdict.INCONSISTENT


def test_coefficient_by_quadrature_by_parts_and_by_sums():
    n = 2000
    x = (np.arange(n) + 0.5) * 0.06 / n  # midpoint rule: error (pi/n)^2 / 24, about 1e-7
    one = np.sum(x * (1 - x) * np.sin(pi * x / 0.06)) * 0.06 / n
    assert b11_integral() == pytest.approx(b11_closed_form(), rel=1e-10)  # quadrature to 1e-16 of 6e-6
    assert b11_integral() == pytest.approx(5 * one**2, rel=1e-6)


def test_one_term_holds_a_thirtieth_of_the_tool():
    # sin sin is about 1 over the disc: the share is 4 pi r^2 / (a b); curvature lowers it by 1 - (k r)^2 / 2
    first_order = 4 * pi * 3**2 / 60**2
    assert disc_share() == pytest.approx(first_order * (1 - (pi * 3 / 60) ** 2 / 2), rel=1e-3)


def test_wavenumber_of_the_lowest_mode():
    assert rayleigh_wavenumber() == pytest.approx(2**0.5 * pi / 0.06, rel=1e-12)


def test_samples_behind_the_critical_value():
    assert degrees_of_freedom() == (154, 164)
    assert fitting_periods() == ((100.0, 1.25, 81), (200.0, 2.5, 81))


def test_p_column_is_rotated():
    assert matching_orders() == (("fat", "epidermis", "dermis"),)
    assert could_print("0.363", "-0.912")
    assert not could_print("0.364", "-0.912")
    assert "printed under fat" in ENTRIES["p_epidermis"].note
    assert "printed under epidermis" in ENTRIES["p_dermis"].note
    assert "printed under dermis" in ENTRIES["p_fat"].note
    assert "rotation by 1 row" in ENTRIES["p_rows_in_place"].note


def test_published_test_is_blind_to_large_errors():
    gap = ENTRIES["amplitude_error_unseen"].recomputed
    curve = triangle(81)
    assert gap == pytest.approx(0.17, abs=0.005)
    assert not t_test(curve, (1 - 0.99 * gap) * curve).rejected
    assert t_test(curve, (1 - 1.01 * gap) * curve).rejected
    assert amplitude_gap(0.912, 81) == pytest.approx(0.082, abs=0.0005)


def test_a_measured_cost_is_given_but_cannot_judge_an_unstated_one():
    """Mesh and steps of the paper are not printed, so no ratio of ours confirms or refutes its 40."""
    measured = {"wave_seconds": 1.0, "fea_seconds": 15.0}
    entry = next(entry for entry in ledger(measured) if entry.id == "cost_ratio")
    assert entry.recomputed == 15.0
    assert entry.verdict is Verdict.NOT_SPECIFIED
    alone = next(entry for entry in ledger({"fea_seconds": 15.0}) if entry.id == "cost_ratio")
    assert alone.recomputed is None


def test_measured_numbers_fill_what_is_not_specified():
    entry = next(entry for entry in ledger({"peak_shift": 0.5}) if entry.id == "peak_shift")
    assert entry.recomputed == 0.5
    assert entry.verdict is Verdict.NOT_SPECIFIED


@pytest.mark.parametrize(
    "measured",
    [{"b11": 1.0}, {"speed": 1.0}, {"wave_seconds": 0.0}, {"fea_seconds": inf}, {"peak_shift": nan}],
)
def test_impossible_measurements_are_refused(measured):
    with pytest.raises(InputError, match="measured"):
        ledger(measured)


def test_file_is_a_list_with_the_agreed_keys(tmp_path):
    file = tmp_path / "ledger.json"
    write_ledger(file, {"wave_seconds": 0.5, "fea_seconds": 60.0})
    rows = json.loads(file.read_text("utf-8"))
    assert len(rows) == len(ENTRIES)
    assert all({"id", "published", "recomputed", "verdict", "note"} <= row.keys() for row in rows)
    assert {row["verdict"] for row in rows} == {"reproduced", "inconsistent", "not specified"}
    by_id = {row["id"]: row for row in rows}
    assert by_id["b11"]["published"] == 6.11e-6
    assert by_id["cost_ratio"]["recomputed"] == 120
    assert by_id["fea_mesh"]["published"] is None
    assert by_id["not_rejected_fat"]["published"] == "True"
