"""The page is well formed, asks nothing of the network, and says what the results say."""

import re
from dataclasses import dataclass
from html.parser import HTMLParser
from itertools import pairwise

import pytest

from small_study import LEDGER
from trocar.study.report.answer import answer, overlooked
from trocar.study.report.page import CONTENTS, report_page
from trocar.study.report.result_tables import cases, range_table
from trocar.study.report.statistic_tables import ledger_rows
from trocar.study.report.table import Table, count, percent
from trocar.study.statistics.published import t_test

VOID = {"meta", "link", "img", "br", "wbr", "source"}


@dataclass(frozen=True)
class Verdict:
    strain: float = 0.02
    deflection_share: float = 0.03
    slope: float = 0.1
    inside: bool = True
    limiting: str = "deflection_share"
    force_limit: float = 0.0819


class Outline(HTMLParser):
    """Elements with their attributes, text by element, and whether every one is closed."""

    def __init__(self, text):
        super().__init__()
        self.open, self.elements, self.wrong, self.headings, self.cells = [], [], [], [], []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attrs):
        self.elements.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        self.elements.append((tag, dict(attrs)))

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.wrong.append(tag)

    def handle_data(self, data):
        if self.open and re.fullmatch(r"h\d", self.open[-1]):
            self.headings.append((int(self.open[-1][1]), data))
        if self.open and self.open[-1] in ("td", "th"):
            self.cells.append(data)

    def of(self, tag):
        return [attributes for name, attributes in self.elements if name == tag]


@pytest.fixture(scope="module")
def page(study, drawn, moving):
    ranges = {"small": Verdict(), "paper": Verdict(inside=False, strain=3.0)}
    return report_page(
        study, drawn, moving, ledger=LEDGER, ranges=ranges,
        command="trocar study --out <here>", created="2026-01-02 03:04 UTC",
    )  # fmt: skip


@pytest.fixture(scope="module")
def outline(page):
    return Outline(page)


def test_every_element_is_closed(outline):
    assert outline.wrong == []
    assert outline.open == []


def test_nothing_is_asked_of_the_network(page, outline):
    assert "http" not in page.replace('http-equiv="Content-Security-Policy"', "")
    assert not outline.of("script")
    for _, attributes in outline.elements:
        for key in ("src", "href", "srcset", "action", "data"):
            assert attributes.get(key, "#").startswith(("#", "data:")), attributes
        assert not any(key.startswith("on") for key in attributes)
    assert not re.search(r"@import|url\((?!#)", page)
    policy = next(found["content"] for found in outline.of("meta") if "http-equiv" in found)
    assert policy == "default-src 'none'; img-src data:; style-src 'unsafe-inline'"


def test_links_lead_somewhere_and_ids_are_unique(outline):
    identities = [attributes["id"] for _, attributes in outline.elements if "id" in attributes]
    assert len(identities) == len(set(identities))
    targets = {attributes["href"][1:] for attributes in outline.of("a")}
    assert targets == {key for key, _ in CONTENTS} <= set(identities)


def test_headings_do_not_skip_a_level(outline):
    levels = [level for level, _ in outline.headings]
    assert levels[0] == 1
    assert levels.count(1) == 1
    assert all(later - earlier <= 1 for earlier, later in pairwise(levels))


def test_pictures_are_described_and_tables_named(drawn, outline):
    assert all(len(attributes["alt"]) > 60 for attributes in outline.of("img"))
    drawings = [found for found in outline.of("svg") if found.get("role") == "img"]
    assert len(drawings) == len(outline.of("svg")) == len(drawn)
    assert all(len(found["aria-label"]) > 60 for found in drawings)
    assert len(outline.of("caption")) == len(outline.of("table")) == 19


def test_no_number_of_the_page_is_infinite(outline):
    words = " ".join([*outline.cells, *(text for _, text in outline.headings)])
    assert not re.search(r"\b(nan|inf|None)\b", words)


def test_the_answer_stands_first_with_the_results_numbers(study, page):
    said = answer(study, None)
    first = page.index(said.paragraph[:40])
    assert first < page.index("<table")
    worst = max(curve.largest_relative_error for curve in study.agreement["small"]["wave-solid"].values())
    assert percent(worst) in said.paragraph
    assert said.figures[0].value == percent(worst)


def test_the_papers_load_is_marked_as_no_prediction(study, page):
    assert "Outside the linear range: not a prediction." in page
    assert "0.0819 N (deflection share)" in page
    assert answer(study, None).paper_inside is False  # deeper than the block
    assert answer(study, {"paper": Verdict()}).paper_inside is True
    assert "not assessed" in range_table(study, None).rows[0]


def test_a_small_load_outside_the_range_is_marked_too(study, drawn, moving, page):
    assert "The small load, inside the linear range: 0.05 N" in page
    text = report_page(study, drawn, moving, ranges={"small": Verdict(inside=False)})
    assert "Even 0.05 N lies outside the linear range" in text
    assert text.count("Outside the linear range: not a prediction.") == 2


def test_a_range_that_is_given_is_shown(study):
    rows = {
        row[0]: row for row in range_table(study, {"small": Verdict(), "paper": Verdict(inside=False)}).rows
    }
    names = {key: name for key, (name, _) in cases(study).items()}
    assert rows[names["small"]][1:4] == ("inside", "3.0 %", "2.0 %")
    assert rows[names["paper"]][1] == "OUTSIDE"
    assert rows[names["tap"]][1] == "not assessed"


def test_every_entry_of_the_ledger_is_there_and_escaped(page):
    assert "3 entries: 1 inconsistent, 1 reproduced, 1 not specified." in page
    assert "6.11×10⁻⁶" in page
    assert "&lt;lighter&gt; than air &amp; too light" in page
    assert "<lighter>" not in page
    assert "--out &lt;here&gt;" in page


def test_a_study_without_a_ledger_says_so(study, drawn, moving):
    text = report_page(study, drawn, moving)
    assert "No ledger was kept" in text


def test_the_ledger_shows_numbers_as_printed():
    rows = ledger_rows(LEDGER).rows
    assert rows[0][1:4] == ("6.11×10⁻⁶", "0.006784", "m")
    assert rows[2][1:5] == ("", "", "", "not specified")


def test_what_the_published_test_overlooks(study):
    curve = study.paper["fea"].block
    share = overlooked(curve)
    assert not t_test((1 + 0.99 * share) * curve, curve).rejected
    assert t_test((1 + 1.01 * share) * curve, curve).rejected


def test_percent_and_count():
    assert percent(0.00463) == "0.46 %"
    assert percent(-0.08, signed=True) == "−8.0 %"
    assert percent(0.03, signed=True) == "+3.0 %"
    assert percent(3.05) == "305 %"
    assert percent(0.0) == "0 %"
    assert count(245760) == "245\N{NARROW NO-BREAK SPACE}760"


def test_a_table_with_a_short_row_is_our_mistake():
    with pytest.raises(AssertionError):
        Table(caption="two columns", head=("a", "b"), rows=(("1",),))
