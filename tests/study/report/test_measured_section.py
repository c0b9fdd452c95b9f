"""The third leg in the report: every set that is there has figures, tables and words, and nothing else changes."""

from __future__ import annotations

import json
import re
from xml.etree import ElementTree

import pytest
from matplotlib.figure import Figure

from measured_sets import rough_platens, write_limbs, write_rubber, write_small_sets
from small_study import LEDGER
from trocar.errors import InputError
from trocar.study.measured import pressed
from trocar.study.measured.leg import run_leg
from trocar.study.measured.sets import read_sets
from trocar.study.report.figures.animation import Moving
from trocar.study.report.measured_section import measured_parts, measured_pictures
from trocar.study.report.page import report_page
from trocar.study.report.picture import Picture
from trocar.study.writing import results
from trocar.study.writing.folder import is_study
from trocar.study.writing.measured_results import measured_results
from trocar.study.writing.results import write_study

NAMES = (
    "measured-platens", "measured-growth", "measured-limbs", "measured-strips", "measured-holds", "measured-rubber",
)  # fmt: skip

STILL = Moving(gif=b"", still=b"", frames=0)


class Blanks(dict[str, Picture]):
    """Pictures of which those that are not there are blank: the study's own take long to draw."""

    def __missing__(self, name: str) -> Picture:
        return Picture(name=name, alt="Nothing.", caption="Nothing.", figure=Figure())


@pytest.fixture(scope="module")
def leg(tmp_path_factory):
    folder = write_small_sets(tmp_path_factory.mktemp("sets"))
    shares = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(pressed, "platens", rough_platens)
        found = run_leg(read_sets(folder), lambda _what, share: shares.append(share))
    assert shares == sorted(shares)
    assert shares[-1] == 1.0
    return found


@pytest.fixture(scope="module")
def third(leg):
    return measured_pictures(leg)


def test_every_set_has_its_figures_and_words(third):
    assert tuple(third) == NAMES
    for name, picture in third.items():
        for words in (picture.alt, picture.caption):
            assert words.endswith(".")
            assert not re.search(r"\b(nan|inf|None)\b", words), name
        root = ElementTree.fromstring(picture.inline_svg())
        assert root.get("aria-label") == picture.alt


def test_tables_say_numbers_that_are_there(leg):
    parts = measured_parts(leg)
    assert [len(part.tables) for part in parts] == [3, 1, 1, 1, 1]  # no silicones in tension: no grades
    cells = [cell for part in parts for table in part.tables for row in table.rows for cell in row]
    assert not any(re.search(r"\b(nan|inf|None)\b", cell) for cell in cells)
    phantoms = parts[0].tables[0]
    # B of one composition was made a tenth stiffer than A, of the other alike: the median lies between
    assert phantoms.rows[-1][2] == "4.5 % (9.1 %)"
    rubber = {row[0]: row for row in parts[-1].tables[0].rows}
    assert rubber["neo-Hookean"][2] == "400"  # kPa, what it was made with


def test_the_page_has_the_section_only_where_there_is_a_leg(study, leg, third):
    without = report_page(study, Blanks(), STILL, ledger=LEDGER)
    page = report_page(study, Blanks(third), STILL, ledger=LEDGER, measured=leg)
    assert 'id="measured"' not in without
    assert "measured.json" not in without
    assert page.count('id="measured"') == 1
    assert page.count('href="#measured"') == 1
    for part in measured_parts(leg):
        assert f"<h3>{part.title.replace(chr(39), '&#39;')}</h3>" in page
    assert "Silicones in tension are left out: there is no folder soft_robotics_elastomers_odbl" in page


def test_results_are_plain_values(leg):
    said = json.loads(json.dumps(measured_results(leg), allow_nan=False))
    assert {row["tissue"] for row in said["strips"]} == {"skin"}
    assert len(said["phantoms"]["discs"]) == 2 * 2 * 3
    assert said["phantoms"]["discs"][0]["shear_modulus"] > 0
    assert said["limbs"]["people"] == {"fitted": 10, "judged": 10}
    assert said["rubber"][0]["fitted"] == {
        "law": "NeoHookean", "shear_modulus": pytest.approx(4e5, rel=1e-3), "parameters": {},
    }  # fmt: skip


def test_a_study_with_a_leg_is_written_whole(study, leg, third, tmp_path, monkeypatch):
    for name, stand_in in (  # what takes long to draw and has tests of its own
        ("pictures", lambda _study: {}),
        ("animation", lambda _film: STILL),
        ("measured_pictures", lambda _leg: third),
        ("report_page", lambda *_all, measured, **_more: str(measured is leg)),
    ):
        monkeypatch.setattr(results, name, stand_in)
    report = write_study(study, tmp_path / "study", ledger=LEDGER, measured=leg)
    assert is_study(report.parent)
    assert report.read_text() == "True"
    assert json.loads((report.parent / "measured.json").read_text())["missing"]
    figures = {entry.name for entry in (report.parent / "figures").iterdir()}
    assert {f"{name}.svg" for name in NAMES} <= figures


def test_a_folder_with_one_set_says_only_that(tmp_path):
    write_rubber(tmp_path)
    leg = run_leg(read_sets(tmp_path))
    assert [part.title for part in measured_parts(leg)] == ["Rubber, to check the laws' code"]
    assert tuple(measured_pictures(leg)) == ("measured-rubber",)
    assert len(leg.sets.missing) == 5


def test_a_few_limbs_end_in_a_sentence_or_a_result(tmp_path):
    row = {
        "probe_area_mm2": 360, "SubID": "1", "Location": "LA_A", "MaxForce": 5, "TotalStrain": 0.2, "Thickness": 30,
        "Skin": 1.5, "Fat": 5, "Muscle": 20,
    }  # fmt: skip
    write_limbs(tmp_path, [row, {**row, "Location": "LA_P"}])
    with pytest.raises(InputError, match="limbs: expected at least 4 people and 20 trials"):
        run_leg(read_sets(tmp_path))
