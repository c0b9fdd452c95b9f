"""What every figure shares: fonts, sizes, colours that the colour-blind tell apart, line styles that differ as well.

Palette: M. Okabe, K. Ito, Color Universal Design (2008). Widths are in inches of a page about 7.2 wide, so that
text set at 9 points stays at about 9 points in the report.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import wraps
from typing import Any, ParamSpec

import matplotlib as mpl
from matplotlib.figure import Figure

P = ParamSpec("P")
_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")

WIDTH = 7.2  # [in]
BLACK, GREY, FAINT = "#000000", "#5f6368", "#d9dce0"
ORANGE, SKY, GREEN, YELLOW = "#E69F00", "#56B4E9", "#009E73", "#F0E442"
BLUE, VERMILION, PURPLE = "#0072B2", "#D55E00", "#CC79A7"
DEPTHS = "YlGnBu"  # pale at rest, dark where deep: read by lightness alone, the same to the colour-blind

MODEL_LABELS = {
    "fea": "finite elements",
    "wave-solid": "WaveSolid",
    "wave-membrane": "WaveMembrane",
    "wave-mesh": "WaveMesh",
    "mass-spring": "mass-springs",
    "mesh-free": "mesh-free",
}
# The reference is a broad pale band, the judged models thin lines on it: curves that coincide are all seen.
MODEL_LINES: dict[str, dict[str, Any]] = {
    "fea": {"color": "#b4b9bf", "linewidth": 4.5, "linestyle": "-", "solid_capstyle": "round"},
    "wave-solid": {"color": BLUE, "linewidth": 1.6, "linestyle": "-"},
    "wave-membrane": {"color": VERMILION, "linewidth": 1.4, "linestyle": (0, (4, 2))},
}
MODEL_MARKS = {
    "fea": ("s", GREY),
    "wave-solid": ("o", BLUE),
    "wave-membrane": ("^", VERMILION),
    "wave-mesh": ("D", SKY),
    "mass-spring": ("v", GREEN),
    "mesh-free": ("X", PURPLE),
}
LAYER_COLOURS = (ORANGE, BLUE, GREEN, PURPLE, SKY, VERMILION)
LAYER_STYLES: tuple[Any, ...] = (
    "-",
    (0, (5, 2)),
    (0, (1.5, 1.5)),
    (0, (6, 2, 1, 2)),
    (0, (3, 1)),
    (0, (1, 3)),
)

_SETTINGS: dict[str, Any] = {
    "font.family": ["DejaVu Sans"],  # comes with matplotlib, so a figure looks the same on every machine
    "font.size": 9.0,
    "axes.titlesize": 9.5,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.labelsize": 9.0,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.edgecolor": GREY,
    "axes.linewidth": 0.8,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.formatter.use_mathtext": True,
    "grid.color": "#e8eaed",
    "grid.linewidth": 0.7,
    "xtick.color": GREY,
    "ytick.color": GREY,
    "xtick.labelcolor": BLACK,
    "ytick.labelcolor": BLACK,
    "xtick.labelsize": 8.0,
    "ytick.labelsize": 8.0,
    "legend.frameon": False,
    "legend.fontsize": 8.5,
    "figure.facecolor": "white",
    "savefig.facecolor": "white",
    "svg.fonttype": "path",  # a file that needs no font of the reader's
    "svg.hashsalt": "trocar",
    "hatch.linewidth": 0.6,
}


@contextmanager
def settings() -> Iterator[None]:
    """Draw or save with the house's settings, then put back what was there."""
    with mpl.rc_context():
        mpl.rcdefaults()
        mpl.rcParams.update(_SETTINGS)  # type: ignore[arg-type]
        yield


def styled(draw: Callable[P, Figure]) -> Callable[P, Figure]:
    """Make a drawing function draw with the house's settings."""

    @wraps(draw)
    def drawn(*args: P.args, **kwargs: P.kwargs) -> Figure:
        with settings():
            return draw(*args, **kwargs)

    return drawn


def sheet(height: float, width: float = WIDTH) -> Figure:
    """Return an empty figure, `width` by `height` [in], that lays itself out."""
    return Figure(figsize=(width, height), layout="constrained")


def label(model: str) -> str:
    """Return a model's name as figures and tables write it."""
    return MODEL_LABELS.get(model, model)


def three(value: float) -> str:
    """Return a number with three significant digits, very large and small ones as a power of ten."""
    if value == 0:
        return "0"
    if not 1e-4 <= abs(value) < 1e5:
        return power_of_ten(value, 3)
    return f"{float(f'{value:.2e}'):.{max(0, 2 - _decade(value))}f}".replace("-", "−")


def power_of_ten(value: float, digits: int) -> str:
    """Return a number as "7.61×10⁻⁷" with this many significant digits."""
    mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
    return f"{mantissa}×10{str(int(exponent)).translate(_RAISED)}".replace("-", "−")


def with_uncertainty(value: float, half: float) -> str:
    """Return "value ± half", both to the place of the second significant digit of `half`."""
    if half <= 0:
        return f"{three(value)} ± 0"
    places = max(0, 1 - int(f"{half:.1e}".split("e")[1]))
    return f"{value:.{places}f} ± {half:.{places}f}".replace("-", "−")


def _decade(value: float) -> int:
    return int(f"{value:.2e}".split("e")[1])
