"""Draw the pictures of the README: run the study and write docs/_static/*.png (make pictures)."""

from __future__ import annotations

import argparse
from pathlib import Path

from trocar.study.plan import Plan
from trocar.study.protocol import run_study
from trocar.study.report.showcase import write_showcase

FOLDER = Path(__file__).parents[1] / "docs" / "_static"

if __name__ == "__main__":
    argparse.ArgumentParser(description=__doc__).parse_args()
    for path in write_showcase(run_study(Plan()), FOLDER):
        print(f"{path.relative_to(FOLDER.parents[1])}: {path.stat().st_size / 1000:.0f} kB")
