"""The pictures the README shows, out of a study like any other."""

from __future__ import annotations

from io import BytesIO
from pathlib import Path

from matplotlib.figure import Figure
from PIL import Image

from trocar.study.protocol import Study
from trocar.study.report.figures.block import block_figure
from trocar.study.report.figures.deflection import deflection_figure
from trocar.study.report.figures.style import settings

DOTS = 130  # [1/in]
SHADES = 128  # colours: enough for the shaded faces


def write_showcase(study: Study, folder: Path) -> tuple[Path, ...]:
    """Write the exploded block and the deflection curves as small PNG files.

    Args:
        study: the results.
        folder: to write into; made where it is missing.

    Raises:
        OSError: it cannot be written.
    """
    folder.mkdir(parents=True, exist_ok=True)
    drawn = {
        "exploded-block": block_figure(study.small.case, study.surfaces["small"]),
        "deflection": deflection_figure(study.small),
    }
    paths = []
    for name, figure in drawn.items():
        path = folder / f"{name}.png"
        _picture(figure).save(path, "PNG", optimize=True)
        paths.append(path)
    return tuple(paths)


def _picture(figure: Figure) -> Image.Image:
    stream = BytesIO()
    with settings():
        figure.savefig(stream, format="png", dpi=DOTS, metadata={"Software": None})
    return Image.open(stream).convert("RGB").quantize(SHADES, dither=Image.Dither.NONE)
