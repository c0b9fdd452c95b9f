"""The report in a real browser: nothing complains, everything is drawn, nothing runs out of a narrow window."""

import json
import re
from html import unescape

import numpy as np
import pytest
from PIL import Image

from browser.chromium import look, required
from small_study import LEDGER
from trocar.study.report.page import CONTENTS
from trocar.study.writing.results import write_study

PROBE = """<script>addEventListener("load", () => {
  const found = {
    images: [...document.images].map((image) => [image.complete, image.naturalWidth]),
    drawings: [...document.querySelectorAll("svg")].map((svg) => svg.getBoundingClientRect().width),
    overflow: document.documentElement.scrollWidth - document.documentElement.clientWidth,
  };
  document.documentElement.dataset.found = JSON.stringify(found);
});</script>"""


@pytest.fixture(scope="module")
def browser():
    return required()


@pytest.fixture(scope="module")
def report(study, tmp_path_factory):
    return write_study(
        study, tmp_path_factory.mktemp("browser") / "study", ledger=LEDGER, command="trocar study"
    )


def test_it_opens_without_a_complaint(browser, report, tmp_path):
    text, console = look(browser, report, tmp_path / "profile", "--dump-dom")
    assert console == []
    for key, _ in CONTENTS:
        assert re.search(rf'<h2 id="{key}">', text)


def test_it_paints(browser, report, tmp_path):
    shot = tmp_path / "report.png"
    look(browser, report, tmp_path / "profile", "--window-size=1100,1400", f"--screenshot={shot}")
    pixels = np.asarray(Image.open(shot).convert("L"), dtype=float)
    assert pixels.shape == (1400, 1100)
    dark = (pixels < 128).mean()
    assert 0.01 < dark < 0.5  # text and lines, neither a blank page nor a black one
    assert (pixels[1000:] < 128).any()


@pytest.mark.parametrize("width", [1280, 500])  # Chromium's narrowest window is 500 pixels
def test_pictures_are_decoded_and_nothing_runs_out(browser, report, tmp_path, width):
    page = tmp_path / "probed.html"
    text = report.read_text(encoding="utf-8")
    probed, count = re.subn(r'<meta http-equiv="Content-Security-Policy"[^>]*>', PROBE, text)
    assert count == 1
    page.write_text(probed, encoding="utf-8")
    dom, console = look(browser, page, tmp_path / "profile", f"--window-size={width},900", "--dump-dom")
    assert console == []
    found = json.loads(unescape(re.search(r'data-found="([^"]*)"', dom)[1]))
    assert found["images"]
    assert all(complete and wide > 0 for complete, wide in found["images"])
    assert len(found["drawings"]) == 12
    assert min(found["drawings"]) > 300
    assert found["overflow"] <= 0
