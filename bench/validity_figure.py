"""Draw where each wave model may be trusted, for the docs.

python bench/validity_figure.py OUT.png [--tissue skin]
"""

from __future__ import annotations

import argparse
from pathlib import Path

from trocar.study.models import COARSE_MESH
from trocar.study.report.figures.style import settings
from trocar.study.report.figures.validity import validity_alt, validity_figure
from trocar.study.validity import validity_map
from trocar.tissues.catalogue import tissue


def main() -> None:
    """Compute the map of a preset and draw it."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("out", type=Path)
    parser.add_argument("--tissue", default="skin")
    asked = parser.parse_args()
    found = validity_map(tissue(asked.tissue), mesh=COARSE_MESH)
    with settings():
        validity_figure(found).savefig(asked.out, dpi=160)
    print(validity_alt(found))


if __name__ == "__main__":
    main()
