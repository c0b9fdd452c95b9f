"""The README's pictures come out of the program, are small, and are the ones the README shows."""

import re
from pathlib import Path

import numpy as np
from PIL import Image

from trocar.study.report.showcase import write_showcase

ROOT = Path(__file__).parents[3]
LARGEST = 200_000  # bytes: a reader on a slow line waits for it


def test_the_pictures_are_small_and_not_blank(study, tmp_path):
    paths = write_showcase(study, tmp_path / "new")
    assert {path.name for path in paths} == {"exploded-block.png", "deflection.png"}
    for path in paths:
        assert path.stat().st_size < LARGEST
        assert len(np.unique(np.asarray(Image.open(path).convert("L")))) > 20


def test_the_readme_shows_pictures_that_are_there():
    shown = re.findall(r"!\[[^\]]+\]\(([^)]+\.png)\)", (ROOT / "README.md").read_text())
    assert len(shown) == 3
    for place in shown:
        assert (ROOT / place).stat().st_size < LARGEST
